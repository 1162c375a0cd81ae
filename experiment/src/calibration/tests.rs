//! Displays whose numbers are known, read by a meter that never errs, or errs by as much as the test says.

use std::path::Path;

use proptest::prelude::*;

use super::*;
use crate::{Display, DisplayColor, MeasuredColor};

const P3: [[f64; 2]; 3] = [[0.680, 0.320], [0.265, 0.690], [0.150, 0.060]];
const D65: [f64; 2] = [0.3127, 0.3290];

/// The luminances of primaries that add up to a white of 1, by Cramer's rule.
fn luminances(primaries: [[f64; 2]; 3], white: [f64; 2]) -> [f64; 3] {
    let xyz = |[x, y]: [f64; 2]| [x / y, 1.0, (1.0 - x - y) / y];
    let columns = primaries.map(xyz);
    let determinant = |c: [[f64; 3]; 3]| {
        c[0][0] * (c[1][1] * c[2][2] - c[1][2] * c[2][1])
            - c[1][0] * (c[0][1] * c[2][2] - c[0][2] * c[2][1])
            + c[2][0] * (c[0][1] * c[1][2] - c[0][2] * c[1][1])
    };
    [0, 1, 2].map(|primary| {
        let mut replaced = columns;
        replaced[primary] = xyz(white);
        determinant(replaced) / determinant(columns)
    })
}

