//! A mesh of triangles.
//!
//! Vertices are in single precision, as mesh files hold them; where a ray meets a triangle is computed in
//! double precision from the same vertices for all triangles that share them, so that nothing slips through
//! an edge. A triangle without area, or with a vertex that is not there or not finite, is never hit.
//!
//! A ray is tried against four triangles at a time in single precision, which lets through every one that it
//! may meet, and then against these one by one.
#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

use std::ops::Range;

use wide::f32x4;

use super::box_tree::MARGIN;
use super::descent::{Visitor, Walk};
use super::packet::{LANES, Packet};
use super::single_ray::{SingleRay, rounded};
use super::triangle::{Triangle, vector};
use super::{Bounds, BoxTree, Hit, Part, Ray, Span, Vector};

/// How far apart a place of a tree and the origin of a [`SingleRay`] may be, as a multiple of its diameter.
const SIZE: f64 = 1.25;

/// Triangles that share vertices.
#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    tree: BoxTree,
    /// The triangles, those of a leaf of the tree together.
    packets: Vec<Packet>,
    /// The middle of the tree.
    middle: [f32x4; 3],
    /// How far from the box of its triangle a hit may be.
    reach_m: f64,
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
        let triangles: Vec<Triangle> = (0..).zip(&faces).filter_map(triangle).collect();
        let boxes: Vec<Bounds> = triangles.iter().map(Triangle::bounds).collect();
        let mut tree = BoxTree::over(&boxes, LANES);
        let size_m = SIZE * tree.diameter_m();
        let mut packets = Vec::new();
        let order = tree.order().to_vec();
        tree.pack(|places| {
            let of_leaf = order[places].iter().map(|&place| triangles[place as usize]);
            packets.push(Packet::of(of_leaf, size_m));
            u32::try_from(packets.len() - 1).unwrap_or(u32::MAX)
        });
        Self {
            middle: rounded(tree.middle()).map(f32x4::splat),
            reach_m: 0.5 * MARGIN * tree.diameter_m(),
            tree,
            packets,
            faces,
            vertices,
            normals,
            texture_points,
        }
    }

    /// How many triangles can be hit.
    pub(crate) fn triangles(&self) -> usize {
        self.packets.iter().map(Packet::len).sum()
    }

    /// The box that holds the mesh; `None` if no triangle can be hit.
    pub(crate) fn bounds(&self) -> Option<Bounds> {
        self.tree.bounds()
    }

    /// The first hit within the span; of equal ones that of the first face.
    pub(crate) fn hit(&self, ray: &Ray, span: Span) -> Option<Hit> {
        let mut search = Nearest {
            mesh: self,
            ray,
            best: None,
        };
        self.tree.visit(ray, span, &mut search);
        search.best.map(|(distance_m, face)| Hit {
            distance_m,
            part: Part::Face(face),
        })
    }

    /// Whether anything is hit within the span.
    pub(crate) fn is_hit(&self, ray: &Ray, span: Span) -> bool {
        self.tree.visit(ray, span, &mut Any { mesh: self, ray }) == Walk::Stop
    }

    /// Tries one triangle after another of those that the ray may meet.
    #[inline(always)]
    fn try_packets(
        &self,
        places: Range<usize>,
        single: Option<&SingleRay>,
        mut try_triangle: impl FnMut(&Triangle) -> Walk,
    ) -> Walk {
        for packet in &self.packets[places] {
            let mut left = match single {
                Some(single) => packet.may_meet(&self.middle, single),
                None => packet.lanes_used(),
            };
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                if try_triangle(&packet.triangle(lane)) == Walk::Stop {
                    return Walk::Stop;
                }
            }
        }
        Walk::On
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

/// The search for the nearest triangle.
struct Nearest<'a> {
    mesh: &'a Mesh,
    ray: &'a Ray,
    best: Option<(f64, u32)>,
}

impl Visitor for Nearest<'_> {
    const NEAREST_FIRST: bool = true;

    #[inline(always)]
    fn visit(&mut self, places: Range<usize>, single: Option<&SingleRay>, span: &mut Span) -> Walk {
        self.mesh.try_packets(places, single, |triangle| {
            let Some(distance_m) = triangle.hit(self.ray, *span, self.mesh.reach_m) else {
                return Walk::On;
            };
            let is_first = self.best.is_none_or(|(best_m, face)| {
                distance_m < best_m || (distance_m == best_m && triangle.face < face)
            });
            if is_first {
                self.best = Some((distance_m, triangle.face));
                // The next float, so that an equal hit of an earlier face still counts.
                span.to_m = distance_m.next_up();
            }
            Walk::On
        })
    }
}

/// The search for any triangle.
struct Any<'a> {
    mesh: &'a Mesh,
    ray: &'a Ray,
}

impl Visitor for Any<'_> {
    const NEAREST_FIRST: bool = false;

    #[inline(always)]
    fn visit(&mut self, places: Range<usize>, single: Option<&SingleRay>, span: &mut Span) -> Walk {
        self.mesh.try_packets(places, single, |triangle| {
            if triangle.hit(self.ray, *span, self.mesh.reach_m).is_some() {
                Walk::Stop
            } else {
                Walk::On
            }
        })
    }
}

#[cfg(test)]
mod tests;
