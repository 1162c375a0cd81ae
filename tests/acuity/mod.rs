//! Runs the program as a user would.

use std::path::Path;
use std::process::{Command, Output};

/// The paper's protocol.
pub(crate) const PROTOCOL: &str =
    concat!(env!("CARGO_MANIFEST_DIR"), "/protocols/meyer-liu-1992.toml");

/// Runs `acuity` with `arguments` in `folder`, without a display.
pub(crate) fn acuity(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_acuity"));
    command
        .current_dir(folder)
        .args(arguments)
        .env_remove("DISPLAY")
        // No station of the person who runs the tests.
        .env("XDG_CONFIG_HOME", folder);
    command.output().expect("the program starts")
}

/// What was printed on stderr.
pub(crate) fn stderr(output: &Output) -> String {
    text_of(&output.stderr)
}

/// Printed bytes as text.
pub(crate) fn text_of(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("the program prints UTF-8")
}
