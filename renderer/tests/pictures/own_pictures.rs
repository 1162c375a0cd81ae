//! What is shown of own pictures of every kind of PNG.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, Rgb, Rgba};
use protocols::{Manifest, PictureManifest, Study};
use renderer::{PictureSetSummary, RendererError, Watch, make_picture_set};

/// A study of the pictures `a` (8-bit RGB) and `b`.
fn study(folder: &Path, b: &[u8]) -> Study {
    let example =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/examples/quantisation/protocol.toml");
    let text = fs::read_to_string(example).unwrap();
    let practice = "practice = [\"rods-luma-160\", \"sphere-chroma-020\", \"rods-luma-040\"]";
    let text = text
        .replace("pictures/", "")
        .replace(practice, "practice = []")
        .replace("\"quantised\", \"step\"", "\"kind\"")
        .replace("layout = \"dsis\"", "layout = \"single\"");
    fs::write(folder.join("p.toml"), text).unwrap();
    fs::write(folder.join("factors.csv"), "image,kind\na.png,1\nb.png,2\n").unwrap();
    fs::write(folder.join("a.png"), png(&DynamicImage::new_rgb8(3, 2))).unwrap();
    fs::write(folder.join("b.png"), b).unwrap();
    Study::read(&folder.join("p.toml")).unwrap()
}

fn png(image: &DynamicImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// Makes the set; gives what is shown of `b`, pixel by pixel.
fn made(b: &[u8]) -> Result<(PictureSetSummary, Vec<u8>), RendererError> {
    let folder = tempfile::tempdir().unwrap();
    let study = study(folder.path(), b);
    let pictures = study.protocol.stimuli.pictures().unwrap();
    let out = folder.path().join("set");
    let made = make_picture_set(&study, pictures, &out, &Watch::UNWATCHED);
    assert_eq!(out.join(Manifest::FILE_NAME).exists(), made.is_ok());
    let summary = made?;
    let manifest = PictureManifest::read(&study, pictures, &out).unwrap();
    assert_eq!(manifest.size_px, [3, 2]);
    let shown = manifest.pictures[1].png.read_verified(&out).unwrap();
    let shown = image::load_from_memory(&shown).unwrap();
    assert_eq!(shown.color(), image::ColorType::Rgb8);
    Ok((summary, shown.into_rgb8().into_raw()))
}

#[test]
fn values_of_16_bits_are_rounded_to_the_nearest_of_8() {
    // 16 bits hold 257 steps for each of 8: v is shown as round(v / 257).
    let values = [0_u16, 128, 129, 65_535 - 129, 65_535 - 128, 257 * 100];
    let image = ImageBuffer::from_fn(3, 2, |x, y| Rgb([values[(3 * y + x) as usize]; 3]));
    let (summary, shown) = made(&png(&DynamicImage::ImageRgb16(image))).unwrap();
    let expected = [0_u8, 0, 1, 254, 255, 100];
    assert_eq!(shown, expected.map(|value| [value; 3]).concat());
    assert!(summary.remarks[0].starts_with("b.png: 16-bit"), "{summary}");
}

#[test]
fn grey_is_spread_and_an_opaque_alpha_channel_left_out_with_a_remark() {
    let grey = ImageBuffer::from_fn(3, 2, |x, _| Luma([u8::try_from(x).unwrap() * 100]));
    let (summary, shown) = made(&png(&DynamicImage::ImageLuma8(grey))).unwrap();
    assert_eq!(shown, [[0; 3], [100; 3], [200; 3]].concat().repeat(2));
    assert!(summary.remarks.is_empty());

    let opaque = ImageBuffer::from_pixel(3, 2, Rgba([1, 2, 3, 255]));
    let (summary, shown) = made(&png(&DynamicImage::ImageRgba8(opaque))).unwrap();
    assert_eq!(shown, [1, 2, 3].repeat(6));
    assert!(summary.remarks[0].contains("alpha"), "{summary}");
}

#[test]
fn transparent_pixels_and_another_size_are_refused() {
    let mut image = ImageBuffer::from_pixel(3, 2, Rgba([1, 2, 3, 255]));
    image.put_pixel(2, 1, Rgba([1, 2, 3, 254]));
    let error = made(&png(&DynamicImage::ImageRgba8(image))).unwrap_err();
    assert!(error.is_input());
    assert!(
        error.to_string().contains("transparent pixel at 2, 1"),
        "{error}"
    );
    let error = made(&png(&DynamicImage::new_rgb8(2, 3))).unwrap_err();
    assert!(error.to_string().contains("2 x 3 pixels"), "{error}");
    assert!(error.to_string().contains("b.png"), "{error}");
}

#[test]
fn a_picture_that_says_it_is_not_srgb_is_remarked() {
    let plain = png(&DynamicImage::new_rgb8(3, 2));
    // After the signature and the 25 bytes of IHDR: a gamma of 1, with its CRC-32 by Python's zlib.crc32.
    let gamma = [
        &[0, 0, 0, 4][..],
        b"gAMA",
        &100_000_u32.to_be_bytes(),
        &[0x31, 0xe8, 0x96, 0x5f],
    ];
    let with_gamma = [&plain[..33], &gamma.concat(), &plain[33..]].concat();
    let (summary, _) = made(&with_gamma).unwrap();
    assert_eq!(
        summary.remarks,
        ["b.png: a gamma of 1 is not applied: the pixels are shown as sRGB"]
    );
}
