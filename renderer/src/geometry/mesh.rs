//! A mesh of triangles.
//!
//! Vertices are in single precision, as mesh files hold them; where a ray meets a triangle is computed in
//! double precision from the same vertices for all triangles that share them, so that nothing slips through
//! an edge. A triangle without area, or with a vertex that is not there or not finite, is never hit.
//!
//! Source: Möller & Trumbore (1997).

use std::ops::Range;

use super::box_tree::Walk;
use super::{Bounds, BoxTree, Hit, Part, Ray, Span, Vector};

/// By how much a triangle is larger than its edges say, so that rounding opens no gap between neighbours.
const SLACK: f64 = 1e-12;

/// Triangles that share vertices.
#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    tree: BoxTree,
    /// The triangles in the order of the tree, so that those of a leaf stand side by side.
    triangles: Vec<Triangle>,
    faces: Vec<[u32; 3]>,
    vertices: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    texture_points: Vec<[f32; 2]>,
}

/// What a mesh is made of.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeshParts {
    /// In the world, in metres.
    pub(crate) vertices: Vec<[f32; 3]>,
    /// Each triangle's vertices, counter-clockwise as seen from outside.
    pub(crate) faces: Vec<[u32; 3]>,
    /// A normal for each vertex, of any length; empty for a mesh of flat faces.
    pub(crate) normals: Vec<[f32; 3]>,
    /// A place in the texture for each vertex; empty if there is none.
    pub(crate) texture_points: Vec<[f32; 2]>,
}

/// A triangle's corners, and which face it is.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    corners: [[f32; 3]; 3],
    face: u32,
}

impl Mesh {
    /// Builds the mesh. Normals and texture points count only if there are as many as vertices.
    pub(crate) fn new(parts: MeshParts) -> Self {
        let MeshParts {
            vertices,
            faces,
            mut normals,
            mut texture_points,
        } = parts;
        if normals.len() != vertices.len() {
            normals.clear();
        }
        if texture_points.len() != vertices.len() {
            texture_points.clear();
        }
        let triangle = |(face, corners): (u32, &[u32; 3])| {
            let [a, b, c] = corners.map(|corner| vertices.get(corner as usize).copied());
            let triangle = Triangle {
                corners: [a?, b?, c?],
                face,
            };
            triangle.has_area().then_some(triangle)
        };
        let unsorted: Vec<Triangle> = (0..).zip(&faces).filter_map(triangle).collect();
        let boxes: Vec<Bounds> = unsorted.iter().map(Triangle::bounds).collect();
        let tree = BoxTree::over(&boxes);
        let order = tree.order().iter();
        let triangles = order.map(|&place| unsorted[place as usize]).collect();
        Self {
            tree,
            triangles,
            faces,
            vertices,
            normals,
            texture_points,
        }
    }

    /// How many triangles can be hit.
    pub(crate) fn triangles(&self) -> usize {
        self.triangles.len()
    }

    /// The box that holds the mesh; `None` if no triangle can be hit.
    pub(crate) fn bounds(&self) -> Option<Bounds> {
        self.tree.bounds()
    }

    /// The first hit within the span; of equal ones that of the first face.
    pub(crate) fn hit(&self, ray: &Ray, span: Span) -> Option<Hit> {
        let mut nearest: Option<(f64, u32)> = None;
        let mut span = span;
        self.tree.visit(ray, &mut span, |places, span| {
            for triangle in &self.triangles[places] {
                let Some(distance_m) = triangle.hit(ray, *span) else {
                    continue;
                };
                let is_first = nearest.is_none_or(|(best_m, face)| {
                    distance_m < best_m || (distance_m == best_m && triangle.face < face)
                });
                if is_first {
                    nearest = Some((distance_m, triangle.face));
                    // The next float, so that an equal hit of an earlier face still counts.
                    span.to_m = distance_m.next_up();
                }
            }
            Walk::On
        });
        nearest.map(|(distance_m, face)| Hit {
            distance_m,
            part: Part::Face(face),
        })
    }

    /// Whether anything is hit within the span.
    pub(crate) fn is_hit(&self, ray: &Ray, span: Span) -> bool {
        let mut span = span;
        let any = |places: Range<usize>, span: &mut Span| {
            let mut triangles = self.triangles[places].iter();
            if triangles.any(|triangle| triangle.hit(ray, *span).is_some()) {
                Walk::Stop
            } else {
                Walk::On
            }
        };
        self.tree.visit(ray, &mut span, any) == Walk::Stop
    }

    /// The unit normal of a face as its plane has it.
    pub(crate) fn flat_normal(&self, face: u32) -> Vector {
        let [a, b, c] = self.corners(face);
        (b - a).cross(c - a).normalized()
    }

