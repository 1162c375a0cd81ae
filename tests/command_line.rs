//! The command line from outside: exit codes, one clear error, nothing half-written.

mod acuity;

use std::fs;
use std::path::Path;
use std::process::Output;

use acuity::{PROTOCOL, acuity, stderr, text_of};

/// Commands (P is the paper's protocol) that are wrong, and what the message must name.
const WRONG_COMMANDS: [(&str, &str); 15] = [
    ("paint", "paint"),
    ("render", "PROTOCOL"),
    ("run P --subject Jane_Doe", "letters"),
    ("run P --subject ../01", "letters"),
    ("run P --subject 01 --pilot 0", "from 1 to 1000"),
    (
        "station P --width-mm 400 --width-px 1280 --primaries .64,.33,.3",
        "eight numbers with commas",
    ),
    ("simulate P --subjects 0 --seed 1", "0"),
    ("image s.toml --rays-a many --rays-c1c2 1K -o x.exr", "many"),
    (
        "image s.toml --rays-a 1K --rays-c1c2 1K --size 0x1 -o x.exr",
        "0x1",
    ),
    ("image s.toml --rays-a 1K --rays-c1c2 1K -o x.exr", "s.toml"),
    ("image s.toml --rays-a 4294967296 -o x.exr", "4294967295"),
    (
        "image s.toml --rays-a 4294967295 -o x.exr",
        "at most 1073741824 rays",
    ),
    ("image s.toml --rays-a 100 -o x.exr", "256 cells"),
    (
        "image s.toml --rays-a 1K --compare y.png -o x.exr",
        "--acuity",
    ),
    ("image s.toml --rays-a 1K --acuity P -o x.exr", "[acuity]"),
];

#[test]
fn a_wrong_command_ends_with_exit_code_2_and_says_what_was_expected() {
    let folder = tempfile::tempdir().unwrap();
    for (command, named) in WRONG_COMMANDS {
        let words = command.split(' ');
        let words = words.map(|word| if word == "P" { PROTOCOL } else { word });
        refused(folder.path(), &words.collect::<Vec<_>>(), named);
    }
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        0,
        "something was written"
    );
}

/// Runs a command that must end with exit code 2 and name `named` on stderr.
fn refused(folder: &Path, arguments: &[&str], named: &str) -> Output {
    let output = acuity(folder, arguments);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(message.contains(named), "{arguments:?}: {message}");
    output
}

#[test]
fn every_command_refuses_a_protocol_that_is_none_and_names_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let text = "study = \"x\"\nexposure_sec = 10.0\n";
    fs::write(folder.path().join("bad.toml"), text).unwrap();
    for file in ["missing.toml", "bad.toml"] {
        let commands: [&[&str]; 7] = [
            &["check", file],
            &["render", file],
            &["figures", file, "-o", "figures"],
            &["run", file, "--subject", "01"],
            &["simulate", file, "--subjects", "2", "--seed", "1"],
            &["report", file],
            &["replicate", "--protocol", file],
        ];
        for arguments in commands {
            refused(folder.path(), arguments, file);
        }
    }
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        1,
        "something was written"
    );
}

/// Tables that cannot be analysed, and what the message must name.
const BAD_TABLES: [(&str, &str); 5] = [
    ("subject,rating\ns1,1\ns2,2\n", "channel"),
    ("subject,channel,rating\ns1,a,1\ns1,b,two\n", "two"),
    ("subject,channel,rating\ns1,a,1\ns1,b,2\n", "subject"),
    ("subject,channel,rating\ns1,a,1\ns2,a,2\n", "level"),
    ("", "table.csv"),
];

#[test]
fn a_table_that_cannot_be_analysed_is_refused_and_named() {
    let folder = tempfile::tempdir().unwrap();
    let command = "anova table.csv --subject subject --rating rating --within channel";
    for (table, named) in BAD_TABLES {
        fs::write(folder.path().join("table.csv"), table).unwrap();
        let output = refused(
            folder.path(),
            &command.split(' ').collect::<Vec<_>>(),
            named,
        );
        assert_eq!(text_of(&output.stdout), "", "{table:?}");
    }
}

#[test]
fn a_session_does_not_start_without_the_stimulus_set() {
    let folder = tempfile::tempdir().unwrap();
    for command in [
        &["run", PROTOCOL, "--subject", "01"][..],
        &["simulate", PROTOCOL, "--subjects", "2", "--seed", "1"],
    ] {
        refused(folder.path(), command, "acuity render");
    }
    let named = ["check", PROTOCOL, "--stimuli", "here", "--data", "there"];
    let checked = acuity(folder.path(), &named);
    assert_eq!(checked.status.code(), Some(2), "{}", stderr(&checked));
    assert!(text_of(&checked.stdout).contains("here/manifest.json"));
}

