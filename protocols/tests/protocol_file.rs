//! The protocol files of the project, and what is refused in one.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::path::Path;

use protocols::{ChannelGroup, Study};

fn paper() -> Study {
    Study::read(Path::new(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/meyer-liu-1992.toml"
    )))
    .unwrap()
}

#[test]
fn the_paper_has_28_images_of_which_one_ends_both_sequences() {
    let stimuli = paper().render_plan().unwrap().stimuli();
    assert_eq!(stimuli.len(), 28);
    let shared: Vec<_> = stimuli
        .iter()
        .filter(|stimulus| stimulus.sequences.len() == 2)
        .collect();
    assert_eq!(shared.len(), 1);
    assert_eq!(shared[0].id.as_str(), "a140k_c140k");
    assert_eq!(shared[0].sequences, ChannelGroup::ALL);
    let anchors: Vec<_> = stimuli
        .iter()
        .filter(|stimulus| stimulus.sequences.is_empty())
        .collect();
    assert_eq!(anchors.len(), 1);
    assert_eq!(anchors[0].id.as_str(), "a010k_c010k");
}

/// A value of the protocol, what a user might write instead, and what the message must then name.
const FAULTS: [(&str, &str, &str); 24] = [
    ("exposure_s = 10.0", "exposure_sec = 10.0", "exposure_sec"),
    (
        "exposure_s = 10.0",
        "exposure_s = -1.0",
        "session.exposure_s",
    ),
    (
        "exposure_s = 10.0",
        "exposure_s = nan",
        "session.exposure_s",
    ),
    ("zero_rays = \"10K\"", "zero_rays = \"0\"", "ray count"),
    (
        "zero_rays = \"10K\"",
        "zero_rays = \"100\"",
        "minimum depth",
    ),
    (
        "\"20K\", \"30K\"",
        "\"30K\", \"20K\"",
        "larger than the one before",
    ),
    (
        "practice = [\"a010k_c140k\"",
        "practice = [\"a011k_c140k\"",
        "a011k_c140k",
    ),
    ("lowest = 0\n", "lowest = 10\n", "session.scale"),
    (
        "gap_px = 24",
        "response = \"labelled\"\ngap_px = 24",
        "session.texts.labels",
    ),
    (
        "layout = \"flanking\"",
        "layout = \"dscqs\"",
        "session.response",
    ),
    (
        "gap_px = 24",
        "response = \"continuous\"\nrating = \"during-exposure\"\ngap_px = 24",
        "session.rating",
    ),
    (
        "gap_px = 24",
        "shortest_response_s = 2.0\nlongest_response_s = 1.0\ngap_px = 24",
        "session.longest_response_s",
    ),
    (
        "[session.scale]",
        "[[session.order.most_in_a_row]]\nfactor = \"channel\"\nmost = 0\n[session.scale]",
        "session.order.most_in_a_row",
    ),
    (
        "[session.scale]",
        "[session.order]\nscheme = \"latin-square\"\nanchor_repeats = 1\n[session.scale]",
        "session.order.scheme",
    ),
    (
        "[session.scale]",
        "[session.order.blocked_by]\nfactor = \"channel\"\nlevels = [\"achromatic\"]\n[session.scale]",
        "session.order.blocked_by.levels",
    ),
    (
        "within = [\"channel\", \"rays\"]",
        "within = [\"channel\", \"channel\"]",
        "none twice",
    ),
    (
        "within = [\"channel\", \"rays\"]",
        "within = [\"colour\"]",
        "colour",
    ),
    (
        "confidence = 0.95",
        "confidence = 95",
        "analysis.confidence",
    ),
    ("\"16 bands\"", "\"2 bands\"", "3 to 301"),
    ("[viewing]", "[viewing", "line"),
    (
        "[viewing]",
        "[acuity]\nluminance_cutoff_cpd = 0\n[viewing]",
        "acuity.luminance_cutoff_cpd",
    ),
    (
        "[viewing]",
        "[acuity]\nchromatic_cutoff_cpd = nan\n[viewing]",
        "acuity.chromatic_cutoff_cpd",
    ),
    (
        "[viewing]",
        "[acuity]\ncutoff_cpd = 11\n[viewing]",
        "chromatic_cutoff_cpd",
    ),
    (
        "study = \"meyer-liu-1992\"",
        "study = \"../up\"",
        "names folders",
    ),
];

#[test]
fn a_cutoff_that_acuity_leaves_out_is_mullens() {
    let text = std::fs::read_to_string(paper().path).unwrap();
    assert_eq!(paper().protocol.acuity, None);
    let text = text.replace("[viewing]", "[acuity]\nchromatic_cutoff_cpd = 9\n[viewing]");
    let protocol = protocols::Protocol::from_toml(Path::new("x.toml"), &text).unwrap();
    let acuity = protocol.acuity.unwrap();
    assert_eq!(
        (acuity.luminance_cutoff_cpd, acuity.chromatic_cutoff_cpd),
        (34.0, 9.0)
    );
}

#[test]
fn what_is_wrong_with_a_protocol_is_named_with_file_place_and_expectation() {
    let text = std::fs::read_to_string(paper().path).unwrap();
    for (good, bad, named) in FAULTS {
        assert!(text.contains(good), "{good}");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bad.toml");
        std::fs::write(&path, text.replacen(good, bad, 1)).unwrap();
        let message = Study::read(&path).unwrap_err().to_string();
        assert!(message.contains("bad.toml"), "{message}");
        assert!(message.contains(named), "{bad}: {message}");
        assert!(message.contains("expected"), "{message}");
    }
}

#[test]
fn a_missing_truncated_or_binary_protocol_is_an_input_error() {
    let folder = tempfile::tempdir().unwrap();
    let missing = Study::read(&folder.path().join("none.toml")).unwrap_err();
    assert!(matches!(missing, protocols::ReadError::Input(_)));
    let text = std::fs::read_to_string(paper().path).unwrap();
    for (name, bytes) in [
        ("half.toml", &text.as_bytes()[..text.len() / 2]),
        ("binary.toml", &[0xff, 0xfe, 0][..]),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let error = Study::read(&path).unwrap_err();
        assert!(matches!(error, protocols::ReadError::Input(_)), "{name}");
        assert!(error.to_string().contains(name));
    }
}
