//! The list of sessions: a line each, with what can be done about it.
//!
//! Files have times in UTC; here they stand in the time of the computer's own zone.

use eframe::egui::{Align, Layout, RichText, TextStyle, TextWrapMode, Ui, vec2};
use experiment::{ListedSession, Standing};
use jiff::Timestamp;
use jiff::tz::TimeZone;

use super::look::{self, Enabled, Palette};
use super::study_state::Mark;

/// What is to be done about a session.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Action {
    /// It goes on.
    Resume(ListedSession),
    /// It is never to go on.
    Close(ListedSession),
}

/// Parts of the width: subject, state, progress, begun; the rest is for what can be done.
const COLUMNS: [f32; 4] = [0.16, 0.32, 0.2, 0.14];
/// The same in a narrow window, which has no room for bars.
const NARROW: [f32; 4] = [0.13, 0.27, 0.11, 0.21];
const NARROW_BELOW: f32 = 900.0;
const LINE: f32 = 40.0;

/// Every session; says what is to be done about one.
pub(crate) fn show(ui: &mut Ui, sessions: &[ListedSession], may_act: Enabled) -> Option<Action> {
    ui.spacing_mut().item_spacing.y = 4.0;
    let width = ui.available_width();
    ui.horizontal(|ui| {
        for (words, part) in ["Subject", "State", "Trials", "Begun"]
            .into_iter()
            .zip(columns(width))
        {
            let words = RichText::new(words).text_style(TextStyle::Small);
            let words = words.color(Palette::of(ui).weak);
            cell(ui, part * width, |ui| {
                ui.label(words);
            });
        }
    });
    let mut action = None;
    for session in sessions {
        look::rule(ui);
        let asked = ui.push_id(&session.ratings_path, |ui| {
            line(ui, session, width, may_act)
        });
        action = asked.inner.or(action);
    }
    action
}

fn cell(ui: &mut Ui, width: f32, add: impl FnOnce(&mut Ui)) {
    let size = vec2(width - ui.spacing().item_spacing.x, LINE - 8.0);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.set_width(size.x);
        ui.style_mut().wrap_mode = Some(TextWrapMode::Truncate);
        add(ui);
    });
}

fn line(ui: &mut Ui, session: &ListedSession, width: f32, may_act: Enabled) -> Option<Action> {
    let [subject, state, progress, begun] = columns(width).map(|part| part * width);
    let (mark, words) = standing(session);
    let mut action = None;
    ui.horizontal(|ui| {
        ui.set_min_height(LINE);
        cell(ui, subject, |ui| {
            ui.label(name(session));
        });
        cell(ui, state, |ui| {
            let response = ui.scope(|ui| look::marked(ui, mark, &words)).response;
            if let Standing::Closed { at, reason } = &session.standing {
                response.on_hover_text(format!("{}: {reason}", local(at).1));
            }
        });
        cell(ui, progress, |ui| {
            if width >= NARROW_BELOW {
                bar(ui, session);
            }
            ui.label(format!("{} of {}", session.rated, session.trials));
        });
        cell(ui, begun, |ui| {
            match session.started_at.as_deref().map(local) {
                Some((minute, whole)) => {
                    let words = RichText::new(minute).color(Palette::of(ui).weak);
                    ui.label(words).on_hover_text(whole);
                }
                None => look::weak(ui, "\u{2013}"),
            }
        });
        if session.standing == Standing::Unfinished {
            action = actions(ui, session, may_act);
        }
    });
    action
}

/// The buttons of a session that is not complete.
fn actions(ui: &mut Ui, session: &ListedSession, may_act: Enabled) -> Option<Action> {
    let subject = &session.subject;
    let mut action = None;
    if session.is_of_this_protocol {
        let resume = look::secondary(ui, may_act, "Resume");
        let resume = resume.accessible_name(format!("Resume subject {subject}"));
        action = resume.clicked().then(|| Action::Resume(session.clone()));
    }
    if session.pilot.is_none() {
        let close = look::secondary(ui, may_act, "Close \u{2026}");
        let close = close.accessible_name(format!("Close subject {subject}"));
        if close.clicked() {
            action = Some(Action::Close(session.clone()));
        }
    }
    action
}

/// `02`, or `02, session 2`.
fn name(session: &ListedSession) -> String {
    let subject = &session.subject;
    match session.session {
        1 => subject.to_string(),
        sitting => format!("{subject}, session {sitting}"),
    }
}

/// The mark and the words of a session.
fn standing(session: &ListedSession) -> (Mark, String) {
    let (mark, mut words) = match &session.standing {
        Standing::Complete => (Mark::Done, "Done".to_owned()),
        Standing::Unfinished => (Mark::Due, "Unfinished".to_owned()),
        Standing::Closed { reason, .. } => (Mark::Later, format!("Excluded: {reason}")),
    };
    if !session.is_of_this_protocol {
        words += ", older protocol";
    }
    match session.pilot {
        None => (mark, words),
        Some(_) => (Mark::Later, format!("Trial run, {}", words.to_lowercase())),
    }
}

fn bar(ui: &mut Ui, session: &ListedSession) {
    let ListedSession { rated, trials, .. } = session;
    let part = *rated as f32 / (*trials).max(1) as f32;
    let name = format!("Subject {}: {rated} of {trials} trials", session.subject);
    look::bar(ui, vec2(70.0, 6.0), part, &name);
}

fn columns(width: f32) -> [f32; 4] {
    if width < NARROW_BELOW {
        NARROW
    } else {
        COLUMNS
    }
}

/// A time of a file (ISO 8601, UTC) in the computer's own zone: in short, and to the second with its zone.
fn local(time: &str) -> (String, String) {
    local_in(time, TimeZone::system())
}

fn local_in(time: &str, zone: TimeZone) -> (String, String) {
    let Ok(timestamp) = time.parse::<Timestamp>() else {
        return (time.to_owned(), time.to_owned());
    };
    let time = timestamp.to_zoned(zone);
    (
        time.strftime("%Y-%m-%d %H:%M").to_string(),
        time.strftime("%Y-%m-%d %H:%M:%S, UTC%:z").to_string(),
    )
}

#[cfg(test)]
mod tests {
    use jiff::tz::Offset;

    use super::*;

    /// Kathmandu is 5 h 45 min ahead of UTC, the Marquesas are 9 h 30 min behind.
    #[test]
    fn times_stand_in_the_zone_of_the_computer() {
        let zone = |minutes: i32| Offset::from_seconds(minutes * 60).unwrap().to_time_zone();
        let time = "2026-12-31T21:10:05.250Z";
        let (minute, whole) = local_in(time, zone(5 * 60 + 45));
        assert_eq!(minute, "2027-01-01 02:55");
        assert_eq!(whole, "2027-01-01 02:55:05, UTC+05:45");
        let (minute, whole) = local_in(time, zone(-(9 * 60 + 30)));
        assert_eq!(minute, "2026-12-31 11:40");
        assert_eq!(whole, "2026-12-31 11:40:05, UTC-09:30");
        assert_eq!(local_in("soon", zone(0)).0, "soon");
    }
}
