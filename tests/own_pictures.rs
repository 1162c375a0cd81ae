//! Own pictures instead of a scene: the example of the manual end to end, and what is refused.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod acuity;

use std::fs;
use std::path::{Path, PathBuf};

use acuity::{PROTOCOL, acuity, stderr, text_of};
use protocols::Sha256Digest;

/// A copy of the example, with the original's pictures.
struct Example {
    folder: tempfile::TempDir,
}

impl Example {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let example = Path::new(PROTOCOL).with_file_name("../docs/examples/quantisation");
        fs::create_dir(folder.path().join("pictures")).unwrap();
        for source in ["", "pictures"] {
            for entry in fs::read_dir(example.join(source)).unwrap() {
                let entry = entry.unwrap();
                if entry.path().is_file() {
                    let name = Path::new(source).join(entry.file_name());
                    fs::copy(entry.path(), folder.path().join(name)).unwrap();
                }
            }
        }
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn change(&self, name: &str, from: &str, to: &str) {
        let text = fs::read_to_string(self.path(name)).unwrap();
        assert!(text.contains(from), "{from}");
        fs::write(self.path(name), text.replacen(from, to, 1)).unwrap();
    }

    fn succeeds(&self, command: &str) -> String {
        let output = acuity(self.folder.path(), &command.split(' ').collect::<Vec<_>>());
        assert!(output.status.success(), "{command}: {}", stderr(&output));
        text_of(&output.stdout)
    }

    /// The message of a command that ends with exit code 2.
    fn refusal(&self, command: &str) -> String {
        let output = acuity(self.folder.path(), &command.split(' ').collect::<Vec<_>>());
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{command}: {message}");
        message
    }
}

const RENDER: &str = "render protocol.toml";
const SIMULATE: &str = "simulate protocol.toml --subjects 12 --seed 1";

#[test]
fn the_example_goes_from_pictures_to_a_report() {
    let example = Example::new();
    let printed = example.succeeds(RENDER);
    assert!(
        printed.contains("18 pictures of 96 x 80 pixels, 16 of them rated"),
        "{printed}"
    );
    // 8-bit RGB is shown as it is: the bytes of the source.
    for name in ["rods-luma-160.png", "sphere-original.png"] {
        let digest = |path: PathBuf| Sha256Digest::of_file(&path).unwrap();
        let shown = example.path("stimuli/quantisation").join(name);
        assert_eq!(digest(shown), digest(example.path("pictures").join(name)));
    }
    example.succeeds(SIMULATE);
    let ratings = fs::read_to_string(example.path(
        "data/quantisation-simulated/data/study-quantisation_subject-01_session-1_task-rating_data.csv",
    ));
    let ratings = ratings.unwrap();
    assert!(
        ratings
            .lines()
            .next()
            .unwrap()
            .contains(",detail,quantised,step,rating,")
    );
    // Three practice trials and 16 pictures; the originals are shown but never rated.
    assert_eq!(ratings.lines().count(), 1 + 3 + 16);
    assert!(!ratings.contains("original"));

    let printed = example.succeeds("report protocol.toml --data data/quantisation-simulated");
    let report = example.path(printed.lines().last().unwrap());
    let anova = fs::read_to_string(report.with_file_name("anova.json")).unwrap();
    let anova: serde_json::Value = serde_json::from_str(&anova).unwrap();
    let effects = anova["effects"].as_array().unwrap();
    let df = |effect: &str| {
        let row = effects.iter().find(|row| row["effect"] == effect).unwrap();
        [
            row["df_num"].as_u64().unwrap(),
            row["df_den"].as_u64().unwrap(),
        ]
    };
    // Two and four levels, 12 observers: 1 and 3 degrees of freedom, times 11 for the error.
    assert_eq!(df("quantised"), [1, 11]);
    assert_eq!(df("step"), [3, 33]);
    assert_eq!(df("quantised:step"), [3, 33]);
    let means = fs::read_to_string(report.with_file_name("means.csv")).unwrap();
    assert!(means.starts_with("stimulus_id,detail,quantised,step,n,mean,"));
    assert_eq!(means.lines().count(), 1 + 16);
    let page = fs::read_to_string(&report).unwrap();
    assert!(page.contains("quantised × step") && page.contains("<svg"));
    assert!(report.with_file_name("figure.svg").is_file());
}