    /// The unit normal at a place of a face, blended from its vertices, if the mesh is smooth.
    pub(crate) fn smooth_normal(&self, face: u32, place: Vector) -> Option<Vector> {
        if self.normals.is_empty() {
            return None;
        }
        let shares = self.shares(face, place);
        let corners = self.faces[face as usize].iter().zip(shares);
        let sum = corners.fold(Vector::default(), |sum, (&corner, share)| {
            sum + vector(self.normals[corner as usize]) * share
        });
        let normal = sum.normalized();
        normal.length_squared().is_finite().then_some(normal)
    }

    /// The place in the texture of a place of a face, if the mesh has any.
    pub(crate) fn texture_point(&self, face: u32, place: Vector) -> Option<[f64; 2]> {
        if self.texture_points.is_empty() {
            return None;
        }
        let shares = self.shares(face, place);
        let corners = self.faces[face as usize].iter().zip(shares);
        Some(corners.fold([0.0; 2], |[u, v], (&corner, share)| {
            let [corner_u, corner_v] = self.texture_points[corner as usize].map(f64::from);
            [u + share * corner_u, v + share * corner_v]
        }))
    }

    fn corners(&self, face: u32) -> [Vector; 3] {
        self.faces[face as usize].map(|corner| vector(self.vertices[corner as usize]))
    }

    /// How much each corner of a face counts at a place of it; they sum to 1.
    fn shares(&self, face: u32, place: Vector) -> [f64; 3] {
        let [a, b, c] = self.corners(face);
        let normal = (b - a).cross(c - a);
        let scale = normal.length_squared().recip();
        let offset = place - a;
        let of_b = offset.cross(c - a).dot(normal) * scale;
        let of_c = (b - a).cross(offset).dot(normal) * scale;
        [1.0 - of_b - of_c, of_b, of_c]
    }
}

impl Triangle {
    #[inline]
    fn vectors(&self) -> [Vector; 3] {
        let [a, b, c] = self.corners;
        [vector(a), vector(b), vector(c)]
    }

    fn has_area(&self) -> bool {
        let [a, b, c] = self.vectors();
        let doubled_area = (b - a).cross(c - a).length();
        doubled_area > 0.0 && doubled_area.is_finite()
    }

    fn bounds(&self) -> Bounds {
        let [a, b, c] = self.vectors();
        Bounds::of_corners(a.min(b).min(c), a.max(b).max(c))
    }

    #[inline]
    fn hit(&self, ray: &Ray, span: Span) -> Option<f64> {
        let [a, b, c] = self.vectors();
        let (edge_b, edge_c) = (b - a, c - a);
        let across = ray.direction.cross(edge_c);
        let determinant = edge_b.dot(across);
        // Everything is compared as a multiple of it, so that most misses are known without a division.
        let size = determinant.abs();
        let slack = SLACK * size;
        let offset = ray.origin - a;
        let of_b = offset.dot(across) * determinant.signum();
        // A ray along the triangle has a determinant of 0: it is let through here, and stopped below.
        if !(of_b >= -slack && of_b <= size + slack) {
            return None;
        }
        let over = offset.cross(edge_b);
        let of_c = ray.direction.dot(over) * determinant.signum();
        if !(of_c >= -slack && of_b + of_c <= size + slack) || size == 0.0 {
            return None;
        }
        let distance_m = edge_c.dot(over) / determinant;
        span.holds(distance_m).then_some(distance_m)
    }
}

