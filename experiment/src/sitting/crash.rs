//! A session that is killed, starved or robbed: whatever the subject saw accepted is on disk once, in order.
//!
//! The victim is this test program itself, started again on the one test that sits a session; so it is a real
//! process with real files, and SIGKILL is real.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::Duration;

use super::tests::Place;
use super::*;
use crate::random::Random;
use crate::{Key, Screen};
use protocols::StimulusPlan;
use protocols::rating::read_ratings;

/// Names the folder of the study to the victim.
const FOLDER: &str = "ACUITY_TEST_VICTIM_IN";
/// After so many trials the victim waits for a line on its standard input.
pub(super) const WAITS_AT: &str = "ACUITY_TEST_VICTIM_WAITS_AT";
/// How many times the victim is killed, unless the variable of that name says otherwise.
const KILLS: usize = 60;

/// Not a test of its own: what the victim runs. It says on standard output when a rating was accepted.
#[test]
fn a_victim_sits_the_session() {
    let Some(folder) = std::env::var_os(FOLDER) else {
        return;
    };
    let place = Place::at(Path::new(&folder));
    let mut sitting = place.open().unwrap();
    let mut out = std::io::stdout();
    writeln!(out, "\nopened {}", sitting.session.rated()).unwrap();
    for frame in 0..1_000_000 {
        let at_s = f64::from(frame) / 60.0;
        sitting.session.on(Event::Frame, at_s);
        match sitting.session.screen() {
            Screen::Rating => {
                let number = sitting.session.rated() % 11;
                for digit in number.to_string().chars() {
                    sitting.session.on(Event::Key(Key::Character(digit)), at_s);
                }
                sitting.session.on(Event::Key(Key::Enter), at_s);
                let is_answered = sitting.session.to_save().is_some();
                if let Err(error) = sitting.save(|| at_s) {
                    let cause = std::error::Error::source(&error).map(ToString::to_string);
                    writeln!(out, "\nfailed {error}: {}", cause.unwrap_or_default()).unwrap();
                    panic!("{error}");
                }
                if is_answered {
                    let rated = sitting.session.rated().to_string();
                    writeln!(out, "\naccepted {rated}").unwrap();
                    if std::env::var(WAITS_AT).is_ok_and(|wanted| wanted == rated) {
                        std::io::stdin().read_line(&mut String::new()).unwrap();
                    }
                }
            }
            Screen::Instructions | Screen::Resumed | Screen::PracticeOver => {
                sitting.session.on(Event::Key(Key::Enter), at_s);
            }
            Screen::Thanks => {
                sitting.finish(Ending::Complete, 0, at_s).unwrap();
                return;
            }
            _ => {}
        }
    }
}

