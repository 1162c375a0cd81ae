//! How many samples a second of CPU time buys: intersecting, shading, and the tree's own work.
//!
//! `cargo bench -p renderer --bench trace -- SCENE ...` traces each scene on one thread at 320 × 320 pixels,
//! 140K rays, 16 bands, and prints nanoseconds a sample and samples a CPU second; by default the study's scene,
//! and the same with a mesh of 100,352 triangles in it.
#![expect(clippy::print_stdout, reason = "a bench prints what it measured")]

mod clock;

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::hint::black_box;
use std::path::{Path, PathBuf};

use clock::least_secs;
use protocols::{Channel, PerChannel, Quadrature, RefinementDriver};
use rayon::ThreadPoolBuilder;
use renderer::{
    RayTree, Reach, RendererError, Sampler as _, Scene, SceneSampler, ScreenPoint, TracePlan, trace,
};

const STUDY: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../stimuli/scenes/opponent-solids.toml"
);

/// The mesh has 2 · SIDE² triangles.
const SIDE: u32 = 224;

const SIZE_PX: [u32; 2] = [320, 320];
const RAYS: usize = 140_000;
const ROUNDS: usize = 5;
/// As many samples as a trace sorts by place, and takes side by side.
const BATCH: usize = 8192;
const TOGETHER: usize = 512;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = std::env::args().skip(1);
    let named = arguments.filter(|a| !a.starts_with("--"));
    let mut scenes: Vec<PathBuf> = named.map(PathBuf::from).collect();
    let folder = tempfile::tempdir()?;
    if scenes.is_empty() {
        scenes.push(PathBuf::from(STUDY));
        scenes.push(with_a_mesh(folder.path())?);
    }
    let pool = ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.unwrap_or_else(|error| unreachable!("a thread: {error}"));
    for scene in &scenes {
        pool.install(|| measure(scene))?;
    }
    Ok(())
}

/// The study's scene with a bumpy ball of triangles in front, in files of their own.
fn with_a_mesh(folder: &Path) -> Result<PathBuf, Box<dyn Error>> {
    let mut mesh = String::new();
    for row in 0..=SIDE {
        for column in 0..=SIDE {
            let theta = f64::from(row) / f64::from(SIDE) * PI;
            let phi = f64::from(column % SIDE) / f64::from(SIDE) * TAU;
            let radius = 1.0 + 0.08 * (9.0 * theta).sin() * (11.0 * phi).cos();
            let across = radius * theta.sin();
            let (x, y) = (across * phi.cos(), across * phi.sin());
            writeln!(mesh, "v {x} {y} {}", radius * theta.cos())?;
        }
    }
    for row in 0..SIDE {
        for column in 0..SIDE {
            let a = row * (SIDE + 1) + column + 1;
            let (b, c, d) = (a + 1, a + SIDE + 1, a + SIDE + 2);
            writeln!(mesh, "f {a} {c} {b}\nf {b} {c} {d}")?;
        }
    }
    std::fs::write(folder.join("ball.obj"), mesh)?;
    let study = std::fs::read_to_string(STUDY)?;
    let ball = r#"{ file = "ball.obj", material = "red-paint", position_m = [0.9, -3.6, 1.2], scale = 0.6 }"#;
    let path = folder.join("opponent-solids and a mesh.toml");
    std::fs::write(&path, format!("mesh = [{ball}]\n{study}"))?;
    Ok(path)
}

