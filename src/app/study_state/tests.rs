//! States beside files that were really made, missing, changed and damaged.

use std::fs;

use proptest::prelude::*;

use super::*;
use crate::app::fixture::Fixture;

#[test]
fn a_new_study_has_everything_left_to_do() {
    let fixture = Fixture::new();
    let state = fixture.state();
    assert_eq!(state.stimuli, StimuliState::NotMade);
    assert_eq!(
        state.station,
        StationState::NotMeasured { is_needed: false }
    );
    assert_eq!(state.report, ReportState::NoRatings);
    assert_eq!(state.first_due(), Step::Stimuli);
    assert!(state.hindrance().is_some());
    let marks = Step::ALL.map(|step| state.of(step).0);
    assert_eq!(marks, [Mark::Due, Mark::Due, Mark::Due, Mark::Later]);
}

#[test]
fn stimuli_are_ready_until_a_file_the_protocol_or_the_scene_changes() {
    let fixture = Fixture::new();
    fixture.make_stimuli();
    // 14 + 14 counts, 140K/140K shared, and 10K/10K for the zero anchor (section 3.4 of the paper): 28.
    assert_eq!(fixture.state().stimuli, StimuliState::Ready { images: 28 });
    assert_eq!(fixture.state().hindrance(), None);

    let image = fixture.state().folders.stimuli.join("a010k_c140k.png");
    let bytes = fs::read(&image).unwrap();
    fs::write(&image, &bytes[..bytes.len() - 9]).unwrap();
    let StimuliState::Damaged(faults) = fixture.state().stimuli else {
        panic!("a cut image is not seen");
    };
    assert_eq!(faults.len(), 1);
    fs::remove_file(&image).unwrap();
    assert!(matches!(fixture.state().stimuli, StimuliState::Damaged(_)));
    fs::write(&image, &bytes).unwrap();

    fixture.replace_in_protocol("seed = 1992", "seed = 1993");
    assert!(matches!(fixture.state().stimuli, StimuliState::Older(_)));
    fixture.replace_in_protocol("seed = 1993", "seed = 1992");
    assert_eq!(fixture.state().stimuli, StimuliState::Ready { images: 28 });

    let scene = fixture.state().study.scene_path().unwrap();
    let text = fs::read_to_string(&scene).unwrap();
    fs::write(&scene, format!("{text}\n# changed\n")).unwrap();
    assert!(matches!(fixture.state().stimuli, StimuliState::Older(_)));
}

#[test]
fn a_manifest_that_is_no_manifest_is_named() {
    let fixture = Fixture::new();
    let folder = fixture.state().folders.stimuli;
    fs::create_dir_all(&folder).unwrap();
    for text in ["", "{", "{\"set\": 7}"] {
        fs::write(folder.join("manifest.json"), text).unwrap();
        let StimuliState::Older(fault) = fixture.state().stimuli else {
            panic!("{text:?} is taken for a manifest");
        };
        assert!(fault.rows()[0].1.contains("manifest.json"));
    }
}

#[test]
fn a_station_is_measured_unfit_or_missing() {
    let fixture = Fixture::new();
    let path = fixture.place.station.clone().unwrap();
    let station = StationFile {
        monitor: None,
        width_mm: 527.04,
        width_px: 1920,
        distance_cm: 60.0,
        color: experiment::DisplayColor::Srgb,
        peak_luminance_cd_m2: None,
        surround: None,
        background_cd_m2: None,
        room_lux: None,
        experimenter_monitor: None,
        not_native_because: None,
        refresh: None,
        screens: std::collections::BTreeMap::new(),
    };
    station.write(&path).unwrap();
    assert!(matches!(fixture.state().station, StationState::Measured(_)));
    // 60 cm is too near for 0.019 degrees, which this screen has at 82.8 cm (see experiment/src/station.rs).
    fixture.replace_in_protocol("[session]", "[session]\nviewing_tolerance = 0.02");
    let state = fixture.state();
    assert!(matches!(state.station, StationState::Unfit(_)));
    fs::write(&path, "width_mm = ").unwrap();
    assert!(matches!(fixture.state().station, StationState::Unfit(_)));
    fs::remove_file(&path).unwrap();
    let needed = StationState::NotMeasured { is_needed: true };
    assert_eq!(fixture.state().station, needed);
}

