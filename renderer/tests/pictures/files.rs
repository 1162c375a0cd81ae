//! Image files and requests that cannot be used.

use std::path::Path;

use protocols::{PerChannel, RayCount};
use renderer::{ImageRequest, Watch, read_opponent_exr, render_image_of};

use crate::analytic::disc_and_checks;
use crate::small_study::{image_alone, no_scene, request, small_study};

fn an_exr() -> Vec<u8> {
    image_alone(&request(&small_study(), 1000, 1000), "x.exr")
}

fn refusal(bytes: &[u8]) -> String {
    read_opponent_exr(bytes, Path::new("x.exr"))
        .unwrap_err()
        .to_string()
}

#[test]
fn a_truncated_exr_is_refused_wherever_it_ends() {
    let bytes = an_exr();
    assert!(read_opponent_exr(&bytes, Path::new("x.exr")).is_ok());
    for end in (0..bytes.len()).step_by(97) {
        let text = refusal(&bytes[..end]);
        assert!(text.starts_with("\"x.exr\": found "), "{text}");
        assert!(text.contains("expected an EXR file"), "{text}");
    }
}

#[test]
fn a_file_that_is_no_exr_or_has_other_channels_is_refused() {
    assert!(refusal(b"not an image").contains("x.exr"));
    let mut file = std::io::Cursor::new(Vec::new());
    {
        use exr::prelude::*;
        let pixels = SpecificChannels::rgb(|_: Vec2<usize>| (0.1_f32, 0.2_f32, 0.3_f32));
        Image::from_channels((4, 4), pixels)
            .write()
            .to_buffered(&mut file)
            .unwrap();
    }
    assert!(refusal(&file.into_inner()).contains("no such channel A"));
}

#[test]
fn a_value_that_is_not_finite_is_refused() {
    use exr::prelude::*;
    let samples = |name: &str| AnyChannel::new(name, FlatSamples::F32(vec![f32::NAN; 4]));
    let list = ["A", "C1", "C2"].map(samples);
    let channels = AnyChannels::sort(list.into_iter().collect());
    let mut file = std::io::Cursor::new(Vec::new());
    Image::from_channels((2, 2), channels)
        .write()
        .to_buffered(&mut file)
        .unwrap();
    assert!(refusal(&file.into_inner()).contains("the value NaN in channel A"));
}

/// Read as the file format is documented: names in order, ray counts, matrix.
#[test]
fn the_attributes_stand_in_order_and_say_how_the_image_was_made() {
    let bytes = image_alone(&request(&small_study(), 1000, 3210), "x.exr");
    let mut names = Vec::new();
    let mut at = 8;
    while bytes[at] != 0 {
        let word = |from: usize| from + bytes[from..].iter().position(|&byte| byte == 0).unwrap();
        let end_of_name = word(at);
        let end_of_type = word(end_of_name + 1);
        let length = u32::from_le_bytes(bytes[end_of_type + 1..][..4].try_into().unwrap());
        let value = &bytes[end_of_type + 5..][..length as usize];
        names.push(String::from_utf8(bytes[at..end_of_name].to_vec()).unwrap());
        match names.last().unwrap().as_str() {
            "raysA" => assert_eq!(value, b"1000"),
            "raysC1C2" => assert_eq!(value, b"3210"),
            "seed" => assert_eq!(value, b"1992"),
            "ac1c2FromXyz" => {
                // Eq. 2, first and last entries.
                assert_eq!(value[..4], (-0.0177_f32).to_le_bytes());
                assert_eq!(value[32..], 0.5264_f32.to_le_bytes());
            }
            _ => {}
        }
        at = end_of_type + 5 + length as usize;
    }
    assert!(names.is_sorted(), "{names:?}");
    for wanted in [
        "ac1c2FromXyz",
        "channels",
        "quadrature",
        "raysA",
        "raysC1C2",
        "sceneSha256",
        "seed",
    ] {
        assert!(
            names.iter().any(|name| name == wanted),
            "no {wanted} in {names:?}"
        );
    }
}

#[test]
fn an_ending_that_is_no_format_is_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let request = request(&small_study(), 1000, 1000);
    for name in ["x.jpg", "x", "exr"] {
        let path = folder.path().join(name);
        let error = render_image_of(
            &disc_and_checks(),
            no_scene(),
            &request,
            &path,
            &Watch::UNWATCHED,
        )
        .unwrap_err();
        assert!(
            error.is_input() && error.to_string().contains(".exr"),
            "{error}"
        );
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_request_that_contradicts_itself_is_refused() {
    let whole = request(&small_study(), 1000, 1000);
    let refused = |request: ImageRequest, what: &str| {
        let error = request
            .check(Path::new("scene.toml"))
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with("\"scene.toml\"") && error.contains(what),
            "{error}"
        );
    };
    assert!(whole.check(Path::new("scene.toml")).is_ok());
    refused(
        ImageRequest {
            size_px: [0, 10],
            ..whole.clone()
        },
        "0x10",
    );
    refused(
        ImageRequest {
            size_px: [10, 20_000],
            ..whole.clone()
        },
        "10x20000",
    );
    // The minimum depth of 8 has 256 cells.
    refused(
        ImageRequest {
            rays_c1c2: RayCount::new(255).unwrap(),
            ..whole.clone()
        },
        "256 cells",
    );
    let depths = |a, c1, c2| ImageRequest {
        stop_depths: PerChannel { a, c1, c2 },
        ..whole.clone()
    };
    refused(depths(Some(49), None, None), "49 for A");
    refused(depths(None, Some(0), None), "0 for C1");
    refused(
        depths(Some(10), Some(8), Some(11)),
        "11 for a chromatic channel and 10 for A",
    );
    refused(depths(Some(7), None, None), "minimum depth of 8");
    assert!(
        depths(Some(10), Some(8), None)
            .check(Path::new("scene.toml"))
            .is_ok()
    );
}

#[test]
fn stop_depths_make_a_coarser_image_from_fewer_rectangles() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.png");
    let stopped = ImageRequest {
        stop_depths: PerChannel {
            a: None,
            c1: Some(6),
            c2: Some(4),
        },
        ..request(&small_study(), 4000, 4000)
    };
    let summary = render_image_of(
        &disc_and_checks(),
        no_scene(),
        &stopped,
        &path,
        &Watch::UNWATCHED,
    )
    .unwrap();
    // 2⁶ and 2⁴ cells, all above the minimum depth of 8.
    assert_eq!(
        summary.rectangles,
        PerChannel {
            a: 4000,
            c1: 64,
            c2: 16
        }
    );
    assert_eq!(
        summary.account.shadings,
        PerChannel {
            a: 4000,
            c1: 64,
            c2: 16
        }
    );
    assert_eq!(summary.account.saved_shadings(), 12_000 - 4080);
    assert!(path.exists());
}
