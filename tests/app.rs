//! The app from outside: where there is no display, and in a real window.

mod acuity;

use acuity::{PROTOCOL, acuity, stderr, text_of};

#[test]
fn without_a_display_acuity_alone_says_so_and_prints_the_commands() {
    let folder = tempfile::tempdir().unwrap();
    let output = acuity(folder.path(), &[]);
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(said.contains("found no DISPLAY") && said.contains("Usage: acuity"));
    assert!(
        ["render", "run", "report", "app"]
            .iter()
            .all(|name| said.contains(name))
    );
    assert_eq!(text_of(&output.stdout), "");
}

#[test]
fn without_a_display_the_app_of_a_protocol_fails_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let output = acuity(folder.path(), &["app", PROTOCOL]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(
        said.contains("no window could be opened") && said.contains("--help"),
        "{said}"
    );
}
