//! The arrows of docs/architecture.md: the front door calls three crates, each knows only the contract,
//! and none knows another.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::path::Path;

const CRATES: [&str; 4] = ["protocols", "renderer", "experiment", "analysis"];

/// The crates of this workspace that the manifest in `folder` names, in any table of dependencies.
fn neighbours(folder: &str) -> Vec<&'static str> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join(folder)
        .join("Cargo.toml");
    let manifest: toml::Table = std::fs::read_to_string(path).unwrap().parse().unwrap();
    let tables = ["dependencies", "dev-dependencies", "build-dependencies"];
    let names = |name: &&str| {
        tables
            .iter()
            .any(|table| manifest.get(*table).is_some_and(|t| t.get(*name).is_some()))
    };
    CRATES.into_iter().filter(names).collect()
}

#[test]
fn the_front_door_calls_all_and_the_parts_know_only_the_contract() {
    assert_eq!(neighbours("."), CRATES);
    assert_eq!(neighbours("protocols"), [""; 0]);
    for part in ["renderer", "experiment", "analysis"] {
        assert_eq!(neighbours(part), ["protocols"], "{part}");
    }
}
