//! Tests: the subject's screens are the same on every desktop, and their ground is the protocol's mid-grey.
//!
//! What is compared is everything that is painted, shape by shape, under egui's dark and its light theme.

use eframe::egui::{Color32, Context, RawInput, Rect, Shape, Theme, Ui, pos2, vec2};

use super::geometry::Geometry;
use super::intake_page::{IntakePage, Looks};
use super::paint::{Brush, Pictures};
use crate::common::{small_study, write_stimuli};
use crate::{
    Display, DoneBefore, Event, Intake, Key, Reply, Rules, Screen, Session, Step, StimulusSet,
    trials,
};

const SIZE: [f32; 2] = [1280.0, 1024.0];
const MID_GREY: Color32 = Color32::from_gray(128);

fn geometry() -> Geometry {
    Geometry {
        size_px: SIZE.into(),
        pixels_per_point: 1.0,
    }
}

/// What the second of two frames paints.
fn painted(context: &Context, theme: Theme, mut draw: impl FnMut(&mut Ui)) -> Vec<Shape> {
    context.set_theme(theme);
    let input = || RawInput {
        screen_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), SIZE.into())),
        ..RawInput::default()
    };
    drop(context.run_ui(input(), &mut draw));
    let output = context.run_ui(input(), &mut draw);
    let shapes = output.shapes.into_iter();
    shapes.map(|clipped| clipped.shape).collect()
}

/// Draws under both themes and compares; gives what was painted.
fn same_in_both(mut draw: impl FnMut(&Context, Theme) -> Vec<Shape>) -> Vec<Shape> {
    let [dark, light] = [Theme::Dark, Theme::Light].map(|theme| {
        let context = Context::default();
        draw(&context, theme)
    });
    assert!(!dark.is_empty());
    assert!(dark == light, "the themes differ");
    dark
}

/// The first thing that is painted fills the screen with the grey of the protocol.
fn has_mid_grey_ground(shapes: &[Shape]) -> bool {
    let is_fill = |shape: &Shape| match shape {
        Shape::Rect(rect) => rect.fill == MID_GREY && rect.rect.size() == vec2(SIZE[0], SIZE[1]),
        _ => false,
    };
    shapes
        .iter()
        .find(|shape| **shape != Shape::Noop)
        .is_some_and(is_fill)
}

#[test]
fn every_screen_of_a_session_is_mid_grey_and_the_same_in_both_themes() {
    let folder = tempfile::tempdir().unwrap();
    let study = small_study(folder.path());
    let stimuli = write_stimuli(&study, folder.path());
    let plan = &study.protocol.session;
    let mut session = Session::new(
        trials(&study, &"01".parse().unwrap(), 1).unwrap(),
        0,
        Rules::of(plan),
    );
    let mut seen = Vec::new();
    for frame in 0..400 {
        let at_s = f64::from(frame) / 60.0;
        session.on(Event::Frame, at_s);
        let screen = session.screen();
        if seen.contains(&std::mem::discriminant(&screen)) {
            if frame % 7 == 0 && !matches!(screen, Screen::Exposure(..) | Screen::Blank) {
                session.on(Event::Key(Key::Enter), at_s);
                session.on(Event::Key(Key::Character('7')), at_s);
                session.on(Event::Key(Key::Enter), at_s);
                session.on(Event::Saved, at_s);
            }
            if seen.len() == 4 {
                session.on(Event::Key(Key::Escape), at_s);
            }
            continue;
        }
        seen.push(std::mem::discriminant(&screen));
        let shapes = same_in_both(|context, theme| {
            let set = StimulusSet::read(&study, &stimuli).unwrap();
            let pictures = Pictures::upload(context, set, &study.protocol.stimuli);
            painted(context, theme, |ui| {
                let brush = Brush {
                    painter: ui.painter(),
                    geometry: geometry(),
                    plan,
                    ground: MID_GREY,
                    pointer: None,
                };
                brush.background();
                brush.screen(&session, &pictures);
                brush.pilot(20.0);
            })
        });
        assert!(has_mid_grey_ground(&shapes), "{screen:?}");
    }
    // Instructions, a blank, an exposure, the scale, and the question after Escape.
    assert!(seen.len() >= 5, "{} screens", seen.len());
    assert_eq!(plan.background_srgb, 128);
}

#[test]
fn every_page_before_the_first_trial_is_the_same_in_both_themes() {
    let folder = tempfile::tempdir().unwrap();
    let mut plan = small_study(folder.path()).protocol.session;
    plan.consent = toml::from_str("text = \"You may stop at any time.\"").ok();
    let age = "key = \"age\"\nlabel = \"How old are you?\"\nkind = \"number\"\nlowest = 18";
    let eyes =
        "key = \"eyes\"\nlabel = \"Glasses?\"\nkind = \"choice\"\nchoices = [\"yes\", \"no\"]";
    plan.form = [age, eyes].map(|text| toml::from_str(text).unwrap()).into();
    plan.screening = toml::from_str("seed = 5\ngrades = [1.0]\nstrokes_px = [3]").ok();
    for (before, step) in [
        ([false, false], Step::Consent),
        ([true, false], Step::Form),
        ([true, true], Step::Plate(0)),
    ] {
        let [has_consent, has_form] = before;
        let before = DoneBefore {
            has_consent,
            has_form,
            has_screening: false,
        };
        let shapes = same_in_both(|context, theme| {
            let mut intake = Intake::new(&plan, &"S1".parse().unwrap(), 1, before);
            assert_eq!(intake.step(), step);
            let mut page = IntakePage::default();
            let looks = Looks {
                plan: &plan,
                geometry: geometry(),
                display: &Display::Srgb,
            };
            painted(context, theme, |ui| {
                let reply: Option<Reply> = page.show(ui, &looks, &mut intake);
                assert!(reply.is_none());
            })
        });
        assert!(shapes.len() > 2, "{step:?}");
    }
}
