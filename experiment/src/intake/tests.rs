use super::color_plate::Dot;
use super::*;
use crate::common::small_study;
use protocols::matrix3::{self, Matrix3};
use protocols::opponent::{SML_FROM_XYZ, linear_srgb_from_ac1c2, xyz_from_ac1c2};
use protocols::srgb::{srgb_decoded, srgb_encode};
use protocols::{FieldKind, PerChannel};

fn plan() -> SessionPlan {
    let folder = tempfile::tempdir().unwrap();
    let mut plan = small_study(folder.path()).protocol.session;
    plan.consent = Some(ConsentPlan {
        text: "Ratings are kept without names.".to_owned(),
        agree: "Yes".to_owned(),
        decline: "No".to_owned(),
    });
    let field = |key: &str, kind| FormField {
        key: key.to_owned(),
        label: format!("{key}?"),
        kind,
        lowest: Some(18.0).filter(|_| kind == FieldKind::Number),
        highest: None,
        unit: None,
        choices: Vec::new(),
        required: kind == FieldKind::Number,
        identifies: false,
    };
    plan.form = vec![
        field("age", FieldKind::Number),
        field("note", FieldKind::Text),
    ];
    plan.screening = toml::from_str("seed = 3\ngrades = [1.0, 0.35]\nstrokes_px = [4, 1]").ok();
    plan
}

fn intake(before: DoneBefore) -> Intake {
    Intake::new(&plan(), &"S1".parse().unwrap(), 1, before)
}

/// Shows the step and replies a second later.
fn reply(intake: &mut Intake, reply: Reply) -> Option<Finished> {
    intake.shown(10.0);
    intake.reply(reply, 11.0)
}

#[test]
fn consent_then_the_form_then_every_plate_and_letter() {
    let mut intake = intake(DoneBefore::default());
    assert_eq!(intake.step(), Step::Consent);
    assert_eq!(intake.reply(Reply::Agree, 5.0), None, "not shown yet");
    for not_now in [Reply::HandIn, Reply::Digit(Some(1)), Reply::Side(None)] {
        assert_eq!(reply(&mut intake, not_now), None);
        assert_eq!(intake.step(), Step::Consent);
    }
    let version = plan().consent.unwrap().sha256();
    let agreed = reply(&mut intake, Reply::Agree);
    assert_eq!(agreed, Some(Finished::Consent(version)));
    assert_eq!(intake.step(), Step::Form);

    assert_eq!(reply(&mut intake, Reply::HandIn), None);
    assert!(intake.is_at_fault(0) && !intake.is_at_fault(1));
    *intake.answer_mut(0).unwrap() = " 31 ".to_owned();
    assert!(!intake.is_at_fault(0));
    let answers = vec!["31".to_owned(), String::new()];
    let handed_in = reply(&mut intake, Reply::HandIn);
    assert_eq!(handed_in, Some(Finished::Form(answers)));

    let digits: Vec<u8> = intake.plates().iter().map(|plate| plate.digit).collect();
    assert_eq!(digits.len(), 7, "a control, and three axes at two grades");
    for (index, digit) in digits.iter().enumerate() {
        assert_eq!(intake.step(), Step::Plate(index));
        let seen = (index != 2).then_some(*digit);
        assert_eq!(reply(&mut intake, Reply::Digit(seen)), None);
    }
    let sides: Vec<Side> = intake.letters().iter().map(|letter| letter.side).collect();
    assert_eq!(sides.len(), 4);
    for side in &sides[..3] {
        assert_eq!(reply(&mut intake, Reply::Side(Some(*side))), None);
    }
    let Some(Finished::Screening(plates, letters)) = reply(&mut intake, Reply::Side(None)) else {
        panic!("the screening is over");
    };
    assert_eq!(intake.step(), Step::Done);
    assert_eq!(reply(&mut intake, Reply::Leave), None);
    assert_eq!(plates.iter().filter(|answer| answer.is_right()).count(), 6);
    assert!((plates[0].response_time_s - 1.0).abs() < 1e-12);

    let angle = PixelAngle {
        degrees: 0.019,
        is_measured: false,
    };
    let score = ScreeningScore::of(&plates, &letters, angle);
    let control = score.plates[&Axis::Control];
    assert_eq!((control.shown, control.right), (1, 1));
    let right: u32 = Axis::CONFUSED
        .iter()
        .map(|axis| score.plates[axis].right)
        .sum();
    assert_eq!(right, 5);
    assert_eq!((score.letters[0].right, score.letters[1].right), (2, 1));
    // 4 pixels of 0.019 degrees: 4.56 minutes of arc, by hand.
    assert!((score.letters[0].stroke_arcmin - 4.56).abs() < 1e-5);
}

