//! The paper's study end to end, by its own command: every file is there, the same bytes come again, and
//! the paper's claims hold for the simulated observers.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod acuity;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use acuity::{PROTOCOL, acuity, stderr, text_of};
use protocols::{Manifest, Sha256Digest, Study};

/// Every file below `folder`, by its path from there, with its digest.
fn digests(folder: &Path) -> BTreeMap<PathBuf, Sha256Digest> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let digest = Sha256Digest::of_file(&path).unwrap();
                found.insert(path.strip_prefix(folder).unwrap().to_owned(), digest);
            }
        }
    }
    found
}

fn replicate(folder: &Path) -> String {
    let output = acuity(folder, &["replicate", "--protocol", PROTOCOL]);
    assert!(output.status.success(), "{}", stderr(&output));
    text_of(&output.stdout)
}

#[test]
fn replicate_ends_with_the_path_of_a_report_and_makes_the_same_bytes_twice() {
    let [first, second] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let printed = replicate(first.path());
    let report = printed.lines().last().unwrap();
    assert!(report.ends_with("report.html"), "{printed}");
    assert!(first.path().join(report).is_file());
    replicate(second.path());
    let made = digests(first.path());
    assert_eq!(made, digests(second.path()));
    for name in [
        "report.html",
        "anova.json",
        "anova.csv",
        "means.csv",
        "figure-10.svg",
        "figure-10.png",
    ] {
        assert!(made.keys().any(|path| path.ends_with(name)), "no {name}");
    }
}

#[test]
fn the_set_is_the_same_with_one_and_two_threads_and_one_image_alone_equals_the_sets() {
    let folder = tempfile::tempdir().unwrap();
    for threads in ["1", "2"] {
        let output = acuity(
            folder.path(),
            &["render", PROTOCOL, "--out", threads, "--threads", threads],
        );
        assert!(output.status.success(), "{}", stderr(&output));
    }
    let set = digests(&folder.path().join("1"));
    assert_eq!(set.len(), 28 * 2 + 1);
    assert_eq!(set, digests(&folder.path().join("2")));

    let study = Study::read(Path::new(PROTOCOL)).unwrap();
    let manifest = Manifest::read(&folder.path().join("1")).unwrap();
    manifest
        .check_made_for(&study, &folder.path().join("1"))
        .unwrap();
    for (rays_a, rays_c1c2, id) in [
        ("50K", "140K", "a050k_c140k"),
        ("140K", "30K", "a140k_c030k"),
        ("10K", "10K", "a010k_c010k"),
    ] {
        let scene = study.scene_path().unwrap();
        let arguments = [
            "image",
            scene.to_str().unwrap(),
            "--rays-a",
            rays_a,
            "--rays-c1c2",
            rays_c1c2,
            "-o",
            "x.exr",
        ];
        let output = acuity(folder.path(), &arguments);
        assert!(output.status.success(), "{}", stderr(&output));
        let alone = fs::read(folder.path().join("x.exr")).unwrap();
        let of_set = fs::read(folder.path().join(format!("1/{id}.exr"))).unwrap();
        assert!(alone == of_set, "{id} differs from the image made alone");
    }
}

/// `cd stimuli && sha256sum -c meyer-liu-1992.sha256` checks a set by hand. A change of the renderer that
/// changes the stimuli must be meant: `ACUITY_UPDATE_CHECKSUMS=1 cargo test --release --test replication
/// images_of_the_paper` writes the list anew.
///
/// The variable tells glibc to do without newer instructions, with which its sines and exponentials have other
/// last bits; elsewhere it does nothing. So the pictures do not depend on the platform's mathematics.
#[test]
fn the_images_of_the_paper_are_those_of_the_checksums() {
    let folder = tempfile::tempdir().unwrap();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_acuity"))
        .current_dir(folder.path())
        .args(["render", PROTOCOL, "--out", "meyer-liu-1992", "-q"])
        .env(
            "GLIBC_TUNABLES",
            "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX,-AVX512F",
        )
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let lines = digests(folder.path())
        .into_iter()
        .filter_map(|(path, digest)| {
            let is_image = path.extension().is_some_and(|ending| ending != "json");
            is_image.then(|| format!("{digest}  {}\n", path.display()))
        });
    let ours: Vec<String> = lines.collect();
    assert_eq!(ours.len(), 28 * 2);
    let list = Path::new(env!("CARGO_MANIFEST_DIR")).join("stimuli/meyer-liu-1992.sha256");
    if std::env::var_os("ACUITY_UPDATE_CHECKSUMS").is_some() {
        fs::write(&list, ours.concat()).unwrap();
    }
    let held = fs::read_to_string(&list).unwrap();
    let changed: Vec<&str> = ours
        .iter()
        .map(String::as_str)
        .filter(|line| !held.contains(*line))
        .collect();
    assert!(
        changed.is_empty() && held == ours.concat(),
        "{} of {} images are not those of {}:\n{}",
        changed.len(),
        ours.len(),
        list.display(),
        changed.concat()
    );
}

#[test]
fn no_pixel_of_the_ten_anchor_is_out_of_the_srgb_gamut() {
    let folder = tempfile::tempdir().unwrap();
    let output = acuity(folder.path(), &["render", PROTOCOL, "--out", "set"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let study = Study::read(Path::new(PROTOCOL)).unwrap();
    let manifest = Manifest::read(&folder.path().join("set")).unwrap();
    let ten = manifest
        .stimulus(&study.protocol.stimuli.ten_anchor().unwrap())
        .unwrap();
    assert_eq!(ten.out_of_gamut_px, 0);
}

/// Section 3.4: both main effects and the interaction, p < 0.001 each; and "changes to the chromatic channels
/// having less of an impact on image quality at all choices for number of rays", read below the asymptote of
/// the achromatic sequence (90K).
#[test]
fn the_simulated_study_has_the_pattern_of_the_paper() {
    let folder = tempfile::tempdir().unwrap();
    let printed = replicate(folder.path());
    let report = folder.path().join(printed.lines().last().unwrap());
    let text = fs::read_to_string(report.with_file_name("anova.json")).unwrap();
    let anova: serde_json::Value = serde_json::from_str(&text).unwrap();
    for effect in ["channel", "rays", "channel:rays"] {
        let rows = anova["effects"].as_array().unwrap();
        let row = rows.iter().find(|row| row["effect"] == effect).unwrap();
        let p = row["p_gg"].as_f64().or_else(|| row["p"].as_f64()).unwrap();
        assert!(p < 0.001, "{effect}: p = {p}");
    }
    let means = fs::read_to_string(report.with_file_name("means.csv")).unwrap();
    for rays in ["10K", "20K", "30K", "40K", "50K", "60K", "70K", "80K"] {
        let mean = |channel: &str| mean_rating(&means, channel, rays);
        assert!(mean("chromatic") > mean("achromatic"), "{rays}");
    }
}

/// The mean rating in the row with these levels.
fn mean_rating(means: &str, channel: &str, rays: &str) -> f64 {
    let header: Vec<&str> = means.lines().next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|column| *column == name).unwrap();
    let rows = means
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect::<Vec<_>>());
    let mut of_levels =
        rows.filter(|row| row[column("channel")] == channel && row[column("rays")] == rays);
    of_levels.next().unwrap()[column("mean")].parse().unwrap()
}
