//! Whether a window manager runs on the X server: without one nobody answers the wish for full screen.

use std::error::Error;

use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{AtomEnum, ConnectionExt as _, Window};
use x11rb::rust_connection::RustConnection;

/// Whether a window manager answers; taken to be there where the X server cannot be asked.
///
/// By Extended Window Manager Hints 1.5: `_NET_SUPPORTING_WM_CHECK` of the root names a window that names itself; one
/// that a dead manager left behind does not.
pub(super) fn is_there() -> bool {
    answers().unwrap_or(true)
}

fn answers() -> Result<bool, Box<dyn Error>> {
    let (connection, screen) = RustConnection::connect(None)?;
    let name = b"_NET_SUPPORTING_WM_CHECK";
    let check = connection.intern_atom(true, name)?.reply()?.atom;
    let named = |window: Window| {
        let kind = AtomEnum::WINDOW;
        let asked = connection.get_property(false, window, check, kind, 0, 1);
        let reply = asked.ok()?.reply().ok()?;
        reply.value32()?.next()
    };
    let root = connection.setup().roots[screen].root;
    let manager = named(root).filter(|&window| named(window) == Some(window));
    Ok(manager.is_some())
}
