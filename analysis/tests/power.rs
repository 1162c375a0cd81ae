//! Power by simulation beside closed forms.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::collections::BTreeMap;
use std::path::Path;

use analysis::{EffectScale, Power, PowerDesign, PowerSettings, power};
use protocols::{Correction, FollowUpPlan, StimulusId, Study};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

fn study(path: &str) -> Study {
    Study::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)).unwrap()
}

/// Own pictures: two details × two kinds × four steps; analysed over the steps alone, without correction.
fn four_steps() -> Study {
    let mut study = study("docs/examples/quantisation/protocol.toml");
    study.protocol.analysis.within = vec!["step".to_owned()];
    study.protocol.analysis.correction = Correction::None;
    study
}

/// The level of a factor of each image that is analysed, in the order of its levels.
fn steps(design: &PowerDesign, study: &Study) -> Vec<usize> {
    let factor = study.protocol.stimuli.factors();
    let factor = factor.iter().position(|name| name == "step").unwrap();
    let images = study.protocol.stimuli.images();
    let level = |id: &StimulusId| {
        let image = images.iter().find(|image| image.id == *id).unwrap();
        image.levels[factor].clone()
    };
    let mut levels: Vec<String> = design.images().map(level).collect();
    levels.sort_by(|left, right| analysis::natural_order(left, right));
    levels.dedup();
    let place = |id: &StimulusId| levels.iter().position(|one| *one == level(id)).unwrap();
    design.images().map(place).collect()
}

/// Subjects with an effect of their own (SD 2) and noise of SD 1 on each picture: compound symmetry. The mean of the
/// four pictures of a step has noise of SD 1/2.
fn rate(steps: &[usize], means: [f64; 4], study: u64, subject: u32) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(study);
    random.set_stream(u64::from(subject));
    let mut uniform = || (f64::from(random.next_u32()) + 0.5) / 4_294_967_296.0;
    let mut normal = || (-2.0 * uniform().ln()).sqrt() * (std::f64::consts::TAU * uniform()).cos();
    let own = 2.0 * normal();
    steps
        .iter()
        .map(|&step| means[step] + own + normal())
        .collect()
}

fn settings(subjects: &[u32], n_studies: u32) -> PowerSettings {
    PowerSettings {
        subjects: subjects.to_vec(),
        n_studies,
        alpha: 0.05,
        target: 0.8,
        n_resamples: 200,
        seed: 1,
    }
}

fn of_steps(study: &Study, means: [f64; 4], settings: &PowerSettings) -> Power {
    let design = PowerDesign::new(study).unwrap();
    let steps = steps(&design, study);
    let rate = |study, subject| rate(&steps, means, study, subject);
    power(&design, settings, &rate, &|_, _| {}).unwrap()
}

#[test]
fn compound_symmetry_has_the_power_of_the_noncentral_f() {
    // R 4.2.2: pf(qf(.95, 3, 3 (n - 1)), 3, 3 (n - 1), ncp = n sum((mu - mean(mu))^2) / .25, lower.tail = FALSE)
    // for mu = 0, .4, .65, .2.
    let closed_form = [
        (6, 0.384_728_442_872),
        (10, 0.655_767_637_162),
        (16, 0.886_469_440_428),
    ];
    let found = of_steps(
        &four_steps(),
        [0.0, 0.4, 0.65, 0.2],
        &settings(&[6, 10, 16], 4000),
    );
    for ((subjects, expected), point) in closed_form.into_iter().zip(&found.points) {
        let [effect] = point.effects.as_slice() else {
            panic!("one effect");
        };
        let error = (expected * (1.0 - expected) / 4000.0_f64).sqrt();
        assert_eq!((point.subjects, effect.effect.as_str()), (subjects, "step"));
        assert!(
            (effect.power - expected).abs() < 3.3 * error && effect.low < effect.power,
            "{subjects} subjects: {effect:?}, {expected} in closed form"
        );
    }
    assert_eq!(found.subjects_needed(), [("step".to_owned(), Some(16))]);
}

#[test]
fn without_an_effect_the_level_is_kept() {
    let found = of_steps(&four_steps(), [1.0; 4], &settings(&[8], 4000));
    let error = (0.05 * 0.95 / 4000.0_f64).sqrt();
    let power = found.points[0].effects[0].power;
    assert!((power - 0.05).abs() < 3.3 * error, "{power}");
    assert_eq!(found.subjects_needed(), [("step".to_owned(), None)]);
}

