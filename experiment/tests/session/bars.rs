//! What counts as an answer by the bars of a continuous scale.

use experiment::{Button, Event, First, Key};

use crate::screening::pair;

#[test]
fn bars_are_entered_only_when_every_one_is_marked_and_none_is_to_begin_with() {
    let mut screening = pair(First::Test);
    screening.until_scale();
    assert_eq!(screening.session.response().marks(), [None, None]);
    screening.click(Button::Continue);
    screening.key(Key::Up);
    screening.click(Button::Bar(1, 55));
    screening.click(Button::Continue);
    screening.key(Key::Enter);
    assert_eq!(screening.session.to_save(), None);
    assert_eq!(screening.session.response().marks(), [None, Some(55)]);
    screening.click(Button::Bar(0, 101));
    assert_eq!(screening.session.response().marks(), [None, Some(55)]);
    screening.click(Button::Bar(0, 100));
    screening.click(Button::Continue);
    let answer = screening.session.to_save().unwrap();
    assert_eq!((answer.rating, answer.reference_rating), (100, Some(55)));
}

#[test]
fn a_mark_follows_the_pointer_while_it_is_held_and_only_on_its_own_bar() {
    let mut screening = pair(First::Test);
    screening.until_scale();
    screening.on(Event::Press(Some(Button::Bar(0, 10))));
    screening.on(Event::Drag(Some(Button::Bar(0, 20))));
    screening.on(Event::Drag(Some(Button::Bar(1, 60))));
    screening.on(Event::Drag(None));
    screening.on(Event::Release(None));
    screening.on(Event::Drag(Some(Button::Bar(0, 70))));
    assert_eq!(screening.session.response().marks(), [Some(20), None]);
}

#[test]
fn bars_can_be_marked_by_keys_alone() {
    let mut screening = pair(First::Test);
    screening.until_scale();
    screening.type_all("42");
    screening.key(Key::Enter);
    screening.type_all("7");
    screening.key(Key::Enter);
    screening.key(Key::Down);
    screening.key(Key::Tab);
    screening.key(Key::Up);
    assert_eq!(screening.session.response().marks(), [Some(43), Some(6)]);
    screening.key(Key::Enter);
    let answer = screening.session.to_save().unwrap();
    assert_eq!((answer.rating, answer.reference_rating), (43, Some(6)));
}