fn measure(path: &Path) -> Result<(), RendererError> {
    let scene = Scene::read(path)?;
    let sampler = scene.sampler(Quadrature::Bands(16), SIZE_PX);
    let plan = TracePlan {
        until: None,
        seed: 1992,
        size_px: SIZE_PX,
        min_depth: 8,
        driver: RefinementDriver::A,
        stops: PerChannel::from_fn(|_| Reach::rays(RAYS)),
    };
    let tree = trace(&sampler, &plan, &|_, _| ());
    let points = tree.points();
    let mut trees = vec![RayTree::default(); RAYS];
    for (&point, tree) in points.iter().zip(&mut trees) {
        sampler.intersect(point, tree);
    }
    let bits = bits(&sampler, &trees);
    let hits: u32 = trees.iter().map(RayTree::hits).sum();
    let nanoseconds = |secs: f64| 1e9 * secs / RAYS as f64;
    let [alone, intersect] = intersecting_secs(&sampler, points).map(nanoseconds);
    let shading = |shade: &dyn Fn(&RayTree)| nanoseconds(shading_secs(&trees, shade));
    let shade = Channel::ALL.map(|channel| {
        shading(&|tree| {
            black_box(sampler.shade(tree, channel));
        })
    });
    let shade_all = shading(&|tree| {
        black_box(sampler.shade_all(tree));
    });
    let whole = nanoseconds(least_secs(ROUNDS, || {
        black_box(trace(&sampler, &plan, &|_, _| ()));
    }));
    let upkeep = whole - intersect - shade_all;
    println!(
        "{}: {:.2} hits a sample; set-up {:.1} ms; bits {bits:016x}",
        path.display(),
        f64::from(hits) / RAYS as f64,
        1e3 * set_up_secs(&scene)
    );
    println!(
        "  intersect {intersect:.0} ns (one by one {alone:.0}), shade A {:.1}, C1 {:.1}, C2 {:.1}, all at once {shade_all:.1} ns",
        shade[0], shade[1], shade[2]
    );
    println!(
        "  the tree's own work {upkeep:.0} ns, {:.0}% of {whole:.0} ns",
        100.0 * upkeep / whole
    );
    println!("  {:.2} M samples a CPU second", 1e3 / whole);
    Ok(())
}

/// The points in about the order in which a trace takes them.
fn by_place(mut points: Vec<ScreenPoint>) -> Vec<ScreenPoint> {
    let row = |point: &ScreenPoint| (point.y * 64.0).floor();
    for batch in points.chunks_mut(BATCH) {
        batch.sort_by(|a, b| row(a).total_cmp(&row(b)).then(a.x.total_cmp(&b.x)));
    }
    points
}

/// A digest of all values (FNV-1a), so that two versions can be told apart.
fn bits(sampler: &SceneSampler<'_>, trees: &[RayTree]) -> u64 {
    let values = trees
        .iter()
        .flat_map(|tree| Channel::ALL.map(|channel| sampler.shade(tree, channel)));
    values.fold(0xcbf2_9ce4_8422_2325, |digest, value| {
        (digest ^ u64::from(value.to_bits())).wrapping_mul(0x0100_0000_01b3)
    })
}

/// How long it takes to make a sampler.
fn set_up_secs(scene: &Scene) -> f64 {
    // The clock's ticks are too long for a single pass.
    let passes = 10;
    let secs = least_secs(ROUNDS, || {
        for _ in 0..passes {
            black_box(scene.sampler(Quadrature::Bands(16), SIZE_PX));
        }
    });
    secs / f64::from(passes)
}

/// How long it takes to intersect all, one by one and side by side.
fn intersecting_secs(sampler: &SceneSampler<'_>, points: Vec<ScreenPoint>) -> [f64; 2] {
    let mut one = RayTree::default();
    let alone = least_secs(ROUNDS, || {
        for &point in &points {
            sampler.intersect(point, &mut one);
            black_box(&one);
        }
    });
    let mut some = vec![RayTree::default(); TOGETHER];
    let points = by_place(points);
    let together = least_secs(ROUNDS, || {
        for points in points.chunks(TOGETHER) {
            sampler.intersect_all(points, &mut some[..points.len()]);
            black_box(&some);
        }
    });
    [alone, together]
}

/// How long it takes to shade all.
fn shading_secs(trees: &[RayTree], shade: &dyn Fn(&RayTree)) -> f64 {
    let passes = 8;
    let secs = least_secs(ROUNDS, || {
        for _ in 0..passes {
            trees.iter().for_each(shade);
        }
    });
    secs / f64::from(passes)
}