/// What a meter reads on a display with these primaries, curves and black, where white has 100 cd/m² above black.
fn read(curves: &[impl Fn(f64) -> f64; 3], black_cd_m2: f64) -> Calibration {
    let luminances = luminances(P3, D65);
    let reading = |patch: Patch| {
        let mut xyz = [0.95 * black_cd_m2, black_cd_m2, 1.2 * black_cd_m2];
        for (primary, curve) in curves.iter().enumerate() {
            let light = curve(f64::from(patch.codes[primary]) / 255.0);
            let luminance = 100.0 * light * luminances[primary];
            let [x, y] = P3[primary];
            xyz[0] += x / y * luminance;
            xyz[1] += luminance;
            xyz[2] += (1.0 - x - y) / y * luminance;
        }
        Reading::of(patch, xyz)
    };
    Calibration {
        readings: Patch::all().into_iter().map(reading).collect(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]

    #[test]
    fn the_numbers_of_any_display_come_back(
        gammas in prop::array::uniform3(1.4..3.2_f64),
        gains in prop::array::uniform3(0.9..1.08_f64),
        black in 0.0..2.0_f64,
    ) {
        let curve = |primary: usize| {
            let (gain, gamma) = (gains[primary], gammas[primary]);
            move |drive: f64| {
                let signal = |drive: f64| (gain * drive + 1.0 - gain).max(0.0).powf(gamma);
                (signal(drive) - signal(0.0)) / (1.0 - signal(0.0))
            }
        };
        let fit = read(&[curve(0), curve(1), curve(2)], black).fit().unwrap();
        for (primary, curve) in fit.curves.iter().enumerate() {
            prop_assert!((curve.gamma - gammas[primary]).abs() < 1e-3, "{curve:?} {gammas:?}");
            prop_assert!((curve.gain - gains[primary]).abs() < 1e-3, "{curve:?} {gains:?}");
        }
        prop_assert!(fit.worst_luminance() < 1e-4);
        prop_assert!(fit.additivity.abs() < 1e-9 && fit.additivity_uv < 1e-9);
        let worst_uv = fit.residuals.iter().filter_map(|residual| residual.delta_uv).fold(0.0, f64::max);
        prop_assert!(worst_uv < 1e-3, "{worst_uv}");
    }
}

/// The same display typed by its numbers is driven by the same codes.
#[test]
fn readings_drive_a_display_as_its_typed_numbers_do() {
    let curve = |drive: f64| drive.powf(2.2);
    let readings = read(&[curve; 3], 0.3);
    let path = Path::new("station.toml");
    let calibrated = DisplayColor::Calibrated(readings).display(path).unwrap();
    let typed = DisplayColor::Measured(MeasuredColor {
        red: P3[0],
        green: P3[1],
        blue: P3[2],
        white: D65,
        gamma: Some(2.2),
    });
    let typed = typed.display(path).unwrap();
    for code in (0..=255).step_by(3) {
        for rgb in [[code; 3], [code, 200, 30], [30, code, 200]] {
            let color = crate::display::ac1c2_of_srgb(rgb);
            let pairs = calibrated
                .shown(color)
                .0
                .into_iter()
                .zip(typed.shown(color).0);
            for (one, other) in pairs {
                assert!(one.abs_diff(other) <= 1, "{rgb:?}: {one} {other}");
            }
        }
    }
}

/// The curve of sRGB is no power; the model must still be within a fifth of a percent of white.
#[test]
fn the_curve_of_srgb_is_met_within_a_fifth_of_a_percent() {
    let fit = read(&[protocols::srgb::srgb_decoded; 3], 0.1)
        .fit()
        .unwrap();
    assert!(fit.worst_luminance() < 2e-3, "{}", fit.worst_luminance());
    let Display::Characterised(display) = Display::Characterised(Box::new(fit.display())) else {
        unreachable!()
    };
    let grey = Display::Characterised(display).grey(128);
    assert!(grey.iter().all(|code| code.abs_diff(128) <= 1), "{grey:?}");
}

#[test]
fn a_display_whose_white_is_brighter_than_its_primaries_is_told() {
    let mut readings = read(&[|drive: f64| drive.powf(2.2); 3], 0.0);
    for reading in &mut readings.readings {
        let codes = reading.patch.codes;
        if codes[0] == codes[1] && codes[1] == codes[2] {
            reading.luminance_cd_m2 *= 1.25;
        }
    }
    let fit = readings.fit().unwrap();
    assert!((fit.additivity + 0.2).abs() < 1e-9, "{}", fit.additivity);
    assert!(fit.additivity_uv < 1e-9);
    let red = fit
        .residuals
        .iter()
        .find(|residual| residual.patch == Patch::PRIMARIES[0]);
    let red_cd_m2 = readings
        .reading(Patch::PRIMARIES[0])
        .unwrap()
        .luminance_cd_m2;
    // The model makes red a quarter brighter than it was read; white is 125.
    let expected = 0.25 * red_cd_m2 / 125.0;
    assert!((red.unwrap().luminance_part - expected).abs() < 1e-9);
}

#[test]
fn one_wrong_reading_stands_out_among_the_residuals() {
    let mut readings = read(&[|drive: f64| drive.powf(2.2); 3], 0.0);
    let wrong = Patch { codes: [128; 3] };
    let reading = readings
        .readings
        .iter_mut()
        .find(|reading| reading.patch == wrong);
    reading.unwrap().luminance_cd_m2 *= 1.3;
    let fit = readings.fit().unwrap();
    let worst = fit.residuals.iter().max_by(|one, other| {
        one.luminance_part
            .abs()
            .total_cmp(&other.luminance_part.abs())
    });
    assert_eq!(worst.unwrap().patch, wrong);
    assert!(fit.worst_luminance() > 0.02);
}

#[test]
fn readings_that_are_no_displays_are_refused_by_name() {
    let whole = read(&[|drive: f64| drive.powf(2.2); 3], 0.2);
    let fault = |change: &dyn Fn(&mut Vec<Reading>)| {
        let mut readings = whole.clone();
        change(&mut readings.readings);
        readings.fit().unwrap_err()
    };
    let place = |readings: &[Reading], patch: Patch| {
        readings
            .iter()
            .position(|reading| reading.patch == patch)
            .unwrap()
    };
    let missing = fault(&|readings| {
        let black = place(readings, Patch::BLACK);
        readings.remove(black);
    });
    assert_eq!(missing, "black was not read");
    let twice = fault(&|readings| readings.push(readings[0]));
    assert_eq!(twice, "white was read more than once");
    let impossible = fault(&|readings| readings[2].y = 1.4);
    assert!(impossible.starts_with("green:"), "{impossible}");
    let dark = fault(&|readings| {
        let grey = place(readings, Patch { codes: [32; 3] });
        readings[grey].luminance_cd_m2 = 0.1;
    });
    assert!(dark.starts_with("grey 32:"), "{dark}");
    let mixed_up = fault(&|readings| {
        let red = readings[1];
        readings[1] = Reading {
            patch: red.patch,
            ..readings[2]
        };
    });
    assert!(mixed_up.contains("mixed up"), "{mixed_up}");
    let error = DisplayColor::Calibrated(Calibration::default())
        .display(Path::new("station.toml"))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("station.toml") && error.contains("white was not read"),
        "{error}"
    );
}
