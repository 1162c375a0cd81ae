//! Disks and folders that fail in the middle of a session: a full disk, a folder that takes no more files, a second
//! program.

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::os::unix::fs::PermissionsExt as _;
use std::process::{Child, Command, Stdio};

use super::crash::{WAITS_AT, check_rows, last, victim};
use super::tests::Place;
use super::*;

/// Past the test harness, which hides what a passing test prints.
fn skip(reason: &str) {
    let line = format!("SKIPPED: {reason}\n");
    std::io::stderr().write_all(line.as_bytes()).unwrap();
}

/// Sits the session to its end on a disk that has room.
fn go_on_to_the_end(place: &Place) {
    let mut again = victim(place, &[]);
    let said = all_said(&mut again);
    assert!(again.wait().unwrap().success(), "{said}");
    assert_eq!(check_rows(place), 30);
}

fn all_said(child: &mut Child) -> String {
    let mut said = String::new();
    let mut out = child.stdout.take().unwrap();
    out.read_to_string(&mut said).unwrap();
    said
}

/// What was accepted is on disk, and at most the one rating more whose writing failed.
fn check_kept(place: &Place, said: &str) {
    let accepted = last(said, "accepted").unwrap();
    assert!((1..30).contains(&accepted), "{said}");
    let on_disk = check_rows(place);
    assert!(
        (accepted..=accepted + 1).contains(&on_disk),
        "{accepted} accepted, {on_disk} on disk"
    );
}

/// A disk of 28 KiB of its own, in a name space that goes with the victim; what is on it is copied away at the end.
const SMALL_DISK: &str =
    "mkdir -p \"$0\" && mount -t tmpfs -o size=28k,mode=700 tmpfs \"$0\" || exit 77
    \"$@\"; code=$?; cp -Rp \"$0\" \"$0-left\"; exit $code";

#[test]
fn on_a_disk_that_is_full_the_session_stops_and_what_was_accepted_is_kept() {
    let place = Place::new();
    let data = place.options.data_dir.to_string_lossy().into_owned();
    let namespace = ["unshare", "--mount", "--map-root-user"];
    let may_mount = Command::new(namespace[0])
        .args(&namespace[1..])
        .args(["mount", "-t", "tmpfs", "tmpfs", "/mnt"])
        .stderr(Stdio::null())
        .status();
    if !may_mount.is_ok_and(|status| status.success()) {
        return skip("the test of a full disk needs `unshare` and leave to mount");
    }
    let wrapper = [&namespace[..], &["sh", "-c", SMALL_DISK, &data]].concat();
    let mut child = victim(&place, &wrapper);
    let said = all_said(&mut child);
    let status = child.wait().unwrap();
    assert!(!status.success() && status.code() != Some(77), "{said}");
    assert!(said.contains("No space left on device"), "{said}");
    fs::rename(format!("{data}-left"), &data).unwrap();
    check_kept(&place, &said);
    go_on_to_the_end(&place);
}

#[test]
fn in_a_folder_that_became_read_only_the_session_stops_and_what_was_accepted_is_kept() {
    let place = Place::new();
    drop(place.open().unwrap());
    let folder = place.options.data_dir.join("data");
    let set_mode = |mode: u32| fs::set_permissions(&folder, fs::Permissions::from_mode(mode));
    set_mode(0o500).unwrap();
    let is_superuser = tempfile::tempfile_in(&folder).is_ok();
    set_mode(0o700).unwrap();
    // The superuser may write everywhere, unless that is taken away.
    let mortal = ["setpriv", "--bounding-set=-dac_override"];
    let waits = format!("{WAITS_AT}=8");
    let mut wrapper = vec!["env", &waits];
    if is_superuser {
        let is_there = Command::new(mortal[0])
            .args(&mortal[1..])
            .arg("true")
            .status();
        if !is_there.is_ok_and(|status| status.success()) {
            return skip("the test of a read-only folder needs `setpriv`, run by the superuser");
        }
        wrapper.extend(mortal);
    }
    let mut child = victim(&place, &wrapper);
    let mut out = BufReader::new(child.stdout.take().unwrap());
    let mut said = String::new();
    while !said.contains("accepted 8") && out.read_line(&mut said).unwrap() > 0 {}
    set_mode(0o500).unwrap();
    child.stdin.take().unwrap().write_all(b"\n").unwrap();
    out.read_to_string(&mut said).unwrap();
    assert!(!child.wait().unwrap().success(), "{said}");
    set_mode(0o700).unwrap();
    let failure = said.lines().find(|line| line.starts_with("failed"));
    let failure = failure.unwrap_or_default();
    assert!(
        failure.contains("data/data") && failure.contains("Permission denied"),
        "{said}"
    );
    assert_eq!(last(&said, "accepted"), Some(8), "{said}");
    check_kept(&place, &said);
    go_on_to_the_end(&place);
}

#[test]
fn a_second_program_is_refused_and_told_which_one_holds_the_lock() {
    let place = Place::new();
    let waits = format!("{WAITS_AT}=3");
    let mut first = victim(&place, &["env", &waits]);
    let mut out = BufReader::new(first.stdout.take().unwrap());
    let mut said = String::new();
    while !said.contains("accepted 3") && out.read_line(&mut said).unwrap() > 0 {}
    let error = place.open().unwrap_err();
    let ExperimentError::Busy { holder, .. } = &error else {
        panic!("{error}");
    };
    // Some file systems name their devices otherwise; then nobody is named.
    assert!(holder.is_none_or(|id| id == first.id()), "{error}");
    let text = error.to_string();
    assert!(
        text.contains("S1") && text.contains("a crash leaves none"),
        "{text}"
    );
    first.kill().unwrap();
    first.wait().unwrap();
    assert_eq!(place.open().unwrap().session.rated(), 3);
}