#[test]
fn a_file_that_is_named_as_a_folder_is_refused_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("file"), "kept").unwrap();
    for command in [
        "simulate P --subjects 2 --seed 1 --data file",
        "simulate P --subjects 2 --seed 1 --stimuli file",
        "report P --data file",
        "check P --data file --stimuli file",
        "render P --out file",
    ] {
        let words = command.split(' ');
        let words = words.map(|word| if word == "P" { PROTOCOL } else { word });
        let output = acuity(folder.path(), &words.collect::<Vec<_>>());
        let said = text_of(&output.stdout) + &stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{command}: {said}");
        assert!(said.contains("file"), "{command}: {said}");
    }
    assert_eq!(fs::read(folder.path().join("file")).unwrap(), b"kept");
}

#[test]
fn the_program_says_that_a_stopped_channel_changes_a_tree_that_all_channels_drive() {
    let folder = tempfile::tempdir().unwrap();
    let scene = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/stimuli/scenes/opponent-solids.toml"
    );
    let command = ["--rays-a", "2K", "--rays-c1c2", "1K", "--size", "32x32"];
    for (driver, is_remarked) in [("A", false), ("AC1C2", true)] {
        let mut arguments = vec!["image", scene, "--driver", driver, "-o", "x.exr"];
        arguments.extend(command);
        let output = acuity(folder.path(), &arguments);
        assert!(output.status.success(), "{}", stderr(&output));
        let printed = text_of(&output.stdout);
        assert!(printed.contains("shadings A 2000, C1 1000, C2 1000"));
        assert_eq!(
            printed.contains("changes the tree"),
            is_remarked,
            "{driver}"
        );
    }
}

/// 64 × 64 pixels of 0.019 degrees: sides of at most a pixel take 6 halvings each, 4096 cells; C1 and C2 need
/// sides of at most 2.39 pixels, 5 halvings each.
#[test]
fn acuity_control_is_rendered_with_and_without_and_compared() {
    let folder = tempfile::tempdir().unwrap();
    let scene = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/stimuli/scenes/opponent-solids.toml"
    );
    let command = "--rays-a 8K --size 64x64 --acuity --compare whole.png -o limited.png";
    let mut arguments = vec!["image", scene];
    arguments.extend(command.split(' '));
    let output = acuity(folder.path(), &arguments);
    assert!(output.status.success(), "{}", stderr(&output));
    let printed = text_of(&output.stdout);
    let row = |name: &str| {
        let mut lines = printed.lines();
        let line = lines.rfind(|line| line.starts_with(name)).unwrap();
        let words = line.rsplit(' ').filter(|word| !word.is_empty());
        let mut words: Vec<String> = words.take(3).map(str::to_owned).collect();
        words.reverse();
        words
    };
    assert_eq!(row("rays"), ["4096", "8000", "48.8%"]);
    assert_eq!(row("shadings of C1"), ["1024", "8000", "87.2%"]);
    assert_eq!(row("all shadings"), ["6144", "24000", "74.4%"]);
    assert!(printed.contains("JOD"));
    for image in ["limited.png", "whole.png"] {
        assert!(folder.path().join(image).exists());
    }
}

/// A triangle without a camera or a light.
const TRIANGLE: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
    property float z\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 2\n";

#[test]
fn what_a_scene_asks_for_in_vain_is_said_by_check_and_when_it_is_rendered() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("triangle.ply"), TRIANGLE).unwrap();
    let said = "vertex colours are not supported: ignored";
    let checked = acuity(folder.path(), &["check", "triangle.ply"]);
    let stdout = String::from_utf8(checked.stdout.clone()).unwrap();
    assert_eq!(checked.status.code(), Some(0), "{}", stderr(&checked));
    assert!(
        stdout.contains(said) && stdout.contains("ready, with 3 warnings"),
        "{stdout}"
    );
    let counts = ["--rays-a", "1K", "--rays-c1c2", "1K", "--size", "20x20"];
    let words = [
        &["image", "triangle.ply", "-o", "triangle.png"][..],
        &counts,
    ]
    .concat();
    let rendered = acuity(folder.path(), &words);
    assert_eq!(rendered.status.code(), Some(0), "{}", stderr(&rendered));
    assert!(stderr(&rendered).contains(said), "{}", stderr(&rendered));
    assert!(folder.path().join("triangle.png").exists());
    fs::write(folder.path().join("triangle.ply"), &TRIANGLE[..40]).unwrap();
    refused(folder.path(), &["check", "triangle.ply"], "triangle.ply");
    assert_eq!(
        acuity(folder.path(), &["check", "gone.glb"]).status.code(),
        Some(2)
    );
}