#[test]
fn who_declines_is_asked_nothing_more() {
    let mut intake = intake(DoneBefore::default());
    assert_eq!(reply(&mut intake, Reply::Leave), None);
    assert_eq!(intake.step(), Step::Left);
    assert_eq!(reply(&mut intake, Reply::Agree), None);
    assert_eq!(intake.step(), Step::Left);
}

#[test]
fn what_was_finished_before_is_not_asked_again() {
    let before = DoneBefore {
        has_consent: true,
        has_form: true,
        has_screening: false,
    };
    assert_eq!(intake(before).step(), Step::Plate(0));
    let all = DoneBefore {
        has_screening: true,
        ..before
    };
    assert_eq!(intake(all).step(), Step::Done);
    let mut bare = plan();
    (bare.consent, bare.screening) = (None, None);
    bare.form.clear();
    let intake = Intake::new(&bare, &"S1".parse().unwrap(), 1, DoneBefore::default());
    assert_eq!(intake.step(), Step::Done);
}

#[test]
fn plates_and_letters_are_the_subjects_own_and_the_same_each_time() {
    let of = |subject: &str, session| {
        let subject = subject.parse().unwrap();
        let intake = Intake::new(&plan(), &subject, session, DoneBefore::default());
        let digits: Vec<u8> = intake.plates().iter().map(|plate| plate.digit).collect();
        (digits, intake.letters().to_vec())
    };
    assert_eq!(of("S1", 1), of("S1", 1));
    assert_ne!(of("S1", 1), of("S1", 2));
    assert_ne!(of("S1", 1), of("S2", 1));
}

/// Chromaticities x and y.
fn chromaticity(xyz: [f64; 3]) -> [f64; 2] {
    let sum: f64 = xyz.iter().sum();
    [xyz[0] / sum, xyz[1] / sum]
}

/// The direction from white to a chromaticity, in degrees.
fn direction([x, y]: [f64; 2]) -> f64 {
    (y - 0.3290).atan2(x - 0.3127).to_degrees()
}

#[test]
fn every_color_of_an_axis_lies_on_a_line_through_the_copunctal_point() {
    for axis in Axis::CONFUSED {
        let point = axis.copunctal_point().unwrap();
        for excursion in [-0.05, 0.02, 0.2] {
            let found = chromaticity(xyz_from_ac1c2(axis.color(excursion)));
            let turned = (direction(found) - direction(point)).rem_euclid(180.0);
            assert!(turned.min(180.0 - turned) < 1e-6, "{axis:?}: {turned}");
        }
    }
}

/// Eq. 1 of the paper has confusion points of its own (Estévez 1979): the columns of its inverse.
#[test]
fn the_axes_are_within_five_degrees_of_those_of_eq_1() {
    let xyz_from_sml = matrix3::transpose(&matrix3::inverse(&SML_FROM_XYZ));
    for (axis, cone) in [(Axis::Tritan, 0), (Axis::Deutan, 1), (Axis::Protan, 2)] {
        let theirs = chromaticity(xyz_from_sml[cone]);
        let ours = axis.copunctal_point().unwrap();
        let turned = (direction(ours) - direction(theirs)).rem_euclid(180.0);
        assert!(turned.min(180.0 - turned) < 5.0, "{axis:?}: {turned}");
    }
}

/// Linear RGB to L, M, S (not normalised): Viénot, Brettel & Mollon (1999), Color Res. Appl. 24, 243-252.
const VIENOT_LMS: Matrix3 = [
    [17.8824, 43.5161, 4.11935],
    [3.45565, 27.1554, 3.86714],
    [0.029_956_6, 0.184_309, 1.467_09],
];

/// The picture as a protanope or deuteranope sees it, by the same paper; a tritanope's S tells nothing of its own.
fn seen_by(dichromat: Axis, [l, m, s]: [f64; 3]) -> [f64; 3] {
    match dichromat {
        Axis::Protan => [2.023_44 * m - 2.525_81 * s, m, s],
        Axis::Deutan => [l, 0.494_207 * l + 1.248_27 * s, s],
        Axis::Tritan => [l, m, m],
        Axis::Control => [l, m, s],
    }
}

