//! How many studies of 12 subjects are analysed each second by one core: analysis of variance, 15 simple effects and
//! both plateaus with 1000 resamples, as the paper's protocol asks.
//!
//! Run with `cargo bench -p analysis --bench power`. One thread, wall time of that thread.

#![expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "a benchmark looks at the clock, prints, and may stop"
)]

use std::path::Path;
use std::time::Instant;

use analysis::{PowerDesign, PowerSettings, power};
use protocols::Study;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

fn main() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../protocols/meyer-liu-1992.toml");
    let design = PowerDesign::new(&Study::read(&path).unwrap()).unwrap();
    let n_images = design.images().count();
    let rate = |study, subject: u32| -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(study);
        random.set_stream(u64::from(subject));
        (0..n_images)
            .map(|image| (image % 13) as f64 / 2.0 + f64::from(random.next_u32() % 5))
            .collect()
    };
    let settings = PowerSettings {
        subjects: vec![12],
        n_studies: 400,
        alpha: 0.05,
        target: 0.8,
        n_resamples: 1000,
        seed: 1,
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    pool.install(|| {
        for round in 0..4 {
            let start = Instant::now();
            let found = power(&design, &settings, &rate, &|_, _| {}).unwrap();
            let seconds = start.elapsed().as_secs_f64();
            assert_eq!(found.points[0].effects.len(), 3);
            if round > 0 {
                println!(
                    "{:.0} studies a second",
                    f64::from(settings.n_studies) / seconds
                );
            }
        }
    });
}
