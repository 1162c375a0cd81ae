//! Files that nobody wrote: no reader panics, and what is taken can be rendered.
//!
//! `ACUITY_FUZZ_CASES=100000 cargo test --release -p renderer --test imports fuzz` is the long run.

use std::fs;
use std::path::PathBuf;

use proptest::prelude::*;
use proptest::sample::Index;

use super::quad::{self, PlyForm};
use super::*;

fn cases() -> ProptestConfig {
    let asked = std::env::var("ACUITY_FUZZ_CASES").ok();
    let cases = asked.and_then(|asked| asked.parse().ok()).unwrap_or(100);
    ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(cases)
    }
}

/// What is done to the bytes of a good file.
#[derive(Clone, Debug)]
enum Change {
    Set(Index, u8),
    Cut(Index, usize),
    Repeat(Index, usize),
    Insert(Index, Vec<u8>),
    /// A word of the file by another.
    Word(Index, &'static str),
}

const WORDS: [&str; 14] = [
    "0",
    "-1",
    "1e39",
    "4294967295",
    "18446744073709551616",
    "null",
    "[]",
    "{}",
    "\"\"",
    "nan",
    "inf",
    "true",
    "1e-46",
    "3",
];

fn change() -> impl Strategy<Value = Change> {
    prop_oneof![
        (any::<Index>(), any::<u8>()).prop_map(|(at, byte)| Change::Set(at, byte)),
        (any::<Index>(), 1_usize..40).prop_map(|(at, length)| Change::Cut(at, length)),
        (any::<Index>(), 1_usize..40).prop_map(|(at, length)| Change::Repeat(at, length)),
        (any::<Index>(), prop::collection::vec(any::<u8>(), 1..9))
            .prop_map(|(at, bytes)| Change::Insert(at, bytes)),
        (any::<Index>(), prop::sample::select(&WORDS[..]))
            .prop_map(|(at, word)| Change::Word(at, word)),
    ]
}

fn changed(mut bytes: Vec<u8>, changes: &[Change]) -> Vec<u8> {
    for change in changes {
        if bytes.is_empty() {
            return bytes;
        }
        let length = bytes.len();
        match change {
            Change::Set(at, byte) => bytes[at.index(length)] = *byte,
            Change::Cut(at, count) => {
                let start = at.index(length);
                bytes.drain(start..(start + count).min(length));
            }
            Change::Repeat(at, count) => {
                let start = at.index(length);
                let piece = bytes[start..(start + count).min(length)].to_vec();
                bytes.splice(start..start, piece);
            }
            Change::Insert(at, more) => {
                let start = at.index(length);
                bytes.splice(start..start, more.iter().copied());
            }
            Change::Word(at, word) => replace_number(&mut bytes, *at, word),
        }
    }
    bytes
}

/// The number that stands at or after a place by a word.
fn replace_number(bytes: &mut Vec<u8>, at: Index, word: &str) {
    let start = at.index(bytes.len());
    let is_number = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-');
    let Some(first) = bytes[start..].iter().position(is_number) else {
        return;
    };
    let first = start + first;
    let length = bytes[first..]
        .iter()
        .take_while(|byte| is_number(byte))
        .count();
    bytes.splice(first..first + length, word.bytes());
}

/// A file of these bytes is refused by name, or can be rendered.
fn take(path: &Path, bytes: &[u8]) -> Result<(), TestCaseError> {
    fs::write(path, bytes).unwrap();
    match Scene::read(path) {
        Err(error) => {
            prop_assert!(error.is_input(), "{error}");
            prop_assert!(error.to_string().contains("expected"), "{error}");
        }
        Ok(scene) => {
            let sampler = scene.sampler(Quadrature::Bands(3), [10, 10]);
            let mut tree = RayTree::default();
            for (x, y) in [(0.5, 0.5), (0.2, 0.7), (0.9, 0.4)] {
                sampler.intersect(ScreenPoint { x, y }, &mut tree);
                prop_assert!(sampler.shade(&tree, Channel::A).is_finite());
            }
        }
    }
    Ok(())
}

/// A folder of its own for each test, with the files that good files name.
fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    quad::write(folder.path(), |_| ());
    quad::write_obj(folder.path());
    let path = folder.path().to_owned();
    (folder, path)
}

fn fuzz(name: &str, good: &[u8]) {
    let (_folder, path) = folder();
    let path = path.join(name);
    proptest!(cases(), |(changes in prop::collection::vec(change(), 1..6))| {
        take(&path, &changed(good.to_vec(), &changes))?;
    });
}

#[test]
fn a_changed_gltf_is_refused_or_rendered() {
    let (_folder, path) = folder();
    let good = fs::read(path.join("square.gltf")).unwrap();
    fuzz("other.gltf", &good);
}

#[test]
fn a_changed_glb_is_refused_or_rendered() {
    fuzz("other.glb", &quad::whole_glb());
}

#[test]
fn a_changed_obj_is_refused_or_rendered() {
    let (_folder, path) = folder();
    let good = fs::read(path.join("square.obj")).unwrap();
    fuzz("other.obj", &good);
}

#[test]
fn a_changed_mtl_is_refused_or_rendered() {
    let (_folder, path) = folder();
    let good = fs::read(path.join("square.mtl")).unwrap();
    proptest!(cases(), |(changes in prop::collection::vec(change(), 1..6))| {
        fs::write(path.join("square.mtl"), changed(good.clone(), &changes)).unwrap();
        let obj = fs::read(path.join("square.obj")).unwrap();
        take(&path.join("square.obj"), &obj)?;
    });
}

#[test]
fn a_changed_ply_is_refused_or_rendered() {
    for form in [PlyForm::Ascii, PlyForm::Little, PlyForm::Big] {
        fuzz("other.ply", &quad::ply(form));
    }
}

#[test]
fn a_changed_picture_is_refused_or_rendered() {
    let (_folder, path) = folder();
    let exr = path.join("print.exr");
    exr::prelude::write_rgb_file(&exr, 2, 2, |x, y| (x as f32, y as f32, 0.5)).unwrap();
    let exr = fs::read(exr).unwrap();
    let mut jpeg = std::io::Cursor::new(Vec::new());
    let image = image::RgbImage::from_pixel(8, 8, image::Rgb([188, 20, 90]));
    image.write_to(&mut jpeg, image::ImageFormat::Jpeg).unwrap();
    let scene = path.join("scene.toml");
    let text = quad::scene_toml("file = \"square.gltf\", material = \"print\"");
    for good in [quad::png(), exr, jpeg.into_inner()] {
        proptest!(cases(), |(changes in prop::collection::vec(change(), 1..6))| {
            fs::write(path.join("print.png"), changed(good.clone(), &changes)).unwrap();
            take(&scene, text.as_bytes())?;
        });
    }
}

#[test]
fn a_changed_scene_file_is_refused_or_rendered() {
    let text = quad::scene_toml("file = \"square.gltf\"");
    fuzz("scene.toml", text.as_bytes());
}
