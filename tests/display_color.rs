//! The rendered set on displays whose colours are known: from its EXR files to the display's codes.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::path::Path;
use std::process::Command;

use experiment::{Display, DisplayColor, MeasuredColor, StimulusSet};
use protocols::Study;

const PROTOCOL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/protocols/meyer-liu-1992.toml");

fn measured(red: [f64; 2], green: [f64; 2]) -> Display {
    let color = DisplayColor::Measured(MeasuredColor {
        red,
        green,
        blue: [0.15, 0.06],
        white: [0.3127, 0.3290],
        gamma: None,
    });
    color.display(Path::new("station.toml")).unwrap()
}

/// The PNG files are the judge: the renderer made them from the same colours by the formulae of sRGB.
#[test]
fn on_a_display_with_the_numbers_of_srgb_the_set_has_the_bytes_of_its_png_files() {
    let folder = tempfile::tempdir().unwrap();
    let render = Command::new(env!("CARGO_BIN_EXE_acuity"))
        .args(["-q", "render", PROTOCOL, "--out"])
        .arg(folder.path())
        .output();
    assert!(render.unwrap().status.success());
    let study = Study::read(Path::new(PROTOCOL)).unwrap();
    let read = || StimulusSet::read(&study, folder.path()).unwrap();
    let png = read();
    let convert = |display: &Display| read().for_display(&study, folder.path(), display).unwrap();

    let (same, lacking) = convert(&Display::Srgb);
    assert!(same.images() == png.images() && lacking.is_empty());

    let (shown, lacking) = convert(&measured([0.64, 0.33], [0.30, 0.60]));
    let mut different = 0;
    for (id, image) in shown.images() {
        let pairs = image.rgb.iter().zip(&png.image(id).unwrap().rgb);
        for (ours, theirs) in pairs {
            assert!(ours.abs_diff(*theirs) <= 1, "{id}");
            different += u32::from(ours != theirs);
        }
    }
    // Values are 32-bit floats in the files: one in a million lies on the edge of two codes.
    assert!(different < 28, "{different} of 8,601,600 bytes");
    let manifest = protocols::Manifest::read(folder.path()).unwrap();
    for entry in &manifest.stimuli {
        let counted = lacking[&entry.id];
        let stated = entry.out_of_gamut_px;
        assert!(
            counted.abs_diff(stated.into()) <= 2,
            "{}: {counted}, {stated}",
            entry.id
        );
    }

    // A wide display (the primaries of Display P3) lacks less, and drives its red less for the same colour.
    let (wide, fewer) = convert(&measured([0.680, 0.320], [0.265, 0.690]));
    assert!(fewer.values().sum::<u64>() < lacking.values().sum::<u64>());
    assert!(wide.images() != png.images());

    // A file that was changed is named.
    let exr = folder.path().join("a050k_c140k.exr");
    let bytes = std::fs::read(&exr).unwrap();
    std::fs::write(&exr, &bytes[..bytes.len() / 2]).unwrap();
    let display = measured([0.64, 0.33], [0.30, 0.60]);
    let error = read().for_display(&study, folder.path(), &display);
    assert!(error.unwrap_err().to_string().contains("a050k_c140k.exr"));
}
