//! The command line from outside: exit codes, one clear error, nothing half-written.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod acuity;

use std::fs;

use acuity::{PROTOCOL, acuity, stderr, text_of};

#[test]
fn a_wrong_command_ends_with_exit_code_2_and_says_what_was_expected() {
    let folder = tempfile::tempdir().unwrap();
    let cases: [(&[&str], &str); 9] = [
        (&["paint"], "paint"),
        (&["render"], "PROTOCOL"),
        (&["run", PROTOCOL, "--subject", "Jane Doe"], "letters"),
        (&["run", PROTOCOL, "--subject", "../01"], "letters"),
        (
            &["run", PROTOCOL, "--subject", "01", "--pilot", "0"],
            "from 1 to 1000",
        ),
        (
            &["simulate", PROTOCOL, "--subjects", "0", "--seed", "1"],
            "0",
        ),
        (
            &[
                "image",
                "scene.toml",
                "--rays-a",
                "many",
                "--rays-c1c2",
                "1K",
                "-o",
                "x.exr",
            ],
            "many",
        ),
        (
            &[
                "image",
                "scene.toml",
                "--rays-a",
                "1K",
                "--rays-c1c2",
                "1K",
                "--size",
                "0x1",
                "-o",
                "x.exr",
            ],
            "0x1",
        ),
        (
            &[
                "image",
                "scene.toml",
                "--rays-a",
                "1K",
                "--rays-c1c2",
                "1K",
                "-o",
                "x.exr",
            ],
            "scene.toml",
        ),
    ];
    for (arguments, named) in cases {
        let output = acuity(folder.path(), arguments);
        assert_eq!(
            output.status.code(),
            Some(2),
            "{arguments:?}: {}",
            stderr(&output)
        );
        assert!(
            stderr(&output).contains(named),
            "{arguments:?}: {}",
            stderr(&output)
        );
    }
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        0,
        "something was written"
    );
}

#[test]
fn every_command_refuses_a_protocol_that_is_none_and_names_the_file() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("bad.toml"),
        "study = \"x\"\nexposure_sec = 10.0\n",
    )
    .unwrap();
    for file in ["missing.toml", "bad.toml"] {
        let cases: [&[&str]; 7] = [
            &["check", file],
            &["render", file],
            &["figures", file, "-o", "figures"],
            &["run", file, "--subject", "01"],
            &["simulate", file, "--subjects", "2", "--seed", "1"],
            &["report", file],
            &["replicate", "--protocol", file],
        ];
        for arguments in cases {
            let output = acuity(folder.path(), arguments);
            assert_eq!(
                output.status.code(),
                Some(2),
                "{arguments:?}: {}",
                stderr(&output)
            );
            assert!(
                stderr(&output).contains(file),
                "{arguments:?}: {}",
                stderr(&output)
            );
        }
    }
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        1,
        "something was written"
    );
}

#[test]
fn a_table_that_cannot_be_analysed_is_refused_and_named() {
    let folder = tempfile::tempdir().unwrap();
    let cases = [
        ("missing column", "subject,rating\ns1,1\ns2,2\n", "channel"),
        (
            "no number",
            "subject,channel,rating\ns1,a,1\ns1,b,two\n",
            "two",
        ),
        (
            "one subject",
            "subject,channel,rating\ns1,a,1\ns1,b,2\n",
            "subject",
        ),
        (
            "one level",
            "subject,channel,rating\ns1,a,1\ns2,a,2\n",
            "level",
        ),
        ("empty", "", "table.csv"),
    ];
    for (name, table, named) in cases {
        fs::write(folder.path().join("table.csv"), table).unwrap();
        let arguments = [
            "anova",
            "table.csv",
            "--subject",
            "subject",
            "--rating",
            "rating",
            "--within",
            "channel",
        ];
        let output = acuity(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2), "{name}: {}", stderr(&output));
        assert!(
            stderr(&output).contains(named),
            "{name}: {}",
            stderr(&output)
        );
        assert_eq!(text_of(&output.stdout), "", "{name}");
    }
}

#[test]
fn a_session_does_not_start_without_the_stimulus_set() {
    let folder = tempfile::tempdir().unwrap();
    for command in [
        &["run", PROTOCOL, "--subject", "01"][..],
        &["simulate", PROTOCOL, "--subjects", "2", "--seed", "1"],
    ] {
        let output = acuity(folder.path(), command);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(
            stderr(&output).contains("acuity render"),
            "{}",
            stderr(&output)
        );
    }
    let checked = acuity(folder.path(), &["check", PROTOCOL]);
    assert_eq!(checked.status.code(), Some(2), "{}", stderr(&checked));
    assert!(text_of(&checked.stdout).contains("manifest.json"));
}