#[test]
fn the_same_pictures_and_seed_give_the_same_ratings() {
    let [one, other] = [(); 2].map(|()| Example::new());
    for example in [&one, &other] {
        example.succeeds(RENDER);
        example.succeeds(SIMULATE);
    }
    for name in [
        "stimuli/quantisation/manifest.json",
        "data/quantisation-simulated/data/study-quantisation_subject-07_session-1_task-rating_data.csv",
    ] {
        assert_eq!(
            fs::read(one.path(name)).unwrap(),
            fs::read(other.path(name)).unwrap()
        );
    }
}

/// A change to the protocol or the table, and what the message must name.
const FAULTS: [(&str, &str, &str, &str); 15] = [
    ("pictures/factors.csv", "image,", "picture,", "`image`"),
    ("pictures/factors.csv", "step\n", "rating\n", "\"rating\""),
    (
        "pictures/factors.csv",
        "detail,quantised",
        "step,quantised",
        "twice",
    ),
    (
        "pictures/factors.csv",
        "sphere,luma,20",
        "sphere,,20",
        "column quantised",
    ),
    (
        "pictures/factors.csv",
        "sphere,luma,20",
        "sphere,luma",
        "line: 3",
    ),
    (
        "pictures/factors.csv",
        "sphere-luma-020.png",
        "Sphere.png",
        "lower-case",
    ),
    (
        "pictures/factors.csv",
        "sphere-luma-020.png",
        "../x.png",
        "line 3",
    ),
    (
        "pictures/factors.csv",
        "rods-luma-020.png,rods-original.png",
        "rods-luma-020.png,none.png",
        "none",
    ),
    (
        "pictures/factors.csv",
        "rods-luma-040.png",
        "rods-luma-020.png",
        "again",
    ),
    (
        "pictures/factors.csv",
        "rods-luma-040.png",
        "rods-luma-041.png",
        "rods-luma-04",
    ),
    (
        "protocol.toml",
        "pictures/*.png",
        "pictures/*.jpg",
        "stimuli.images",
    ),
    (
        "protocol.toml",
        "factors = \"pictures/factors.csv\"",
        "factors = \"none.csv\"",
        "none.csv",
    ),
    (
        "protocol.toml",
        "within = [\"quantised\"",
        "within = [\"codec\"",
        "codec",
    ),
    (
        "protocol.toml",
        "layout = \"dsis\"",
        "layout = \"flanking\"",
        "stimuli.anchors",
    ),
    (
        "protocol.toml",
        "set = \"quantisation\"",
        "set = \"quantisation\"\nseed = 1",
        "seed",
    ),
];

#[test]
fn what_is_wrong_with_the_protocol_or_the_table_is_named() {
    for (file, from, to, named) in FAULTS {
        let example = Example::new();
        example.change(file, from, to);
        let message = example.refusal(RENDER);
        assert!(message.contains(named), "{to}: {message}");
        assert!(message.contains("expected"), "{to}: {message}");
        assert!(!example.path("stimuli").exists(), "{to}");
    }
}

#[test]
fn pictures_that_are_torn_missing_unlisted_or_changed_are_refused() {
    let example = Example::new();
    let path = example.path("pictures/rods-luma-080.png");
    let bytes = fs::read(&path).unwrap();
    for end in [0, 8, 100, bytes.len() / 2] {
        fs::write(&path, &bytes[..end]).unwrap();
        assert!(
            example.refusal(RENDER).contains("rods-luma-080.png"),
            "{end}"
        );
    }
    fs::remove_file(&path).unwrap();
    assert!(example.refusal(RENDER).contains("line 14, column image"));
    fs::write(&path, &bytes).unwrap();
    fs::write(example.path("pictures/more.png"), &bytes).unwrap();
    assert!(example.refusal(RENDER).contains("no line for \"more.png\""));
    fs::remove_file(example.path("pictures/more.png")).unwrap();
    assert!(
        example
            .refusal("render protocol.toml --out pictures")
            .contains("another folder")
    );
    assert!(
        example
            .refusal("figures protocol.toml -o f")
            .contains("own pictures")
    );

    example.succeeds(RENDER);
    let table = "pictures/factors.csv";
    let original = fs::read_to_string(example.path(table)).unwrap();
    example.change(table, "rods,luma,80", "rods,luma,81");
    assert!(
        example
            .refusal(SIMULATE)
            .contains("another table of factors")
    );
    fs::write(example.path(table), original).unwrap();
    let shown = example.path("stimuli/quantisation/rods-luma-080.png");
    fs::write(shown, &bytes[..100]).unwrap();
    assert!(example.refusal(SIMULATE).contains("SHA-256"));
}
