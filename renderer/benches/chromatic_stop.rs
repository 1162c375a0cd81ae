//! What stopping C1 and C2 early saves: Meyer & Liu (1992), section 3.3.
//!
//! `cargo bench -p renderer --bench chromatic_stop` shades the samples of one tree of 140K rays on one thread:
//! all channels for all of them, and C1 and C2 for the first 30K only. Their share of the time stands beside
//! the paper's bound for the saving, (2p - q - r) / 3p, and so does the share of reconstruction.
#![expect(clippy::print_stdout, reason = "a bench prints what it measured")]

mod clock;

use std::hint::black_box;
use std::path::Path;

use clock::least_secs;
use protocols::{Channel, PerChannel, Quadrature, RefinementDriver};
use rayon::ThreadPoolBuilder;
use renderer::{
    Cell, RayTree, Reach, RendererError, Sampler as _, Scene, ScreenTree, TracePlan, Wanted,
    snapshots, trace,
};

const SIZE_PX: [u32; 2] = [320, 320];
const RAYS: usize = 140_000;
const CHROMATIC_RAYS: usize = 30_000;
const ROUNDS: usize = 25;

fn main() -> Result<(), RendererError> {
    let scene = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../stimuli/scenes/opponent-solids.toml"
    );
    let scene = Scene::read(Path::new(scene))?;
    let pool = ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.unwrap_or_else(|error| unreachable!("a thread: {error}"));
    let bound = 2.0 * (RAYS - CHROMATIC_RAYS) as f64 / (3.0 * RAYS as f64);
    println!("the paper's bound: {:.1}% saved", 100.0 * bound);
    println!("quadrature, shading by: all channels in full; saved with C1 and C2 stopped");
    pool.install(|| {
        for (name, quadrature) in [
            ("16 bands", Quadrature::Bands(16)),
            ("61 bands", Quadrature::Bands(61)),
            ("Meyer's 4", Quadrature::Meyer1988),
        ] {
            measure_shading(&scene, name, quadrature);
        }
        measure_reconstruction(&scene);
    });
    Ok(())
}

/// The first rays of the channel when it is in full and when it is stopped.
fn rays(channel: Channel, is_stopped: Stop) -> usize {
    match (channel, is_stopped) {
        (Channel::C1 | Channel::C2, Stop::Early) => CHROMATIC_RAYS,
        _ => RAYS,
    }
}

#[derive(Clone, Copy)]
enum Stop {
    Never,
    Early,
}

fn plan() -> TracePlan {
    TracePlan {
        until: None,
        seed: 1992,
        size_px: SIZE_PX,
        min_depth: 8,
        driver: RefinementDriver::A,
        stops: PerChannel::from_fn(|_| Reach::rays(RAYS)),
    }
}

/// A way to shade one channel of one ray tree.
type Shading<'a> = &'a dyn Fn(&RayTree, Channel) -> f32;

fn shade_all(trees: &[RayTree], stop: Stop, one: Shading<'_>) {
    for channel in Channel::ALL {
        for tree in &trees[..rays(channel, stop)] {
            black_box(one(tree, channel));
        }
    }
}

fn measure_shading(scene: &Scene, name: &str, quadrature: Quadrature) {
    let sampler = scene.sampler(quadrature, SIZE_PX);
    let tree = trace(&sampler, &plan(), &|_, _| ());
    let trees: Vec<RayTree> = tree
        .points()
        .into_iter()
        .map(|point| {
            let mut tree = RayTree::default();
            sampler.intersect(point, &mut tree);
            tree
        })
        .collect();
    let products = |tree: &RayTree, channel| sampler.shade(tree, channel);
    let wavelengths = |tree: &RayTree, channel| sampler.shade_by_wavelength(tree, channel);
    let ways: [(&str, Shading<'_>); 2] = [("products", &products), ("wavelengths", &wavelengths)];
    for (way, one) in ways {
        print_least(&format!("{name}, {way}"), |stop| {
            shade_all(&trees, stop, one);
        });
    }
}

fn measure_reconstruction(scene: &Scene) {
    let sampler = scene.sampler(Quadrature::Bands(16), SIZE_PX);
    let tree: ScreenTree = trace(&sampler, &plan(), &|_, _| ());
    let filter = |stop: Stop| {
        let wanted = PerChannel::from_fn(|channel| Wanted {
            rays: [rays(channel, stop)].into(),
            depth: Cell::DEEPEST,
        });
        black_box(snapshots(&tree, &wanted, SIZE_PX));
    };
    print_least("reconstruction", filter);
}

/// Prints the least time of the work in full, and what of it the least time with stopped channels saves; taken in
/// turn, so that what else the machine does falls on both.
fn print_least(name: &str, mut work: impl FnMut(Stop)) {
    let (mut full, mut stopped) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        full = full.min(least_secs(1, || work(Stop::Never)));
        stopped = stopped.min(least_secs(1, || work(Stop::Early)));
    }
    let saved = 100.0 * (1.0 - stopped / full);
    println!("{name}: {:.1} ms; {saved:.1}%", 1e3 * full);
}