/// How well digit and ground are told apart: the differences of the logarithms of the cones' signals and of the
/// luminance, each in its standard deviations (an eye that errs by 2% in each cone beside the plate's own noise).
fn d_prime(dots: &[Dot], observer: Axis) -> f64 {
    let signals = |dot: &Dot| {
        let bytes = linear_srgb_from_ac1c2(dot.ac1c2).map(srgb_encode);
        let shown = bytes.map(|byte| srgb_decoded(f64::from(byte) / 255.0));
        let [l, m, s] = seen_by(observer, matrix3::times(&VIENOT_LMS, shown));
        [(l / m).ln(), (s / m).ln(), (l + m).ln()]
    };
    let of = |is_digit| -> Vec<[f64; 3]> {
        let mine = dots.iter().filter(|dot| dot.is_digit == is_digit);
        mine.map(signals).collect()
    };
    let (digit, ground) = (of(true), of(false));
    assert!(
        digit.len() > 30 && ground.len() > 200,
        "{} dots",
        dots.len()
    );
    let moments = |signals: &[[f64; 3]], index: usize| {
        let n = signals.len() as f64;
        let mean = signals.iter().map(|signal| signal[index]).sum::<f64>() / n;
        let squares = signals.iter().map(|signal| (signal[index] - mean).powi(2));
        (mean, squares.sum::<f64>() / n)
    };
    let squares = (0..3).map(|index| {
        let ((mean, variance), (other, _)) = (moments(&ground, index), moments(&digit, index));
        (mean - other).powi(2) / (variance + 2.0 * 0.02_f64.powi(2))
    });
    squares.sum::<f64>().sqrt()
}

#[test]
fn a_dichromat_loses_the_digit_of_his_axis_and_everybody_else_sees_it() {
    for plate in intake(DoneBefore::default()).plates() {
        let dots = plate.dots();
        let seen = |observer| d_prime(&dots, observer);
        let found = [Axis::Control, Axis::Protan, Axis::Deutan, Axis::Tritan].map(seen);
        println!("{:?} {}: {:.2?}", plate.axis, plate.grade, found);
        assert!(found[0] > 2.5, "normal, {plate:?}: {found:?}");
        let [_, protan, deutan, tritan] = found;
        let own = match plate.axis {
            Axis::Protan => protan,
            Axis::Deutan => deutan,
            Axis::Tritan => tritan,
            Axis::Control => {
                assert!(protan.min(deutan).min(tritan) > 2.0, "{found:?}");
                continue;
            }
        };
        assert!(own < 0.35, "{plate:?}: {found:?}");
    }
}

/// The points of Smith & Pokorny (1975) in x', y', carried forward by Vos's published formulae.
#[test]
fn the_copunctal_points_are_those_of_smith_and_pokorny() {
    let published = [
        (Axis::Protan, [0.7465, 0.2535]),
        (Axis::Deutan, [1.4000, -0.4000]),
        (Axis::Tritan, [0.1748, 0.0044]),
    ];
    for (axis, [x_judd, y_judd]) in published {
        let [x, y] = axis.copunctal_point().unwrap();
        let divisor = 0.03845 * x + 0.01496 * y + 1.0;
        let there = (1.0271 * x - 0.00008 * y - 0.00009) / divisor;
        assert!((there - x_judd).abs() < 1e-12, "{axis:?}");
        let there = (0.00376 * x + 1.0072 * y + 0.00764) / divisor;
        assert!((there - y_judd).abs() < 1e-12, "{axis:?}");
    }
}

#[test]
fn every_dot_of_a_plate_can_be_shown_and_none_overlaps_another() {
    for plate in intake(DoneBefore::default()).plates() {
        for dot in plate.dots() {
            let rgb = linear_srgb_from_ac1c2(dot.ac1c2);
            assert!(rgb.iter().all(|value| (-1e-9..=1.0 + 1e-9).contains(value)));
        }
        let image = plate.image();
        let bytes = image.on_grey(128, &crate::Display::Srgb);
        assert_eq!(bytes.len(), 3 * 480 * 480);
        assert_eq!(bytes[..3], [128; 3], "the corner is ground");
        assert!(bytes.chunks_exact(3).any(|rgb| rgb != [128; 3]));
    }
    let _: PerChannel<f64> = Axis::Tritan.color(0.0);
}

/// Writes the plates for people to look at: `ACUITY_PLATES=DIR cargo test -p experiment plates_to_look_at`.
#[test]
fn plates_to_look_at() {
    let Some(folder) = std::env::var_os("ACUITY_PLATES") else {
        return;
    };
    for (index, plate) in intake(DoneBefore::default()).plates().iter().enumerate() {
        let name = format!("{index}-{:?}-{}.png", plate.axis, plate.digit);
        let path = std::path::Path::new(&folder).join(name);
        let bytes = plate.image().on_grey(128, &crate::Display::Srgb);
        image::save_buffer(path, &bytes, 480, 480, image::ExtendedColorType::Rgb8).unwrap();
    }
}