#[test]
fn simple_effects_are_those_of_paired_tests() {
    // The kinds at each step, two pictures each: a paired t test of the means of two pictures.
    // R 4.2.2: power.t.test(n = 10, delta = 0.9, sd = 1, type = "paired", strict = TRUE, sig.level = .05), and with
    // one step no correction by Holm.
    let mut study = four_steps();
    study.protocol.analysis.within = vec!["step".to_owned(), "quantised".to_owned()];
    let names = study.protocol.stimuli.factors();
    let kind = names.iter().position(|name| name == "quantised").unwrap();
    let images = study.protocol.stimuli.images();
    study.protocol.analysis.follow_ups = vec![FollowUpPlan::SimpleEffects {
        factor: "quantised".to_owned(),
        at: "step".to_owned(),
    }];
    let design = PowerDesign::new(&study).unwrap();
    let steps = steps(&design, &study);
    let is_luma: Vec<bool> = design
        .images()
        .map(|id| images.iter().find(|image| image.id == *id).unwrap().levels[kind] == "luma")
        .collect();
    let rate = |study, subject| {
        let mut ratings = rate(&steps, [0.0; 4], study, subject);
        for ((rating, &step), &is_luma) in ratings.iter_mut().zip(&steps).zip(&is_luma) {
            // So large at the other three steps that Holm's procedure leaves the first its own p.
            let size = if step == 0 { 0.9 } else { 30.0 };
            *rating += if is_luma { size } else { 0.0 };
        }
        ratings
    };
    let found = power(&design, &settings(&[10], 4000), &rate, &|_, _| {}).unwrap();
    let powers: Vec<f64> = (found.points[0].simple_effects.iter())
        .map(|one| one.power)
        .collect();
    let expected = 0.717_181_217_125;
    let error = (expected * (1.0 - expected) / 4000.0_f64).sqrt();
    assert!((powers[0] - expected).abs() < 3.3 * error, "{powers:?}");
    assert_eq!(powers[1..], [1.0; 3]);
}

#[test]
fn an_effect_is_scaled_by_itself() {
    let study = study("protocols/meyer-liu-1992.toml");
    let design = PowerDesign::new(&study).unwrap();
    // Quality: 2 for the channel, 1 for each 10K, and their product.
    let images = study.protocol.stimuli.images();
    let number = |image: &protocols::StudyImage| {
        let levels = &image.levels;
        let rays: f64 = levels[1].trim_end_matches('K').parse().unwrap();
        let channel = if levels[0] == "chromatic" { 1.0 } else { -1.0 };
        (channel, (rays - 70.0) / 10.0)
    };
    let quality = |[channel_by, rays_by, both_by]: [f64; 3]| -> BTreeMap<StimulusId, f64> {
        (images.iter())
            .map(|image| {
                let (channel, rays) = number(image);
                let both = 0.1 * channel * rays;
                let value = 5.0 + 2.0 * channel_by * channel + rays_by * rays + both_by * both;
                (image.id.clone(), value)
            })
            .collect()
    };
    let scales = [("channel", 0.5), ("channel:rays", 0.0)].map(|(effect, factor)| EffectScale {
        effect: effect.to_owned(),
        factor,
    });
    let scaled = design.scaled(&quality([1.0; 3]), &scales).unwrap();
    let expected = quality([0.5, 1.0, 0.0]);
    for id in design.images() {
        assert!((scaled[id] - expected[id]).abs() < 1e-12, "{id}");
    }
    assert_eq!(design.images().count(), 26);
    let unknown = [EffectScale {
        effect: "rays:channel".to_owned(),
        factor: 1.0,
    }];
    let error = design.scaled(&quality([1.0; 3]), &unknown).unwrap_err();
    assert!(error.to_string().contains("channel:rays"), "{error}");
}

#[test]
fn an_asymptote_without_noise_is_found_with_a_narrow_interval() {
    let study = study("protocols/meyer-liu-1992.toml");
    let design = PowerDesign::new(&study).unwrap();
    let images = study.protocol.stimuli.images();
    let corner = |id: &StimulusId| {
        let image = images.iter().find(|image| image.id == *id).unwrap();
        let rays: f64 = image.levels[1].trim_end_matches('K').parse().unwrap();
        let psi = if image.levels[0] == "chromatic" {
            30.0
        } else {
            90.0
        };
        9.0 - 0.08 * (psi - rays).max(0.0)
    };
    let heights: Vec<f64> = design.images().map(corner).collect();
    // A whole number of its own for each subject moves the curve and not its corner.
    let rate = |_, subject: u32| {
        heights
            .iter()
            .map(|height| height + f64::from(subject))
            .collect()
    };
    let found = power(&design, &settings(&[5], 20), &rate, &|_, _| {}).unwrap();
    let asymptotes = &found.points[0].asymptotes;
    let estimates: Vec<(&str, f64)> = (asymptotes.iter())
        .map(|one| (one.curve.as_str(), (1e6 * one.estimate).round() / 1e6))
        .collect();
    assert_eq!(
        estimates,
        [
            ("achromatic", 90.0),
            ("chromatic", 30.0),
            ("difference", 60.0)
        ]
    );
    assert!(
        asymptotes
            .iter()
            .all(|one| one.width < 1e-6 && one.unit == "K")
    );
}

#[test]
fn the_same_seed_gives_the_same_numbers_on_any_number_of_threads() {
    let of = |n_threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads);
        let pool = pool.build().unwrap();
        let settings = settings(&[5, 7], 60);
        pool.install(|| of_steps(&four_steps(), [0.0, 0.4, 0.65, 0.2], &settings).to_json())
    };
    assert_eq!(of(1), of(4));
}
