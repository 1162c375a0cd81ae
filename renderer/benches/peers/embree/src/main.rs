//! The same rays and the same mesh of 100,000 triangles, ours and Embree 3's: time and hits.
//!
//! `cargo run --release` (with Debian's `libembree-dev`) prints, for one thread and one ray at a time, the
//! CPU time of primary rays in the order of the pixels, of the same in random order, and of shadow rays; in
//! each round ours and Embree's run one after the other, and the ratio is that of the least times.

use std::hint::black_box;

use embree3::{
    BufferUsage, Device, Format, GeometryKind, IntersectContext, Ray, RayHit, SceneFlags,
};
use renderer::TriangleMesh;

#[path = "../../../clock/mod.rs"]
mod clock;

use clock::least_secs;

const SIDE: u32 = 224;
const PIXELS: u32 = 512;
const ROUNDS: usize = 9;
const LIGHT: [f64; 3] = [4.0, -3.0, 5.0];

/// A ray: an origin and a unit direction.
#[derive(Clone, Copy)]
struct Line {
    origin: [f64; 3],
    direction: [f64; 3],
    length: f64,
}

fn main() -> Result<(), embree3::Error> {
    let (vertices, faces) = bumpy_ball();
    let ours = TriangleMesh::new(vertices.clone(), faces.clone());
    let device = Device::new()?;
    let mut builder = device.create_geometry(GeometryKind::TRIANGLE)?;
    builder
        .set_new_buffer::<[f32; 3]>(BufferUsage::VERTEX, 0, Format::FLOAT3, 12, vertices.len())?
        .copy_from_slice(&vertices);
    builder
        .set_new_buffer::<[u32; 3]>(BufferUsage::INDEX, 0, Format::UINT3, 12, faces.len())?
        .copy_from_slice(&faces);
    let geometry = builder.commit();
    let mut scene = device.create_scene()?;
    scene.set_flags(SceneFlags::ROBUST);
    scene.attach_geometry(&geometry);
    scene.commit();

    println!("{} triangles, {} rays", ours.triangles(), PIXELS * PIXELS);
    let primary = primary_rays();
    let mut shuffled = primary.clone();
    shuffle(&mut shuffled);
    let embree_hit = |line: &Line| {
        let mut hit = RayHit::from_ray(segment(line));
        scene.intersect(&mut IntersectContext::incoherent(), &mut hit);
        hit.hit.is_valid().then_some((hit.ray.tfar, hit.hit.primID))
    };
    agree(&ours, &primary, &embree_hit);
    let our_hit = |line: &Line| ours.nearest(line.origin, line.direction);
    for (name, lines) in [("in order", &primary), ("shuffled", &shuffled)] {
        let times = compare(
            || lines.iter().for_each(|line| drop(black_box(our_hit(line)))),
            || {
                lines
                    .iter()
                    .for_each(|line| drop(black_box(embree_hit(line))))
            },
        );
        report(&format!("primary rays {name}"), lines.len(), times);
    }
    let shadows = shadow_rays(&ours, &shuffled);
    let times = compare(
        || {
            for line in &shadows {
                black_box(ours.is_blocked(line.origin, line.direction, line.length));
            }
        },
        || {
            for line in &shadows {
                let mut ray = segment(line);
                black_box(scene.occluded(&mut IntersectContext::incoherent(), &mut ray));
            }
        },
    );
    report("shadow rays shuffled", shadows.len(), times);
    Ok(())
}

fn compare(mut ours: impl FnMut(), mut theirs: impl FnMut()) -> [f64; 2] {
    let mut least = [f64::INFINITY; 2];
    for _ in 0..ROUNDS {
        least[0] = least[0].min(least_secs(1, &mut ours));
        least[1] = least[1].min(least_secs(1, &mut theirs));
    }
    least
}

fn report(what: &str, rays: usize, [ours, theirs]: [f64; 2]) {
    let ns = |secs: f64| 1e9 * secs / rays as f64;
    println!(
        "{what}: ours {:.0} ns, Embree {:.0} ns, ratio {:.2}",
        ns(ours),
        ns(theirs),
        ours / theirs
    );
}

