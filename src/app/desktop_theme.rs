//! Whether the desktop is light or dark, by its settings portal (`org.freedesktop.appearance`, `color-scheme`).
//!
//! X11 itself has no such setting. Where there is no portal the app is light.

use eframe::egui::Theme;
use zbus::zvariant::{OwnedValue, Value};

/// The theme of the desktop; `None` where it says nothing. It may take as long as the portal takes.
pub(crate) fn desktop_theme() -> Option<Theme> {
    zbus::block_on(ask()).ok().and_then(|scheme| theme(&scheme))
}

async fn ask() -> zbus::Result<OwnedValue> {
    let bus = zbus::Connection::session().await?;
    let reply = bus
        .call_method(
            Some("org.freedesktop.portal.Desktop"),
            "/org/freedesktop/portal/desktop",
            Some("org.freedesktop.portal.Settings"),
            "Read",
            &("org.freedesktop.appearance", "color-scheme"),
        )
        .await?;
    reply.body().deserialize()
}

/// The theme that a colour scheme stands for: 1 is dark, 2 is light, 0 is no preference. `Read` puts the number
/// into a value within a value.
fn theme(scheme: &Value<'_>) -> Option<Theme> {
    match scheme {
        Value::Value(inner) => theme(inner),
        Value::U32(1) => Some(Theme::Dark),
        Value::U32(2) => Some(Theme::Light),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers of the XDG Desktop Portal, interface Settings.
    #[test]
    fn the_portal_s_numbers_are_read_in_any_wrapping() {
        assert_eq!(theme(&Value::U32(1)), Some(Theme::Dark));
        let wrapped = Value::Value(Box::new(Value::Value(Box::new(Value::U32(2)))));
        assert_eq!(theme(&wrapped), Some(Theme::Light));
        assert_eq!(theme(&Value::U32(0)), None);
        assert_eq!(theme(&Value::from("dark")), None);
    }
}