#[inline]
fn vector([x, y, z]: [f32; 3]) -> Vector {
    Vector::new(f64::from(x), f64::from(y), f64::from(z))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use proptest::prelude::*;

    use super::super::{Hierarchy, Shape, Sphere};
    use super::*;

    /// Triangles of any size, some without area, some that share edges, some there twice.
    fn soup() -> impl Strategy<Value = MeshParts> {
        let coordinate = || prop_oneof![(-4_i8..=4).prop_map(f32::from), -4.0_f32..4.0];
        let vertex = [coordinate(), coordinate(), coordinate()];
        let vertices = prop::collection::vec(vertex, 3..60);
        let faces = prop::collection::vec([0_u32..60, 0..60, 0..60], 1..120);
        (vertices, faces).prop_map(|(vertices, mut faces)| {
            faces.extend_from_within(..faces.len() / 4);
            MeshParts {
                vertices,
                faces,
                ..MeshParts::default()
            }
        })
    }

    fn rays() -> impl Strategy<Value = Vec<Ray>> {
        let coordinate = || prop_oneof![(-6_i8..=6).prop_map(f64::from), -6.0..6.0_f64];
        let place = move || [coordinate(), coordinate(), coordinate()].prop_map(Vector::from);
        let ray = (place(), place()).prop_filter_map("two places", |(origin, other)| {
            let direction = (other - origin).normalized();
            direction
                .length_squared()
                .is_finite()
                .then_some(Ray { origin, direction })
        });
        prop::collection::vec(ray, 50)
    }

    /// The plain way: every face in its order.
    fn by_trying_all(parts: &MeshParts, ray: &Ray) -> Option<(f64, u32)> {
        let triangles = (0..).zip(&parts.faces).filter_map(|(face, corners)| {
            let [a, b, c] = corners.map(|corner| parts.vertices.get(corner as usize).copied());
            Some(Triangle {
                corners: [a?, b?, c?],
                face,
            })
        });
        let hits = triangles
            .filter(Triangle::has_area)
            .filter_map(|t| Some((t.hit(ray, Span::up_to(f64::INFINITY))?, t.face)));
        hits.reduce(|best, next| if next.0 < best.0 { next } else { best })
    }

    proptest! {
        #[test]
        fn a_mesh_finds_what_trying_every_face_finds(parts in soup(), rays in rays()) {
            let mesh = Mesh::new(parts.clone());
            for ray in rays {
                let span = Span::up_to(f64::INFINITY);
                let nearest = by_trying_all(&parts, &ray);
                let expected = nearest.map(|(distance_m, face)| Hit {
                    distance_m,
                    part: Part::Face(face),
                });
                prop_assert_eq!(mesh.hit(&ray, span), expected);
                prop_assert_eq!(mesh.is_hit(&ray, span), expected.is_some());
                if let Some((distance_m, _)) = nearest {
                    prop_assert!(!mesh.is_hit(&ray, Span::up_to(distance_m)));
                }
            }
        }
    }

    /// The unit cube, its corners given once, with the normals of a sphere.
    fn cube() -> MeshParts {
        let vertices: Vec<[f32; 3]> = (0_u8..8)
            .map(|corner| [0, 1, 2].map(|axis| f32::from((corner >> axis) & 1)))
            .collect();
        let normals = vertices.iter().map(|v| v.map(|x| x - 0.5)).collect();
        let texture_points = vertices.iter().map(|&[x, y, _]| [x, y]).collect();
        let faces = vec![
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        MeshParts {
            vertices,
            faces,
            normals,
            texture_points,
        }
    }

    #[test]
    fn no_ray_slips_into_a_closed_mesh_and_normals_point_out_of_it() {
        let mesh = Mesh::new(cube());
        let middle = Vector::new(0.5, 0.5, 0.5);
        // Towards a grid that meets edges, corners and diagonals exactly.
        for (x, y) in (0..=16).flat_map(|x| (0..=16).map(move |y| (x, y))) {
            let target = Vector::new(f64::from(x) / 16.0, f64::from(y) / 16.0, 1.0);
            for origin in [middle, target + (target - middle) * 3.0] {
                let direction = (target - origin).normalized();
                let ray = Ray { origin, direction };
                let hit = mesh.hit(&ray, Span::up_to(f64::INFINITY)).unwrap();
                let Part::Face(face) = hit.part else {
                    panic!("a mesh has faces only");
                };
                let place = ray.at(hit.distance_m);
                assert!((place - target).length() < 1e-12);
                let outwards = mesh.flat_normal(face);
                assert!(outwards.dot(target - middle) > 0.0);
                let smooth = mesh.smooth_normal(face, place).unwrap();
                // On a flat side the blend of the corners' normals is that of the sphere.
                assert!((smooth - (target - middle).normalized()).length() < 1e-6);
                let [u, v] = mesh.texture_point(face, place).unwrap();
                assert!((u - target.x).abs() < 1e-6 && (v - target.y).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn what_cannot_be_a_triangle_is_never_hit() {
        let mesh = Mesh::new(MeshParts {
            vertices: vec![
                [0.0; 3],
                [1.0, 0.0, 0.0],
                [2.0, 0.0, 0.0],
                [f32::NAN, 1.0, 0.0],
            ],
            faces: vec![[0, 1, 2], [0, 1, 1], [0, 1, 3], [0, 1, 9]],
            ..MeshParts::default()
        });
        assert_eq!(mesh.triangles(), 0);
        assert!(mesh.bounds().is_none());
        let ray = Ray {
            origin: Vector::new(0.5, 0.1, 1.0),
            direction: -Vector::UP,
        };
        assert_eq!(mesh.hit(&ray, Span::up_to(9.0)), None);
    }

    #[test]
    fn a_mesh_stands_among_other_shapes() {
        let sphere = Sphere {
            center: Vector::new(0.5, 0.5, 3.0),
            radius_m: 0.25,
        };
        let shapes = vec![
            Shape::Mesh(Arc::new(Mesh::new(cube()))),
            Shape::Sphere(sphere),
        ];
        let hierarchy = Hierarchy::over(shapes);
        let down = |z: f64| Ray {
            origin: Vector::new(0.5, 0.4, z),
            direction: -Vector::UP,
        };
        let (above, between) = (down(9.0), down(2.0));
        let nearest = |ray| {
            hierarchy
                .nearest(ray, Span::up_to(99.0))
                .map(|(index, _)| index)
        };
        assert_eq!((nearest(&above), nearest(&between)), (Some(1), Some(0)));
        assert!(hierarchy.is_blocked(&between, Span::up_to(1.1)));
        assert!(!hierarchy.is_blocked(&between, Span::up_to(0.9)));
    }
}
