//! Simulated observers, from a stimulus set to a data set.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use common::{small_study, write_stimuli};
use experiment::{ExperimentError, SimulationSummary, simulate};
use protocols::rating::{Phase, columns, read_ratings};
use protocols::{DataSet, Observer, StimulusPlan, Study};
use serde_json::Value;

struct Place {
    folder: tempfile::TempDir,
    study: Study,
    stimuli: PathBuf,
}

impl Place {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let study = small_study(folder.path());
        let stimuli = write_stimuli(&study, folder.path());
        Self {
            folder,
            study,
            stimuli,
        }
    }

    fn data(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn simulate(
        &self,
        name: &str,
        subjects: u32,
        seed: u64,
    ) -> Result<SimulationSummary, ExperimentError> {
        simulate(
            &self.study,
            &self.stimuli,
            &self.data(name),
            subjects,
            seed,
            &|_, _| {},
        )
    }
}

fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            let below = files(&path).into_iter();
            let name = PathBuf::from(path.file_name().unwrap());
            found.extend(below.map(|(inner, bytes)| (name.join(inner), bytes)));
        } else {
            let bytes = fs::read(&path).unwrap();
            found.insert(path.file_name().unwrap().into(), bytes);
        }
    }
    found
}

#[test]
fn every_observer_rates_every_image_of_the_sequences_once() {
    let place = Place::new();
    place.simulate("data", 3, 7).unwrap();
    let data_set = DataSet::new(place.data("data"), &place.study.protocol.study);
    for subject in ["01", "02", "03"] {
        let path = data_set.ratings_path(&subject.parse().unwrap(), 1, "rating");
        let rows = read_ratings(&path, &StimulusPlan::factors()).unwrap().rows;
        let mut rated: Vec<String> = rows
            .iter()
            .filter(|row| row.phase == Phase::Test)
            .map(|row| row.stimulus_id.to_string())
            .collect();
        rated.sort_unstable();
        let mut expected: Vec<String> = place
            .study
            .protocol
            .stimuli
            .images()
            .iter()
            .map(|stimulus| stimulus.id.to_string())
            .filter(|id| id != "a010k_c010k")
            .collect();
        expected.sort_unstable();
        assert_eq!(rated, expected);
        assert_eq!(rows.len(), 30);
        assert!(
            rows.iter()
                .all(|row| row.observer == Observer::Simulated && !row.pilot)
        );
        // At 60 virtual frames a second no exposure is off by more than half a frame.
        assert!(
            rows.iter()
                .all(|row| (row.exposure_submitted_s - 0.2).abs() <= 0.5 / 60.0)
        );
        assert!(
            rows.iter()
                .all(|row| row.missed_frames == 0 && row.response_time_s > 0.0)
        );
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes_on_any_number_of_threads() {
    let place = Place::new();
    let with_threads = |threads: usize, name: &str| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| place.simulate(name, 5, 11)).unwrap();
        files(&place.data(name))
    };
    let one = with_threads(1, "one");
    assert_eq!(one, with_threads(3, "three"));
    place.simulate("three", 5, 12).unwrap();
    assert_ne!(
        one,
        files(&place.data("three")),
        "another seed, other ratings"
    );
    place.simulate("three", 5, 11).unwrap();
    assert_eq!(
        one,
        files(&place.data("three")),
        "a new run replaces the old data set"
    );
}

#[test]
fn without_bias_and_noise_an_observer_answers_what_the_model_of_vision_says() {
    let mut place = Place::new();
    let model = &mut place.study.protocol.simulation;
    (
        model.bias.sd,
        model.noise.sd,
        model.gain.mean,
        model.gain.sd,
    ) = (0.0, 0.0, 1.0, 0.0);
    let summary = place.simulate("data", 1, 1).unwrap();
    let zero = &summary.qualities[&place.study.protocol.stimuli.zero_anchor().unwrap()];
    let ten = &summary.qualities[&place.study.protocol.stimuli.ten_anchor().unwrap()];
    assert_eq!((zero.on_scale, ten.on_scale), (0.0, 10.0));
    // An image against itself has no difference: 10 JOD by definition of the unit.
    assert!((ten.jod - 10.0).abs() < 1e-6);

    let data_set = DataSet::new(&summary.data_dir, &place.study.protocol.study);
    let path = data_set.ratings_path(&"01".parse().unwrap(), 1, "rating");
    for row in read_ratings(&path, &StimulusPlan::factors()).unwrap().rows {
        let quality = summary.qualities[&row.stimulus_id].on_scale;
        assert_eq!(
            f64::from(row.rating),
            quality.clamp(0.0, 10.0).round_ties_even()
        );
    }
}