/// Counts where the two find different faces; on an edge between two either is right.
fn agree(ours: &TriangleMesh, lines: &[Line], theirs: &dyn Fn(&Line) -> Option<(f32, u32)>) {
    let (mut hits, mut other_face, mut apart) = (0, 0, 0);
    for line in lines {
        match (ours.nearest(line.origin, line.direction), theirs(line)) {
            (Some((distance, face)), Some((their_distance, their_face))) => {
                hits += 1;
                other_face += u32::from(face != their_face);
                apart += u32::from((distance - f64::from(their_distance)).abs() > 1e-5 * distance);
            }
            (None, None) => {}
            _ => apart += 1,
        }
    }
    println!(
        "{hits} hits; {other_face} on another face, {apart} more than 1e-5 apart or missed by one"
    );
}

fn segment(line: &Line) -> Ray {
    let single = |v: [f64; 3]| v.map(|coordinate| coordinate as f32);
    Ray::segment(
        single(line.origin),
        single(line.direction),
        0.0,
        line.length as f32,
    )
}

/// A ball of radius 1 with bumps, of 2 · SIDE² triangles.
fn bumpy_ball() -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let angle = |place: u32, whole: f64| f64::from(place) / f64::from(SIDE) * whole;
    let mut vertices = Vec::new();
    for row in 0..=SIDE {
        for column in 0..=SIDE {
            let (theta, phi) = (
                angle(row, std::f64::consts::PI),
                angle(column % SIDE, std::f64::consts::TAU),
            );
            let radius = 1.0 + 0.08 * (9.0 * theta).sin() * (11.0 * phi).cos();
            let place = [
                theta.sin() * phi.cos(),
                theta.sin() * phi.sin(),
                theta.cos(),
            ];
            vertices.push(place.map(|coordinate| (radius * coordinate) as f32));
        }
    }
    let faces = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| row * (SIDE + 1) + column));
    let faces = faces.flat_map(|a| {
        let (b, c, d) = (a + 1, a + SIDE + 1, a + SIDE + 2);
        [[a, c, b], [b, c, d]]
    });
    (vertices, faces.collect())
}

fn unit(v: [f64; 3]) -> ([f64; 3], f64) {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    (v.map(|x| x / length), length)
}

/// One ray for each pixel of a picture that the ball fills.
fn primary_rays() -> Vec<Line> {
    let origin = [0.0, -4.0, 0.0];
    let pixels = (0..PIXELS).flat_map(|y| (0..PIXELS).map(move |x| (x, y)));
    let line = |(x, y)| {
        let across =
            |place: u32| (2.0 * (f64::from(place) + 0.37) / f64::from(PIXELS) - 1.0) * 0.28;
        let (direction, _) = unit([across(x), 1.0, across(y)]);
        Line {
            origin,
            direction,
            length: f64::INFINITY,
        }
    };
    pixels.map(line).collect()
}

/// From just off each hit towards a light.
fn shadow_rays(mesh: &TriangleMesh, lines: &[Line]) -> Vec<Line> {
    let shadow = |line: &Line| {
        let (distance, _) = mesh.nearest(line.origin, line.direction)?;
        let near = distance * (1.0 - 1e-4);
        let origin: [f64; 3] =
            std::array::from_fn(|axis| line.origin[axis] + near * line.direction[axis]);
        let (direction, length) = unit(std::array::from_fn(|axis| LIGHT[axis] - origin[axis]));
        Some(Line {
            origin,
            direction,
            length,
        })
    };
    lines.iter().filter_map(shadow).collect()
}

/// Fisher and Yates with Knuth's generator.
fn shuffle(lines: &mut [Line]) {
    let mut state = 1992_u64;
    for last in (1..lines.len()).rev() {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        lines.swap(last, (state >> 33) as usize % (last + 1));
    }
}
