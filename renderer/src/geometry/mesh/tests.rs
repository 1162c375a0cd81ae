//! A mesh against the plain way: every face in its order, in double precision.

use std::sync::Arc;

use proptest::prelude::*;

use super::super::{Hierarchy, Shape, Sphere};
use super::*;

/// How many meshes are tried; `ACUITY_FUZZ_CASES=20000 cargo test --release -p renderer every_face` is the
/// long run.
fn cases() -> ProptestConfig {
    let asked = std::env::var("ACUITY_FUZZ_CASES").ok();
    let cases = asked.and_then(|number| number.parse().ok());
    ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(cases.unwrap_or(256))
    }
}

/// Triangles of any form: some without area, needles, some that share edges, some there twice.
fn soup() -> impl Strategy<Value = MeshParts> {
    let coordinate = || {
        prop_oneof![
            4 => (-4_i8..=4).prop_map(f32::from),
            4 => -4.0_f32..4.0,
            // Next to each other.
            1 => (-8_i16..=8).prop_map(|ulps| 1.0 + f32::from(ulps) * f32::EPSILON),
            1 => -1e-6_f32..1e-6,
        ]
    };
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

/// The same, of any size and far from the origin of the world.
fn moved_soup() -> impl Strategy<Value = MeshParts> {
    let size = prop_oneof![
        6 => Just(1.0_f32),
        4 => (-9_i32..=12).prop_map(|exponent| 10.0_f32.powi(exponent)),
        1 => prop_oneof![Just(1e-30_f32), Just(1e-18), Just(1e17), Just(1e30)],
    ];
    let away = prop_oneof![Just(0.0_f32), -1e3_f32..1e3, -1e7_f32..1e7];
    (soup(), size, [away.clone(), away.clone(), away]).prop_map(|(mut parts, size, away)| {
        for vertex in &mut parts.vertices {
            for (coordinate, away) in vertex.iter_mut().zip(away) {
                *coordinate = (*coordinate + away) * size;
            }
        }
        parts
    })
}

/// How a ray is made from a mesh: from a place towards one of a face, or nearly along that face.
#[derive(Clone, Debug)]
struct Aim {
    face: prop::sample::Index,
    /// How much the corners of the face count where it is aimed at.
    shares: [f64; 3],
    from: [f64; 3],
    /// How far off the ray begins, in sizes of the mesh.
    off: f64,
    /// By how much of itself the direction leaves the plane of the face, if it is to be nearly in it.
    tilt: Option<f64>,
}

fn aims() -> impl Strategy<Value = Vec<Aim>> {
    let share = || prop_oneof![Just(0.0), Just(0.5), Just(1.0), -0.1_f64..1.1];
    let coordinate = || prop_oneof![(-2_i8..=2).prop_map(f64::from), -2.0..2.0_f64];
    let off = prop_oneof![
        4 => 0.0_f64..2.0,
        1 => Just(0.0),
        1 => (0..12).prop_map(|exponent| 10.0_f64.powi(exponent)),
    ];
    let tilt = prop_oneof![
        3 => Just(None),
        1 => Just(Some(0.0)),
        1 => (-17..-3).prop_map(|exponent| Some(10.0_f64.powi(exponent))),
    ];
    let aim = (
        any::<prop::sample::Index>(),
        [share(), share(), share()],
        [coordinate(), coordinate(), coordinate()],
        off,
        tilt,
    );
    let aim = aim.prop_map(|(face, shares, from, off, tilt)| Aim {
        face,
        shares,
        from,
        off,
        tilt,
    });
    prop::collection::vec(aim, 50)
}

impl Aim {
    fn ray(&self, triangles: &[Triangle], size_m: f64) -> Option<Ray> {
        let triangle = self.face.get(triangles);
        let [a, b, c] = triangle.corners.map(vector);
        let [of_a, of_b, of_c] = self.shares;
        let sum = of_a + of_b + of_c;
        let scale = if sum.abs() > 0.1 { sum.recip() } else { 1.0 };
        let target = (a * of_a + b * of_b + c * of_c) * scale;
        let mut from = Vector::from(self.from);
        if let Some(tilt) = self.tilt {
            let normal = (b - a).cross(c - a).normalized();
            from = from - normal * normal.dot(from);
            from = from + normal * (tilt * from.length());
        }
        let origin = target + from * (self.off * size_m);
        let direction = if self.off == 0.0 {
            from.normalized()
        } else {
            (target - origin).normalized()
        };
        let is_ray = (direction.length_squared() - 1.0).abs() < 1e-9;
        is_ray.then_some(Ray { origin, direction })
    }
}

/// The triangles that can be hit.
fn triangles(parts: &MeshParts) -> Vec<Triangle> {
    let triangles = (0..).zip(&parts.faces).filter_map(|(face, corners)| {
        let [a, b, c] = corners.map(|corner| parts.vertices.get(corner as usize).copied());
        Some(Triangle {
            corners: [a?, b?, c?],
            face,
        })
    });
    triangles.filter(Triangle::has_area).collect()
}

/// The plain way: every face in its order.
fn by_trying_all(triangles: &[Triangle], ray: &Ray, reach_m: f64) -> Option<(f64, u32)> {
    let span = Span::up_to(f64::INFINITY);
    let hits = triangles.iter();
    let hits = hits.filter_map(|t| Some((t.hit(ray, span, reach_m)?, t.face)));
    hits.reduce(|best, next| if next.0 < best.0 { next } else { best })
}

fn check(parts: MeshParts, aims: &[Aim]) -> Result<(), TestCaseError> {
    let triangles = triangles(&parts);
    let mesh = Mesh::new(parts);
    let plain = Mesh {
        tree: mesh.tree.clone().plain(),
        ..mesh.clone()
    };
    prop_assert_eq!(mesh.triangles(), triangles.len());
    if triangles.is_empty() {
        return Ok(());
    }
    let size_m = mesh.tree.diameter_m();
    for ray in aims.iter().filter_map(|aim| aim.ray(&triangles, size_m)) {
        let span = Span::up_to(f64::INFINITY);
        let nearest = by_trying_all(&triangles, &ray, mesh.reach_m);
        let expected = nearest.map(|(distance_m, face)| Hit {
            distance_m,
            part: Part::Face(face),
        });
        for mesh in [&mesh, &plain] {
            prop_assert_eq!(mesh.hit(&ray, span), expected, "{:?}", ray);
            prop_assert_eq!(mesh.is_hit(&ray, span), expected.is_some(), "{:?}", ray);
            if let Some((distance_m, _)) = nearest {
                prop_assert!(!mesh.is_hit(&ray, Span::up_to(distance_m)), "{:?}", ray);
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn a_mesh_finds_what_trying_every_face_finds(parts in soup(), aims in aims()) {
        check(parts, &aims)?;
    }

    #[test]
    fn a_mesh_of_any_size_anywhere_finds_what_trying_every_face_finds(
        parts in moved_soup(),
        aims in aims(),
    ) {
        check(parts, &aims)?;
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
            .nearest(ray, Span::up_to(99.0), None)
            .map(|(index, _)| index)
    };
    assert_eq!((nearest(&above), nearest(&between)), (Some(1), Some(0)));
    assert!(hierarchy.is_blocked(&between, Span::up_to(1.1), None));
    assert!(!hierarchy.is_blocked(&between, Span::up_to(0.9), None));
}
