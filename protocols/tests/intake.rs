//! What comes before and between the trials: what a protocol may say of it, and what is refused.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::path::Path;

use protocols::{FieldKind, FormField, Protocol};

/// All of it, as a laboratory might write it.
const INTAKE: &str = r#"
[session.consent]
text = "Sie können jederzeit aufhören."
agree = "Ich willige ein"
decline = "Nein"

[[session.form]]
key = "age"
label = "How old are you?"
kind = "number"
lowest = 18
highest = 99
unit = "years"

[[session.form]]
key = "glasses"
label = "Do you wear glasses?"
kind = "choice"
choices = ["none", "glasses", "contact lenses"]

[[session.form]]
key = "email"
label = "E-mail, for the payment"
kind = "text"
required = false
identifies = true

[session.screening]
seed = 7
grades = [1.0, 0.5]
strokes_px = [4, 2]

[[session.pages]]
text = "So schlecht, so gut."
pictures = ["a010k_c140k", "a140k_c140k"]
captions = ["0", "10"]

[session.breaks]
every = 9
seconds = 30

[session.scale]"#;

fn read(intake: &str) -> Result<Protocol, protocols::InputError> {
    let paper = Path::new(env!("CARGO_MANIFEST_DIR")).join("meyer-liu-1992.toml");
    let text = std::fs::read_to_string(paper).unwrap();
    Protocol::from_toml(
        Path::new("lab.toml"),
        &text.replacen("[session.scale]", intake, 1),
    )
}

#[test]
fn a_protocol_states_consent_form_screening_pages_and_breaks() {
    let session = read(INTAKE).unwrap().session;
    assert_eq!(session.form.len(), 3);
    assert!(session.form[2].identifies && !session.form[0].identifies);
    assert_eq!(session.screening.unwrap().letters_each, 2);
    assert_eq!(session.breaks.unwrap().every, 9);
    assert_eq!(session.pages[0].pictures.len(), 2);
    // sha256sum of the three texts with a line feed between them, none at the end.
    assert_eq!(
        session.consent.unwrap().sha256().as_str(),
        "ab802a71bbcc2ffc1ddf5daebbafa1ff2a34dc2617556a85f1399cb15ddd51b3"
    );
}

#[test]
fn what_is_wrong_before_the_first_trial_is_named() {
    for (good, bad, named) in [
        ("agree = \"Ich", "agreed = \"Ich", "agreed"),
        (
            "agree = \"Ich willige ein\"",
            "agree = \" \"",
            "session.consent",
        ),
        ("key = \"age\"", "key = \"Age\"", "session.form.key"),
        ("key = \"age\"", "key = \"subject_id\"", "session.form.key"),
        ("key = \"age\"", "key = \"rating\"", "session.form.key"),
        ("key = \"age\"", "key = \"channel\"", "session.form.key"),
        ("key = \"age\"", "key = \"grade\"", "session.form.key"),
        ("key = \"age\"", "key = \"sitting\"", "session.form.key"),
        ("key = \"age\"", "key = \"glasses\"", "twice"),
        ("kind = \"number\"", "kind = \"numeral\"", "numeral"),
        ("lowest = 18", "lowest = 180", "session.form.lowest"),
        (
            "[\"none\", \"glasses\", \"contact lenses\"]",
            "[\"none\"]",
            "session.form.choices",
        ),
        (
            "kind = \"text\"",
            "kind = \"text\"\nunit = \"m\"",
            "only with kind",
        ),
        (
            "grades = [1.0, 0.5]",
            "grades = [1.5]",
            "session.screening.grades",
        ),
        (
            "strokes_px = [4, 2]",
            "strokes_px = [0]",
            "session.screening.strokes_px",
        ),
        ("\"a140k_c140k\"]", "\"a141k_c140k\"]", "a141k_c140k"),
        (
            "captions = [\"0\", \"10\"]",
            "captions = [\"0\"]",
            "session.pages.captions",
        ),
        ("every = 9", "every = 0", "session.breaks.every"),
        ("seconds = 30", "seconds = 0", "session.breaks.seconds"),
    ] {
        assert!(INTAKE.contains(good), "{good}");
        let error = read(&INTAKE.replacen(good, bad, 1))
            .unwrap_err()
            .to_string();
        assert!(
            error.contains(named) && error.contains("lab.toml"),
            "{bad}: {error}"
        );
    }
}

#[test]
fn an_answer_that_cannot_stand_is_not_taken() {
    let session = read(INTAKE).unwrap().session;
    let takes = |index: usize, answer: &str| session.form[index].takes(answer);
    assert!(takes(0, " 18 ") && takes(0, "99") && takes(0, "45.5"));
    for bad in ["17", "100", "", "old", "nan", "inf", "1e9"] {
        assert!(!takes(0, bad), "{bad}");
    }
    assert!(takes(1, "contact lenses") && !takes(1, "monocle") && !takes(1, ""));
    assert!(takes(2, "") && takes(2, "ä@b.c"));
    let long = "x".repeat(1001);
    assert!(!takes(2, &long));
    let field = FormField {
        kind: FieldKind::Number,
        lowest: None,
        highest: None,
        ..session.form[0].clone()
    };
    assert!(field.takes("-3") && !field.takes("infinity"));
}
