//! The list beside sessions that were really sat.

use super::*;
use crate::close_session;
use crate::sitting::tests::Place;

fn list(place: &Place) -> SessionList {
    session_list(&place.study, &place.options.data_dir).unwrap()
}

/// The subjects with their pilot mark and their standing.
fn standings(list: &SessionList) -> Vec<(String, bool, usize, Standing)> {
    let line = |session: &ListedSession| {
        let subject = session.subject.to_string();
        let is_pilot = session.pilot.is_some();
        (subject, is_pilot, session.rated, session.standing.clone())
    };
    list.sessions.iter().map(line).collect()
}

#[test]
fn a_study_that_nobody_sat_has_an_empty_list() {
    let list = list(&Place::new());
    assert!(list.sessions.is_empty() && list.faults.is_empty());
}

/// 3 practice trials and 27 images: 30 trials (the paper's study).
#[test]
fn complete_unfinished_closed_and_pilot_sessions_are_told_apart() {
    let mut place = Place::new();
    for (subject, pilot, rated) in [
        ("10", None, 30),
        ("02", None, 12),
        ("03", None, 4),
        ("try", Some(20.0), 5),
    ] {
        place.options.subject = subject.parse().unwrap();
        place.options.pilot = pilot;
        place.rate(rated);
    }
    place.options.subject = "03".parse().unwrap();
    place.options.pilot = None;
    close_session(&place.study, &place.options, "felt unwell").unwrap();
    let list = list(&place);
    assert!(list.faults.is_empty());
    let found = standings(&list);
    let order = ["02", "03", "10", "try"];
    assert!(found.iter().map(|line| line.0.as_str()).eq(order));
    assert_eq!(found[0], ("02".into(), false, 12, Standing::Unfinished));
    assert!(
        matches!(&found[1], (_, false, 4, Standing::Closed { reason, .. }) if reason == "felt unwell")
    );
    assert_eq!(found[2], ("10".into(), false, 30, Standing::Complete));
    assert_eq!(found[3], ("try".into(), true, 5, Standing::Unfinished));
    for session in &list.sessions {
        assert!(session.is_of_this_protocol && session.trials == 30);
        assert!(session.started_at.is_some());
    }
}

#[test]
fn a_session_of_an_older_protocol_is_marked() {
    let mut place = Place::new();
    place.rate(1);
    let text = fs::read_to_string(&place.study.path).unwrap();
    fs::write(&place.study.path, text + "\n# changed\n").unwrap();
    place.study = Study::read(&place.study.path).unwrap();
    assert!(!list(&place).sessions[0].is_of_this_protocol);
}

#[test]
fn what_cannot_be_read_is_named_and_hides_nobody() {
    let mut place = Place::new();
    for subject in ["01", "02", "03", "04"] {
        place.options.subject = subject.parse().unwrap();
        place.rate(2);
    }
    let path = |subject: &str, ending: &str| {
        let name =
            format!("study-meyerliu1992_subject-{subject}_session-1_task-rating_data.{ending}");
        place.options.data_dir.join("data").join(name)
    };
    // Contradictory, truncated, missing, and a stranger's name.
    let text = fs::read_to_string(path("01", "csv")).unwrap();
    fs::write(path("01", "csv"), text.replacen(",7,", ",seven,", 1)).unwrap();
    let sidecar = fs::read_to_string(path("02", "json")).unwrap();
    fs::write(path("02", "json"), &sidecar[..sidecar.len() / 2]).unwrap();
    fs::remove_file(path("03", "json")).unwrap();
    fs::write(place.options.data_dir.join("data/of-another_data.csv"), "").unwrap();
    let list = list(&place);
    assert_eq!(list.sessions.len(), 1);
    assert_eq!(list.sessions[0].subject.as_str(), "04");
    let faults: Vec<String> = list.faults.iter().map(ToString::to_string).collect();
    assert_eq!(faults.len(), 4, "{faults:?}");
    for named in ["of-another", "subject-01", "subject-02", "subject-03"] {
        assert!(faults.iter().any(|fault| fault.contains(named)), "{named}");
    }
}

#[test]
fn a_torn_line_was_never_a_rating() {
    let place = Place::new();
    place.rate(3);
    let path = place.ratings_path();
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text + "S1,1,4,tes").unwrap();
    assert_eq!(list(&place).sessions[0].rated, 3);
}
