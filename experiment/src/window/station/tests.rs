//! The pages as an experimenter or a screen reader meets them: by the names of their widgets.

use std::cell::RefCell;

use eframe::egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::*;
use crate::color_draft::ColorSource;
use crate::common::small_study;
use crate::window::by_name::ByName as _;
use crate::{DisplayColor, Patch};

struct Window {
    harness: Harness<'static>,
    pages: Rc<RefCell<Pages>>,
    wishes: Rc<RefCell<Vec<Wish>>>,
}

fn window() -> Window {
    let folder = tempfile::tempdir().unwrap();
    let mut study = small_study(folder.path());
    study.protocol.session.viewing_tolerance = Some(0.02);
    let mut pages = Pages::new(StationDraft::new(&study, None));
    pages.monitors = vec!["DP-1".to_owned(), "HDMI-1".to_owned()];
    pages.draft.stand_on(ScreenFacts {
        name: Some("DP-1".to_owned()),
        size_px: [1920, 1080],
        nominal_hz: Some(60.0),
        one_to_one: None,
    });
    let pages = Rc::new(RefCell::new(pages));
    let wishes = Rc::new(RefCell::new(Vec::new()));
    let (inner, told) = (Rc::clone(&pages), Rc::clone(&wishes));
    let mut frames = 0;
    let harness = Harness::builder()
        .with_size(vec2(1700.0, 960.0))
        .build_ui(move |ui| {
            frames += 1;
            desk::dress(ui.ctx());
            let wish = inner.borrow_mut().show(ui, f64::from(frames) / 60.0);
            told.borrow_mut().extend(wish);
        });
    Window {
        harness,
        pages,
        wishes,
    }
}

#[test]
fn the_outline_grows_by_the_arrow_keys_and_nothing_is_saved_before() {
    let mut window = window();
    assert!(window.harness.has("Not measured yet"));
    window.harness.click_on("Save and close");
    assert!(window.wishes.borrow().is_empty());
    window.harness.click_on("outline of a bank card");
    for _ in 0..12 {
        window.harness.key_press(Key::ArrowLeft);
        window.harness.run_steps(1);
    }
    assert_eq!(window.pages.borrow().draft.card_px(), 312.0);
    window
        .harness
        .key_press_modifiers(egui::Modifiers::SHIFT, Key::ArrowUp);
    window.harness.run_steps(2);
    assert_eq!(window.pages.borrow().draft.card_px(), 322.0);
    // 85.60 mm / 322 = 0.2658 mm.
    assert!(window.harness.has("0.2658 mm"));
    window.harness.click_on("HDMI-1");
    window.harness.click_on("Save and close");
    let wishes = window.wishes.borrow();
    let [Wish::Monitor(1), Wish::Save(station)] = wishes.as_slice() else {
        panic!("{wishes:?}");
    };
    assert!((station.pixel_pitch_mm() - 85.60 / 322.0).abs() < 1e-5);
    assert_eq!(station.color, DisplayColor::Srgb);
}

#[test]
fn the_distance_follows_from_the_screen_and_says_whether_it_will_do() {
    let mut window = window();
    window.harness.click_on("2  Distance");
    assert!(window.harness.has("First measure the screen"));
    window.pages.borrow_mut().draft.set_card_px(85.60 / 0.2745);
    window.harness.run_steps(2);
    // 0.02745 / tan(0.019 degrees) = 82.78 cm (bc -l).
    assert!(
        window.harness.has("82.8 cm")
            && window.harness.has("Within the protocol's tolerance of 2 %")
    );
    window.pages.borrow_mut().draft.distance_typed = "60".to_owned();
    window.harness.run_steps(2);
    assert!(window.harness.has("Outside the protocol's tolerance"));
}

#[test]
fn three_hundred_frames_are_timed() {
    let mut window = window();
    window.harness.click_on("3  Refresh");
    window.harness.run_steps(305);
    assert!(
        window.harness.has("16.667 ms (60.00 Hz)")
            && window.harness.has("Locked to the display's refresh.")
    );
}

/// The readings are an sRGB display's at 100 cd/m² (D65; Y of the primaries .2126, .7152, .0722).
#[test]
fn patches_fill_the_screen_and_take_readings() {
    let mut window = window();
    window.harness.click_on("4  Colour");
    window.harness.click_on("read patch by patch");
    window
        .harness
        .click_on("Show the patches on the whole screen");
    assert!(window.harness.has("white (1 of 12)") && window.harness.has("100.00  0.3127  0.3290"));
    window.harness.click_on("Next");
    assert!(window.harness.has("red (2 of 12)") && window.harness.has("21.26  0.6400  0.3300"));
    let field = window
        .harness
        .get_by_role_and_label(egui::Role::TextInput, "Y (cd/m2)");
    field.focus();
    window.harness.run_steps(2);
    let field = window
        .harness
        .get_by_role_and_label(egui::Role::TextInput, "Y (cd/m2)");
    field.type_text("21.3");
    window.harness.run_steps(2);
    {
        let pages = window.pages.borrow();
        let (patch, fields) = &pages.draft.color.readings[1];
        assert_eq!((*patch, fields[0].as_str()), (Patch::PRIMARIES[0], "21.3"));
    }
    window.harness.click_on("Close");
    assert!(
        window.harness.has("What colours does the display give?")
            && window.harness.has("white is not read yet")
    );
}

#[test]
fn a_bare_patch_has_no_words_until_a_key() {
    let mut window = window();
    window.harness.click_on("4  Colour");
    window
        .harness
        .click_on("Show the patches on the whole screen");
    window.harness.click_on("Hide this strip");
    assert!(!window.harness.has("white (1 of 12)"));
    window.harness.key_press(Key::Space);
    window.harness.run_steps(3);
    assert!(window.harness.has("white (1 of 12)"));
    for _ in 0..12 {
        window.harness.key_press(Key::PageDown);
        window.harness.run_steps(2);
    }
    assert!(window.harness.has("What colours does the display give?"));
}