#[test]
fn the_description_names_every_column_and_says_that_nobody_took_part() {
    let place = Place::new();
    place.simulate("data", 1, 1).unwrap();
    let text = fs::read(place.data("data/dataset_description.json")).unwrap();
    let description: Value = serde_json::from_slice(&text).unwrap();
    assert_eq!(description["@type"], "Dataset");
    assert!(description["name"].as_str().unwrap().contains("simulated"));
    assert!(
        description["description"]
            .as_str()
            .unwrap()
            .contains("no person took part")
    );
    let variables = description["variableMeasured"].as_array().unwrap();
    let names: Vec<&str> = variables
        .iter()
        .map(|one| one["name"].as_str().unwrap())
        .collect();
    let expected = columns(&StimulusPlan::factors());
    assert!(names.iter().eq(expected.iter().map(|column| &column.name)));
    assert!(variables.iter().all(|one| one["@type"] == "PropertyValue"));
    let sidecar = "data/data/study-meyerliu1992_subject-01_session-1_task-rating_data.json";
    let sidecar: Value = serde_json::from_slice(&fs::read(place.data(sidecar)).unwrap()).unwrap();
    assert_eq!(sidecar["observer"], "simulated");
    assert_eq!(sidecar["protocol_sha256"], place.study.sha256.as_str());
}

#[test]
fn what_is_not_a_simulated_data_set_of_this_study_is_never_replaced() {
    let place = Place::new();
    let refused = |name: &str| {
        let before = files(&place.data(name));
        let error = place.simulate(name, 1, 1).unwrap_err();
        assert!(error.is_input(), "{error}");
        assert_eq!(before, files(&place.data(name)));
        error.to_string()
    };
    fs::create_dir(place.data("thesis")).unwrap();
    fs::write(place.data("thesis/chapter-1.txt"), "It was a dark night.").unwrap();
    assert!(refused("thesis").contains("no such file"));

    place.simulate("people", 1, 1).unwrap();
    let path = place.data("people/dataset_description.json");
    let simulated = fs::read_to_string(&path).unwrap();
    let people = simulated.replace("\"observer\": \"simulated\"", "\"observer\": \"person\"");
    fs::write(&path, &people).unwrap();
    assert!(refused("people").contains("field observer"));
    fs::write(&path, &people[..people.len() / 2]).unwrap();
    assert!(refused("people").contains("EOF"));
    fs::write(
        &path,
        simulated.replace("\"meyer-liu-1992\"", "\"another\""),
    )
    .unwrap();
    assert!(refused("people").contains("field identifier"));
    fs::write(&path, &simulated).unwrap();
    fs::write(place.data("people/notes.txt"), "keep me").unwrap();
    assert!(refused("people").contains("notes.txt"));
}

#[test]
fn anchors_that_look_alike_are_refused() {
    let place = Place::new();
    let manifest_path = place.stimuli.join("manifest.json");
    let manifest = fs::read_to_string(&manifest_path).unwrap();
    let digest = |name: &str| protocols::Sha256Digest::of_file(&place.stimuli.join(name)).unwrap();
    let (zero, ten) = (digest("a010k_c010k.png"), digest("a140k_c140k.png"));
    fs::write(
        &manifest_path,
        manifest.replace(zero.as_str(), ten.as_str()),
    )
    .unwrap();
    fs::copy(
        place.stimuli.join("a140k_c140k.png"),
        place.stimuli.join("a010k_c010k.png"),
    )
    .unwrap();
    let error = place.simulate("data", 1, 1).unwrap_err();
    assert!(
        error.is_input() && error.to_string().contains("stimuli.anchors"),
        "{error}"
    );
    assert!(!place.data("data").exists());
}
