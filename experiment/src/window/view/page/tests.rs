//! The page as the experimenter meets it: by the names of its widgets.

use std::cell::RefCell;
use std::rc::Rc;

use eframe::egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;
use crate::window::by_name::ByName as _;

struct View {
    harness: Harness<'static>,
    page: Rc<RefCell<ViewPage>>,
    orders: Rc<RefCell<Vec<Order>>>,
}

fn view(glance: Glance) -> View {
    let page = Rc::new(RefCell::new(ViewPage::default()));
    page.borrow_mut().see(glance, 0.0);
    let orders = Rc::new(RefCell::new(Vec::new()));
    let (inner, told) = (Rc::clone(&page), Rc::clone(&orders));
    let harness = Harness::builder()
        .with_size(vec2(760.0, 620.0))
        .build_ui(move |ui| {
            desk::dress(ui.ctx());
            let order = inner.borrow_mut().show(ui, 1.0);
            told.borrow_mut().extend(order);
        });
    View {
        harness,
        page,
        orders,
    }
}

fn glance() -> Glance {
    Glance {
        title: "meyerliu1992, subject S1, session 1".to_owned(),
        screen: "sees the image between its anchors".to_owned(),
        stimulus: Some("a070k_c140k".to_owned()),
        trial: [5, 30],
        screen_left_s: Some(7.4),
        session_left_s: Some(301.0),
        ratings: vec![0, 10, 4, 6],
        scale: [0, 10],
        missed_frames: 3,
        ..Glance::default()
    }
}

#[test]
fn the_trial_the_image_the_time_and_the_ratings_are_there() {
    let view = view(glance());
    assert!(view.harness.has("Trial 5 of 30") && view.harness.has("a070k_c140k"));
    // 7.4 s were left a second ago; 301 s of the session.
    assert!(
        view.harness
            .has("sees the image between its anchors, 6 s left")
    );
    assert!(view.harness.has("about 5 min") && view.harness.has("ratings so far: [0, 10, 4, 6]"));
    assert!(!view.harness.has("PILOT"));
}

#[test]
fn pause_becomes_resume_while_the_session_rests() {
    let mut view = view(glance());
    view.harness.click_on("Pause");
    let resting = Glance {
        is_resting: true,
        pilot: Some(20.0),
        ..glance()
    };
    view.page.borrow_mut().see(resting, 0.0);
    view.harness.run_steps(2);
    assert!(view.harness.has("PILOT, times 20"));
    view.harness.click_on("Resume");
    assert_eq!(*view.orders.borrow(), [Order::Pause, Order::Resume]);
}

#[test]
fn stopping_is_asked_first() {
    let mut view = view(glance());
    view.harness.click_on("Stop the session...");
    view.harness.click_on("Go on");
    assert!(view.orders.borrow().is_empty());
    view.harness.click_on("Stop the session...");
    view.harness.click_on("Stop now");
    assert_eq!(*view.orders.borrow(), [Order::Stop]);
}

#[test]
fn a_note_is_sent_once_and_stays_to_be_seen() {
    let mut view = view(glance());
    view.harness.click_on("Add note");
    assert!(view.orders.borrow().is_empty(), "an empty note");
    let field = view.harness.get_by_role(egui::Role::TextInput);
    field.focus();
    view.harness.run_steps(2);
    view.harness
        .get_by_role(egui::Role::TextInput)
        .type_text("coughs");
    view.harness.run_steps(2);
    view.harness.key_press(egui::Key::Enter);
    view.harness.run_steps(3);
    assert_eq!(*view.orders.borrow(), [Order::Note("coughs".to_owned())]);
    assert!(view.harness.has("noted: coughs"));
}
