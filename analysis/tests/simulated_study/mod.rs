//! Ratings files of made-up observers, written as a session writes them.

use std::fs;
use std::path::Path;

use protocols::rating::{Phase, RatingRow, header_line};
use protocols::{DataSet, Observer, StimulusPlan, Study};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

/// The paper's study.
pub(crate) fn paper() -> Study {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../protocols/meyer-liu-1992.toml");
    Study::read(&path).unwrap()
}

/// The rows of one session: three practice trials, then every image in the order of the protocol.
///
/// Achromatic ratings rise to 9 with a constant of 35K rays, chromatic ones with one of 8K; noise is a
/// triangle of two points either way.
pub(crate) fn session(study: &Study, subject: &str, seed: u64) -> Vec<RatingRow> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut uniform = || f64::from(random.next_u32()) / f64::from(u32::MAX);
    let bias = 2.0 * uniform() - 1.0;
    let plan = study.render_plan().unwrap();
    let shown = plan
        .stimuli()
        .into_iter()
        .filter(|stimulus| !stimulus.sequences.is_empty());
    let practice = study.protocol.session.practice.iter().map(|id| {
        let known = plan
            .stimuli()
            .into_iter()
            .find(|stimulus| stimulus.id == *id);
        (Phase::Practice, known.unwrap())
    });
    let trials = practice.chain(shown.map(|stimulus| (Phase::Test, stimulus)));
    let mut rows = Vec::new();
    for (index, (phase, stimulus)) in trials.enumerate() {
        let risen = |rays: protocols::RayCount, constant: f64| {
            1.0 - (-f64::from(rays.get()) / constant).exp()
        };
        let quality = 9.0 * risen(stimulus.rays_a, 35_000.0) * risen(stimulus.rays_c1c2, 8_000.0);
        let noise = 2.0 * (uniform() + uniform() - 1.0);
        let trial = u32::try_from(index).unwrap() + 1;
        rows.push(RatingRow {
            subject_id: subject.parse().unwrap(),
            session_id: 1,
            trial_id: trial,
            phase,
            stimulus_id: stimulus.id.clone(),
            repetition: 1,
            levels: stimulus.factors().into_values().collect(),
            rating: study.protocol.session.scale.nearest(quality + bias + noise),
            reference_rating: None,
            shown_first: None,
            response_time_s: 1.5 + 3.0 * uniform(),
            exposure_requested_s: 10.0,
            exposure_submitted_s: 10.002,
            missed_frames: u32::from(trial == 7),
            showings: 1,
            started_at: format!("2026-11-21T09:{trial:02}:00.000Z"),
            observer: Observer::Person,
            pilot: false,
        });
    }
    rows
}

/// Writes the ratings and the sidecar of one session into the data set in `root`.
pub(crate) fn write_session(study: &Study, root: &Path, rows: &[RatingRow]) {
    let data_set = DataSet::new(root, &study.protocol.study);
    let first = rows.first().unwrap();
    let task = if first.pilot { "pilot" } else { "rating" };
    let path = data_set.ratings_path(&first.subject_id, first.session_id, task);
    let mut text = header_line(&StimulusPlan::factors());
    text.extend(rows.iter().map(RatingRow::to_line));
    fs::create_dir_all(data_set.data_folder()).unwrap();
    fs::write(&path, text).unwrap();
    let sidecar = format!("{{\"protocol_sha256\": \"{}\"}}\n", study.sha256);
    fs::write(DataSet::sidecar_path(&path), sidecar).unwrap();
}

/// Writes the sessions of `n` people, 01, 02 and so on.
pub(crate) fn write_people(study: &Study, root: &Path, n: u64) {
    for subject in 1..=n {
        write_session(
            study,
            root,
            &session(study, &format!("{subject:02}"), subject),
        );
    }
}