#[test]
fn sessions_and_the_report_follow_the_ratings() {
    let fixture = Fixture::new();
    fixture.make_stimuli();
    let subjects = fixture.simulate_people(3);
    let state = fixture.state();
    let counts = |done, unfinished| Counts {
        done,
        unfinished,
        excluded: 0,
    };
    assert_eq!(state.sessions.counts(), counts(3, 0));
    assert_eq!(state.report, ReportState::Aged(ReportAge::NotMade));
    fixture.make_report();
    let state = fixture.state();
    assert_eq!(state.report, ReportState::Aged(ReportAge::Current));
    assert_eq!(state.of(Step::Report), (Mark::Done, "Ready".to_owned()));

    Fixture::cut_to(&subjects[2], 12);
    let state = fixture.state();
    assert_eq!(state.sessions.counts(), counts(2, 1));
    assert_eq!(state.of(Step::Sessions).1, "2 of 3 subjects done");
    assert_eq!(state.report, ReportState::Aged(ReportAge::OlderThanData));

    let ratings = state.sessions.sessions[0].ratings_path.clone();
    fs::write(ratings, "not,a,table\n1,2,3\n").unwrap();
    let state = fixture.state();
    assert_eq!(state.of(Step::Sessions).0, Mark::Wrong);
    assert!(matches!(state.report, ReportState::Wrong(_)));
}

#[test]
fn a_protocol_that_is_none_is_a_fault() {
    let fixture = Fixture::new();
    let read = || StudyState::read(&fixture.protocol, &fixture.place);
    fixture.replace_in_protocol("exposure_s", "exposure_sec");
    assert!(read().unwrap_err().line().contains("exposure_sec"));
    fs::write(&fixture.protocol, [0xff, 0xfe]).unwrap();
    assert!(read().is_err());
    fs::remove_file(&fixture.protocol).unwrap();
    assert!(read().unwrap_err().line().contains("no such file"));
}

#[test]
fn a_subject_is_done_excluded_or_unfinished_by_its_sessions() {
    let closed = Standing::Closed {
        at: String::new(),
        reason: String::new(),
    };
    let (complete, unfinished) = (Standing::Complete, Standing::Unfinished);
    for (standings, expected) in [
        (vec![&complete], Progress::Done),
        (vec![&closed], Progress::Excluded),
        (vec![&unfinished], Progress::Unfinished),
        (vec![&closed, &complete], Progress::Done),
        (vec![&complete, &unfinished], Progress::Unfinished),
    ] {
        assert_eq!(progress(standings.into_iter()), expected);
    }
}

#[test]
fn codes_go_on_in_their_manner() {
    for (codes, next) in [
        (vec![], "01"),
        (vec!["01", "02"], "03"),
        (vec!["09"], "10"),
        (vec!["99"], "100"),
        (vec!["A007", "A002"], "A008"),
        (vec!["S1"], "S2"),
        (vec!["anna"], "01"),
        (vec!["01", "03"], "04"),
    ] {
        assert_eq!(next_code(&codes), next, "{codes:?}");
    }
}

proptest! {
    /// Whatever codes there are, the next one is a code, and free.
    #[test]
    fn the_next_code_is_a_code_and_free(codes in prop::collection::vec("[A-Za-z0-9]{1,32}", 0..20)) {
        let taken: Vec<&str> = codes.iter().map(String::as_str).collect();
        let next = next_code(&taken);
        prop_assert!(next.parse::<protocols::SubjectId>().is_ok(), "{next}");
        let is_full = codes.iter().any(|code| code.len() == 32);
        prop_assert!(is_full || !codes.contains(&next), "{next}");
    }
}
