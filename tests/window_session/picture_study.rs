//! A small study of pictures in which hardly two pixels are alike, so that a shift by one pixel or a change by one level
//! shows; and what the screen says of them.

use std::fs;
use std::ops::Range;
use std::path::Path;

use image::{ExtendedColorType, save_buffer};

use crate::display::{Display, SIZE, Screenshot};
use crate::{GREY, Place};

/// Odd, so that the middle of the screen lies within a pixel.
pub(crate) const PICTURE: [usize; 2] = [97, 83];
/// The upper left corner of a picture in the middle of 1280 x 1024 pixels: 640 - 48.5 and 512 - 41.5, rounded down.
pub(crate) const CORNER: [usize; 2] = [591, 470];
/// Zero anchor, ten anchor (and reference), and three that are rated.
pub(crate) const NAMES: [&str; 5] = ["worst", "original", "one", "two", "three"];
/// Between the bands that say PILOT.
pub(crate) const CLEAR: Range<usize> = 54..SIZE[1] - 54;

const HEAD: &str = r#"
study = "layouts"
title = "Layouts and scales"
source = "a test, no study"

[stimuli]
set = "layouts"
images = "pictures/*.png"
factors = "pictures/factors.csv"

[stimuli.anchors]
zero = "worst.png"
ten = "original.png"

[viewing]
distance_cm = 101.6
degrees_per_pixel = 0.019

[analysis]
within = ["kind"]
correction = "greenhouse-geisser"
confidence = 0.95

[simulation]
peak_luminance_cd_m2 = 100.0
bias = { mean = 0.0, sd = 0.3 }
gain = { mean = 0.95, sd = 0.1 }
noise = { mean = 0.0, sd = 0.5 }
ln_response_time = { mean = 0.92, sd = 0.35 }

[session]
gap_px = 24
pause_s = 0.4
background_srgb = 128
blocks = 1
order_seed = 1
"#;

const TEXTS: &str = r#"
[session.texts]
instructions = "Please look."
practice_over = "From now on your answers count."
question = "How good was it?"
lowest = "worst"
highest = "best"
thanks = "Thank you."
labels = ["bad", "poor", "fair", "good", "excellent"]
"#;

/// The study with these lines in `[session]` and a scale from `lowest` to `highest`.
pub(crate) fn place(session: &str, [lowest, highest]: [i32; 2]) -> Place {
    let folder = tempfile::tempdir().unwrap();
    let pictures = folder.path().join("pictures");
    fs::create_dir(&pictures).unwrap();
    for name in NAMES {
        save(&pictures.join(format!("{name}.png")), &pixels(name));
    }
    let table = "image,reference,kind\nworst.png,,\noriginal.png,,\none.png,original.png,1\n\
                 two.png,original.png,2\nthree.png,original.png,3\n";
    fs::write(pictures.join("factors.csv"), table).unwrap();
    let scale = format!("\n[session.scale]\nlowest = {lowest}\nhighest = {highest}\n");
    let protocol = folder.path().join("protocol.toml");
    fs::write(&protocol, [HEAD, session, &scale, TEXTS].concat()).unwrap();
    Place::of(folder, &protocol)
}

fn save(path: &Path, rgb: &[u8]) {
    let [width, height] = PICTURE.map(|pixels| u32::try_from(pixels).unwrap());
    save_buffer(path, rgb, width, height, ExtendedColorType::Rgb8).unwrap();
}

/// The bytes of a picture: noise that its name decides.
pub(crate) fn pixels(name: &str) -> Vec<u8> {
    let seed = name.bytes().fold(7_u32, |seed, byte| {
        seed.wrapping_mul(31).wrapping_add(byte.into())
    });
    let byte = |index: u32| {
        let mut noise = index.wrapping_mul(0x9e37_79b9) ^ seed;
        noise = (noise ^ noise >> 15).wrapping_mul(0x85eb_ca6b);
        (noise ^ noise >> 13).to_le_bytes()[1]
    };
    let count = u32::try_from(3 * PICTURE[0] * PICTURE[1]).unwrap();
    (0..count).map(byte).collect()
}

/// Which picture stands in the middle of the screen, every byte of it.
pub(crate) fn picture_on(shot: &Screenshot) -> Option<&'static str> {
    let found = shot.part(CORNER, PICTURE);
    NAMES.into_iter().find(|name| pixels(name) == found)
}

/// Waits for a picture in the middle; all around it, in these rows of the screen, is grey.
pub(crate) fn see(display: &Display, rows: Range<usize>) -> &'static str {
    let shot = display.wait_for("a picture, every byte of it", |shot| {
        picture_on(shot).is_some()
    });
    let [left, top] = CORNER;
    for y in rows {
        for x in 0..SIZE[0] {
            let is_picture =
                (left..left + PICTURE[0]).contains(&x) && (top..top + PICTURE[1]).contains(&y);
            assert!(is_picture || shot.pixel([x, y]) == GREY, "pixel {x}, {y}");
        }
    }
    picture_on(&shot).unwrap()
}

/// Waits for a picture and until it has gone.
pub(crate) fn see_to_the_end(display: &Display, rows: Range<usize>) -> &'static str {
    let name = see(display, rows);
    display.wait_for("the end of the picture", |shot| picture_on(shot).is_none());
    name
}
