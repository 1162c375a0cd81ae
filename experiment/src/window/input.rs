//! What the subject does, as events of the session.

use eframe::egui::{self, PointerButton};

use protocols::SessionPlan;

use super::geometry::Geometry;
use crate::{Event, Key, Screen};

/// The events of this frame, in their order. Repeats of a held key, releases of keys and all buttons of
/// the mouse but the first are no events.
pub(crate) fn events(
    context: &egui::Context,
    geometry: Geometry,
    screen: Screen,
    plan: &SessionPlan,
) -> Vec<Event> {
    context.input(|input| {
        let events = input.events.iter();
        events
            .filter_map(|event| session_event(event, geometry, screen, plan))
            .collect()
    })
}

fn session_event(
    event: &egui::Event,
    geometry: Geometry,
    screen: Screen,
    plan: &SessionPlan,
) -> Option<Event> {
    match event {
        egui::Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            ..
        } => {
            let button = geometry.button_at(screen, plan, *pos);
            Some(if *pressed {
                Event::Press(button)
            } else {
                Event::Release(button)
            })
        }
        egui::Event::PointerMoved(pos) => {
            let button = geometry.button_at(screen, plan, *pos);
            Some(Event::Drag(button))
        }
        egui::Event::Key {
            key: key @ (egui::Key::ArrowUp | egui::Key::ArrowDown),
            pressed: true,
            ..
        } => Some(Event::Key(if *key == egui::Key::ArrowUp {
            Key::Up
        } else {
            Key::Down
        })),
        egui::Event::Key {
            key,
            pressed: true,
            repeat: false,
            ..
        } => {
            let key = match key {
                egui::Key::Tab => Key::Tab,
                egui::Key::P => Key::Pause,
                egui::Key::Enter => Key::Enter,
                egui::Key::Escape => Key::Escape,
                egui::Key::Backspace => Key::Backspace,
                _ => return character(*key).map(|character| Event::Key(Key::Character(character))),
            };
            Some(Event::Key(key))
        }
        _ => None,
    }
}

/// The characters that a session takes: digits, minus and space.
fn character(key: egui::Key) -> Option<char> {
    match key {
        egui::Key::Space => Some(' '),
        egui::Key::Minus => Some('-'),
        _ => {
            let mut name = key.name().chars();
            let first = name.next().filter(char::is_ascii_digit)?;
            name.next().is_none().then_some(first)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_digit_keys_are_digits_and_the_function_keys_are_not() {
        assert_eq!(character(egui::Key::Num0), Some('0'));
        assert_eq!(character(egui::Key::Num9), Some('9'));
        assert_eq!(character(egui::Key::Minus), Some('-'));
        assert_eq!(character(egui::Key::F1), None);
        assert_eq!(character(egui::Key::A), None);
    }
}
