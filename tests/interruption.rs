//! Ctrl-C from outside: exit code 130, a checkpoint, and the same bytes when the command is given again.

#![cfg(target_os = "linux")]
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod acuity;

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use acuity::{PROTOCOL, acuity, stderr};
use protocols::Study;

/// The paper's scene.
fn scene() -> String {
    let path = Study::read(Path::new(PROTOCOL))
        .unwrap()
        .scene_path()
        .unwrap();
    path.into_os_string().into_string().unwrap()
}

/// Begins an image that takes seconds.
fn begin(folder: &Path, rays: &str) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_acuity"));
    command.current_dir(folder).stderr(Stdio::piped());
    command.stdout(Stdio::piped());
    command.args(["image", &scene(), "--rays-a", rays, "--rays-c1c2", rays]);
    command
        .args(["--threads", "1", "-o", "x.exr"])
        .spawn()
        .unwrap()
}

fn signal(child: &Child, name: &str) {
    let pid = child.id().to_string();
    let sent = Command::new("kill").args(["-s", name, &pid]).status();
    assert!(sent.unwrap().success());
}

/// Waits until the program has worked for 0.3 s: long enough to be tracing, however busy the machine is.
fn wait_until_busy(child: &Child) {
    let stat = format!("/proc/{}/stat", child.id());
    loop {
        let text = fs::read_to_string(&stat).unwrap();
        // proc(5): after the name in parentheses, field 14 is the user time in hundredths of a second.
        let ticks = text.rsplit(')').next().unwrap().split_whitespace().nth(11);
        if ticks.unwrap().parse::<u32>().unwrap() >= 30 {
            return;
        }
        sleep(Duration::from_millis(5));
    }
}

/// The samples in the checkpoint, by its first line.
fn samples(folder: &Path) -> u64 {
    let bytes = fs::read(folder.join("x.exr.checkpoint")).unwrap();
    let line = bytes.split(|&byte| byte == b'\n').next().unwrap();
    let header: serde_json::Value = serde_json::from_slice(line).unwrap();
    header["samples"].as_u64().unwrap()
}

#[test]
fn an_image_that_was_interrupted_twice_is_the_same_as_one_that_was_not() {
    let folder = tempfile::tempdir().unwrap();
    let mut kept = 0;
    for name in ["INT", "TERM"] {
        let child = begin(folder.path(), "4000K");
        wait_until_busy(&child);
        signal(&child, name);
        let output = child.wait_with_output().unwrap();
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(130), "{message}");
        assert!(message.contains("give the same command again"), "{message}");
        assert!(!folder.path().join("x.exr").exists());
        assert!(samples(folder.path()) >= kept);
        kept = samples(folder.path());
        assert!((1..4_000_000).contains(&kept));
    }
    let mut other = begin(folder.path(), "3000K");
    assert_eq!(other.wait().unwrap().code(), Some(2), "another plan");
    let output = begin(folder.path(), "4000K").wait_with_output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(!folder.path().join("x.exr.checkpoint").exists());
    let again = [
        "image",
        &scene(),
        "--rays-a",
        "4000K",
        "--rays-c1c2",
        "4000K",
        "-o",
        "whole.exr",
    ];
    assert!(acuity(folder.path(), &again).status.success());
    let [one, other] =
        ["x.exr", "whole.exr"].map(|name| fs::read(folder.path().join(name)).unwrap());
    assert!(one == other, "the images differ");
}
