//! A screen of its own for a test: Xvfb, a window manager, a mouse, a keyboard, and screenshots.
//!
//! Everything goes through other programs (Xvfb, openbox, xdotool, `ImageMagick`), as a subject's hands and
//! eyes would: nothing here knows the program under test.

use std::env;
use std::io::{self, BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// Width and height of the screen.
pub(crate) const SIZE: [usize; 2] = [1280, 1024];

/// Whether a window manager runs on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Manager {
    Openbox,
    None,
}

/// A screen, and the programs that make it; they end with it.
pub(crate) struct Display {
    name: String,
    children: Vec<Child>,
}

/// What was on the screen: three bytes a pixel.
pub(crate) struct Screenshot(Vec<u8>);

impl Display {
    /// A new screen, or `None`, with the reason on stderr, where the programs for it are missing.
    ///
    /// With `ACUITY_REQUIRE_DISPLAY=1` a missing program fails the test.
    pub(crate) fn open(manager: Manager) -> Option<Self> {
        Self::of_depth(manager, 24)
    }

    /// The same with so many bits a pixel.
    pub(crate) fn of_depth(manager: Manager, bits: u8) -> Option<Self> {
        let missing: Vec<&str> = ["Xvfb", "openbox", "xdotool", "import", "convert"]
            .into_iter()
            .filter(|program| !is_on_path(program))
            .collect();
        if !missing.is_empty() {
            let reason = format!("the window test needs {}", missing.join(", "));
            assert!(env::var_os("ACUITY_REQUIRE_DISPLAY").is_none(), "{reason}");
            // Past the test harness, which hides what a passing test prints.
            let line = format!("SKIPPED: {reason}\n");
            io::stderr().write_all(line.as_bytes()).unwrap();
            return None;
        }
        let [width, height] = SIZE;
        let screen = format!("{width}x{height}x{bits}");
        let mut server = Command::new("Xvfb")
            .args([
                "-displayfd",
                "1",
                "-nolisten",
                "tcp",
                "-screen",
                "0",
                &screen,
            ])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut number = String::new();
        let stdout = server.stdout.take().unwrap();
        BufReader::new(stdout).read_line(&mut number).unwrap();
        let mut display = Self {
            name: format!(":{}", number.trim()),
            children: vec![server],
        };
        if manager == Manager::Openbox {
            let openbox = display
                .command("openbox")
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn();
            display.children.push(openbox.unwrap());
        }
        sleep(Duration::from_millis(500));
        Some(display)
    }

    /// The name by which programs find this screen.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// A program on this screen.
    pub(crate) fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("DISPLAY", &self.name);
        command
    }

    /// Moves the mouse and clicks.
    pub(crate) fn click(&self, [x, y]: [usize; 2]) {
        self.xdotool(&["mousemove", &x.to_string(), &y.to_string(), "click", "1"]);
    }

    /// Moves the mouse and clicks twice, faster than a frame or two.
    pub(crate) fn double_click(&self, [x, y]: [usize; 2]) {
        let twice = ["click", "--repeat", "2", "--delay", "30", "1"];
        let there = ["mousemove", &x.to_string(), &y.to_string()];
        self.xdotool(&[&there[..], &twice].concat());
    }

    /// Moves the mouse.
    pub(crate) fn move_to(&self, [x, y]: [usize; 2]) {
        self.xdotool(&["mousemove", &x.to_string(), &y.to_string()]);
    }

    /// Moves the mouse and holds its button down.
    pub(crate) fn press(&self, place: [usize; 2]) {
        self.move_to(place);
        self.xdotool(&["mousedown", "1"]);
    }

    /// Lets the mouse's button go.
    pub(crate) fn release(&self) {
        self.xdotool(&["mouseup", "1"]);
    }

    /// Presses and releases a key, by its X11 name.
    pub(crate) fn key(&self, name: &str) {
        self.xdotool(&["key", name]);
    }

    /// Where the mouse is.
    pub(crate) fn mouse(&self) -> [usize; 2] {
        let arguments = ["getmouselocation", "--shell"];
        let output = self.command("xdotool").args(arguments).output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        let value = |name: &str| {
            let mut lines = text.lines();
            let value = lines.find_map(|line| line.strip_prefix(name));
            value.unwrap().parse().unwrap()
        };
        [value("X="), value("Y=")]
    }

    /// Waits for the window with this title, and gives it the upper left corner and this size.
    pub(crate) fn place(&self, title: &str, [width, height]: [usize; 2]) {
        let [width, height] = [width.to_string(), height.to_string()];
        self.xdotool(&["search", "--sync", "--name", title, "windowmove", "0", "0"]);
        self.xdotool(&["search", "--name", title, "windowsize", &width, &height]);
    }

    /// Clicks at a place in the window with this title, which is brought to the front.
    pub(crate) fn click_in(&self, title: &str, [x, y]: [usize; 2]) {
        let [x, y] = [x.to_string(), y.to_string()];
        self.xdotool(&["search", "--name", title, "windowactivate", "--sync"]);
        let window = ["search", "--name", title, "mousemove", "--window", "%1"];
        self.xdotool(&[&window[..], &[&x, &y, "click", "1"]].concat());
    }

    /// Types words where the keyboard is.
    pub(crate) fn write(&self, words: &str) {
        self.xdotool(&["type", words]);
    }

    fn xdotool(&self, arguments: &[&str]) {
        let status = self.command("xdotool").args(arguments).status().unwrap();
        assert!(status.success());
    }

    pub(crate) fn screenshot(&self) -> Screenshot {
        let arguments = ["-window", "root", "-depth", "8", "rgb:-"];
        let output = self.command("import").args(arguments).output().unwrap();
        assert_eq!(output.stdout.len(), SIZE[0] * SIZE[1] * 3, "{output:?}");
        Screenshot(output.stdout)
    }

    /// Screenshots until one is as `is_it` says.
    pub(crate) fn wait_for(&self, what: &str, is_it: impl Fn(&Screenshot) -> bool) -> Screenshot {
        for _ in 0..300 {
            let shot = self.screenshot();
            if is_it(&shot) {
                return shot;
            }
            sleep(Duration::from_millis(20));
        }
        panic!("{what} did not appear");
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        for child in self.children.iter_mut().rev() {
            let killed = child.kill().and_then(|()| child.wait());
            assert!(killed.is_ok() || std::thread::panicking(), "{killed:?}");
        }
    }
}

impl Screenshot {
    /// The color of one pixel.
    pub(crate) fn pixel(&self, [x, y]: [usize; 2]) -> [u8; 3] {
        let start = 3 * (y * SIZE[0] + x);
        [self.0[start], self.0[start + 1], self.0[start + 2]]
    }

    /// The pixels of a rectangle, row by row.
    pub(crate) fn part(&self, [left, top]: [usize; 2], [width, height]: [usize; 2]) -> Vec<u8> {
        (top..top + height)
            .flat_map(|y| {
                let start = 3 * (y * SIZE[0] + left);
                self.0[start..start + 3 * width].iter().copied()
            })
            .collect()
    }
}

/// The pixels of a PNG file, by `ImageMagick`.
pub(crate) fn png_pixels(path: &Path) -> Vec<u8> {
    let mut command = Command::new("convert");
    let output = command
        .arg(path)
        .args(["-depth", "8", "rgb:-"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    output.stdout
}

/// Whether there is a program with this name.
pub(crate) fn is_on_path(program: &str) -> bool {
    let path = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&path).any(|folder| folder.join(program).exists())
}