#[test]
fn the_room_is_compared_with_the_advice() {
    let mut window = window();
    {
        let draft = &mut window.pages.borrow_mut().draft;
        draft.peak_typed = "400".to_owned();
        draft.background_typed = "100".to_owned();
        draft.room_typed = "15".to_owned();
    }
    window.harness.click_on("5  Room");
    assert!(window.harness.has("outside the advice of BT.500"));
    assert!(window.harness.has("25 % of the peak, above the advice"));
    assert!(window.harness.has("A room of 15 lx is within"));
}

#[test]
fn closing_without_saving_is_asked() {
    let mut window = window();
    window.harness.key_press(Key::Escape);
    window.harness.run_steps(2);
    window.harness.click_on("Go on");
    assert!(window.wishes.borrow().is_empty());
    window.harness.click_on("Close");
    window.harness.click_on("Close without saving");
    assert_eq!(*window.wishes.borrow(), [Wish::Close]);
    assert_eq!(
        window.pages.borrow().draft.color.source,
        ColorSource::Declared
    );
}

#[test]
fn a_screen_that_is_not_shown_one_to_one_is_named_and_may_be_explained() {
    let mut window = window();
    assert!(window.harness.has("The X server does not say"));
    let mut screen = window.pages.borrow().draft.screen().clone();
    for (may_be_right, words) in [(false, "scaled"), (true, "its own 3840 x 2160")] {
        screen.one_to_one = Some(Err(ModeFault {
            words: words.to_owned(),
            may_be_right,
        }));
        window.pages.borrow_mut().draft.stand_on(screen.clone());
        window.harness.run_steps(2);
        assert!(
            window
                .harness
                .has(&format!("No session starts like this: {words}"))
        );
        assert_eq!(window.harness.has("why it is right"), may_be_right);
    }
    screen.one_to_one = Some(Ok(()));
    window.pages.borrow_mut().draft.stand_on(screen);
    window.harness.run_steps(2);
    assert!(
        window
            .harness
            .has("The monitor runs at its own resolution.")
    );
}

/// Roles that a hand works.
const CONTROLS: [egui::Role; 5] = [
    egui::Role::Button,
    egui::Role::CheckBox,
    egui::Role::RadioButton,
    egui::Role::Slider,
    egui::Role::TextInput,
];

/// The names of the controls of the page that may be used now; each control must have one, and no other the same.
fn controls(harness: &Harness<'_>, page: &str) -> Vec<String> {
    let nodes = harness.root().children_recursive();
    let controls = nodes.filter(|node| CONTROLS.contains(&node.accesskit_node().role()));
    let mut names: Vec<String> = Vec::new();
    let mut enabled = Vec::new();
    for node in controls.map(|node| node.accesskit_node()) {
        let name = node.label().unwrap_or_default();
        assert!(!name.trim().is_empty(), "a control of {page} has no name");
        assert!(!names.contains(&name), "{page}: two are {name:?}");
        enabled.extend((!node.is_disabled()).then(|| name.clone()));
        names.push(name);
    }
    enabled
}

fn focused(harness: &Harness<'_>) -> String {
    let mut nodes = harness.root().children_recursive();
    let node = nodes.find(egui_kittest::Node::is_focused);
    node.and_then(|node| node.accesskit_node().label())
        .unwrap_or_default()
}

#[test]
fn every_control_has_a_name_of_its_own_and_tab_leads_to_it() {
    let mut window = window();
    window.pages.borrow_mut().draft.set_card_px(312.0);
    let check = |window: &mut Window, page: &str| {
        let mut missing = controls(&window.harness, page);
        assert!(missing.len() > 5, "{page}: {missing:?}");
        for _ in 0..2 * missing.len() {
            window.harness.key_press(Key::Tab);
            window.harness.run_steps(2);
            let found = focused(&window.harness);
            missing.retain(|name| *name != found);
        }
        assert!(missing.is_empty(), "{page}: no Tab leads to {missing:?}");
    };
    for page in [
        "1  Screen",
        "2  Distance",
        "3  Refresh",
        "4  Colour",
        "5  Room",
    ] {
        window.harness.click_on(page);
        check(&mut window, page);
    }
    window.harness.click_on("4  Colour");
    for source in ["typed numbers", "ICC profile", "read patch by patch"] {
        window.harness.click_on(source);
        check(&mut window, source);
    }
    window
        .harness
        .click_on("Show the patches on the whole screen");
    check(&mut window, "patches");
}

#[test]
fn a_station_is_measured_and_saved_by_the_keyboard_alone() {
    let mut window = window();
    let tab_to = |window: &mut Window, name: &str| {
        for _ in 0..30 {
            window.harness.key_press(Key::Tab);
            window.harness.run_steps(2);
            if focused(&window.harness) == name {
                return;
            }
        }
        panic!("no Tab leads to {name:?}");
    };
    tab_to(&mut window, "outline of a bank card");
    for _ in 0..12 {
        window.harness.key_press(Key::ArrowLeft);
        window.harness.run_steps(1);
    }
    tab_to(&mut window, "Save and close");
    window.harness.key_press(Key::Enter);
    window.harness.run_steps(2);
    let wishes = window.wishes.borrow();
    let [Wish::Save(station)] = wishes.as_slice() else {
        panic!("{wishes:?}");
    };
    // 85.60 mm / 312 pixels.
    assert!((station.pixel_pitch_mm() - 0.274_36).abs() < 1e-5);
}