pub(super) fn victim(place: &Place, wrapper: &[&str]) -> Child {
    let program = std::env::current_exe().unwrap();
    let mut words = wrapper
        .iter()
        .map(std::ffi::OsString::from)
        .collect::<Vec<_>>();
    words.push(program.into());
    Command::new(&words[0])
        .args(&words[1..])
        .args([
            "--exact",
            "sitting::crash::a_victim_sits_the_session",
            "--nocapture",
        ])
        .env(FOLDER, place.folder())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// The last number after a word that the victim said.
pub(super) fn last(said: &str, word: &str) -> Option<usize> {
    let mut lines = said.lines().rev();
    lines.find_map(|line| line.strip_prefix(word)?.trim().parse().ok())
}

/// Every row, checked to be the beginning of the session with the ratings that the victim gave.
pub(super) fn check_rows(place: &Place) -> usize {
    let path = place.ratings_path();
    if !path.exists() {
        return 0;
    }
    let rows = read_ratings(&path, &StimulusPlan::factors()).unwrap().rows;
    let order = trials(&place.study, &place.options.subject, 1).unwrap();
    for (index, (row, trial)) in rows.iter().zip(&order).enumerate() {
        assert_eq!(row.stimulus_id, trial.stimulus_id);
        assert_eq!(row.trial_id as usize, index + 1, "once, and in order");
        assert_eq!(usize::try_from(row.rating), Ok(index % 11));
    }
    rows.len()
}

#[test]
fn a_session_killed_at_random_moments_keeps_every_rating_that_was_accepted() {
    let kills = std::env::var("ACUITY_KILLS")
        .ok()
        .and_then(|text| text.parse().ok());
    let kills = kills.unwrap_or(KILLS);
    let place = Place::new();
    let mut random = Random::keyed_by("moments of death");
    let (mut killed, mut inside, mut sessions) = (0, 0, 0);
    while killed < kills {
        let before = check_rows(&place);
        let mut child = victim(&place, &[]);
        let mut out = BufReader::new(child.stdout.take().unwrap());
        let mut said = String::new();
        // From before the files are opened to beyond the end of most sessions.
        let is_at_once = random.index(8) == 0;
        while !is_at_once && !said.contains("opened") && out.read_line(&mut said).unwrap() > 0 {}
        std::thread::sleep(Duration::from_micros(random.index(60_000) as u64));
        child.kill().unwrap();
        let status: ExitStatus = child.wait().unwrap();
        out.read_to_string(&mut said).unwrap();
        let accepted = last(&said, "accepted")
            .or(last(&said, "opened"))
            .unwrap_or(before);
        let on_disk = check_rows(&place);
        assert!(
            (accepted..=accepted + 1).contains(&on_disk),
            "{accepted} accepted, {on_disk} on disk"
        );
        killed += usize::from(!status.success());
        inside += usize::from((1..30).contains(&on_disk));
        if on_disk == 30 {
            sessions += 1;
            std::fs::remove_dir_all(&place.options.data_dir).unwrap();
        }
    }
    assert!(
        inside * 4 > kills,
        "only {inside} of {kills} deaths in the middle of a session"
    );
    assert!(
        sessions > 0 || kills < KILLS,
        "no session was ever completed"
    );
}

/// No file may grow beyond 4 KiB (`ulimit -f` of `sh` counts blocks of 512 bytes); the ratings grow beyond 5.
#[test]
fn when_the_disk_is_full_the_session_stops_and_what_was_accepted_is_kept() {
    let place = Place::new();
    // The description of the data set is longer than that, and stands before the disk is full.
    drop(place.open().unwrap());
    let limited = "trap '' XFSZ; ulimit -f 8; exec \"$@\"";
    let mut child = victim(&place, &["sh", "-c", limited, "sh"]);
    let mut said = String::new();
    child
        .stdout
        .take()
        .unwrap()
        .read_to_string(&mut said)
        .unwrap();
    assert!(!child.wait().unwrap().success(), "{said}");
    let accepted = last(&said, "accepted").unwrap();
    assert!((1..30).contains(&accepted), "{said}");
    let on_disk = check_rows(&place);
    assert!(
        (accepted..=accepted + 1).contains(&on_disk),
        "{accepted} accepted, {on_disk} on disk"
    );
    let mut again = victim(&place, &[]);
    let mut said = String::new();
    again
        .stdout
        .take()
        .unwrap()
        .read_to_string(&mut said)
        .unwrap();
    assert!(again.wait().unwrap().success(), "{said}");
    assert_eq!(check_rows(&place), 30);
}

#[test]
fn a_folder_that_takes_no_files_is_an_error_before_the_first_trial() {
    let mut place = Place::new();
    // /proc takes no folders, from whomever: a mode of 0500 would not stop the superuser.
    place.options.data_dir = "/proc/acuity".into();
    let error = place.open().unwrap_err();
    assert!(matches!(error, ExperimentError::Io { .. }), "{error}");
    assert!(error.to_string().contains("/proc/acuity"), "{error}");
}

#[test]
fn a_data_folder_that_is_removed_stops_the_session_and_every_rating_is_written_again() {
    let place = Place::new();
    place.rate(4);
    let mut sitting = place.open().unwrap();
    std::fs::remove_dir_all(&place.options.data_dir).unwrap();
    let error = rate_once(&mut sitting).unwrap_err();
    let text = error.to_string();
    assert!(
        matches!(error, ExperimentError::Removed { ratings: 5, .. }),
        "{text}"
    );
    drop(sitting);
    assert_eq!(place.rows().len(), 5);
    place.rate(25);
    assert_eq!(place.rows().len(), 30);
}

#[test]
fn a_file_put_in_the_place_of_the_ratings_is_not_overwritten() {
    let place = Place::new();
    place.rate(4);
    let mut sitting = place.open().unwrap();
    let path = place.ratings_path();
    std::fs::remove_file(&path).unwrap();
    std::fs::write(&path, "another file").unwrap();
    let error = rate_once(&mut sitting).unwrap_err();
    let ExperimentError::Removed { kept, .. } = error else {
        panic!("{error}");
    };
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "another file");
    let rows = read_ratings(&kept, &StimulusPlan::factors()).unwrap().rows;
    assert_eq!(rows.len(), 5);
}

fn rate_once(sitting: &mut Sitting) -> Result<(), ExperimentError> {
    for frame in 0..10_000 {
        let at_s = f64::from(frame) / 60.0;
        sitting.session.on(Event::Frame, at_s);
        if sitting.session.screen() == Screen::Rating {
            sitting.session.on(Event::Key(Key::Character('7')), at_s);
            sitting.session.on(Event::Key(Key::Enter), at_s);
            if sitting.session.to_save().is_some() {
                return sitting.save(|| at_s);
            }
        } else if sitting.session.screen() != Screen::Blank {
            sitting.session.on(Event::Key(Key::Enter), at_s);
        }
    }
    panic!("no scale");
}
