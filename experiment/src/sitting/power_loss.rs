//! The power fails: what was not synced is lost, and whatever the subject saw accepted is on disk all the same.
//!
//! A whole session runs under `strace`, which writes down each change that the program asks the system for, in order.
//! A model of a disk takes them one by one; after each one the power fails, and the data folder is made again from what
//! the model says may be left. POSIX promises the bytes of a file after its `fsync`, and its name after that of its
//! folder; what was not synced may be there or not.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fs;

use super::crash::{check_rows, last, victim};
use super::tests::Place;
use super::*;
use crate::Screen;

/// The system calls that change files, or promise that they are kept.
const CALLS: &str =
    "openat,write,fsync,fdatasync,rename,renameat,renameat2,ftruncate,mkdir,unlink,unlinkat";

/// One thing that the program asked for and got.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Call {
    MakeFolder(PathBuf),
    Open(PathBuf, Opened),
    Truncate(PathBuf, usize),
    /// Every writer here writes at the end.
    Append(PathBuf, Vec<u8>),
    Sync(PathBuf),
    Rename(PathBuf, PathBuf),
    Remove(PathBuf),
    /// On standard output.
    Say(String),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Opened {
    AsItIs,
    Emptied,
}

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Node {
    Folder,
    File(usize),
}

/// The bytes of a file, and those that it had when it was last synced.
#[derive(Clone, Debug, Default)]
struct Content {
    written: Vec<u8>,
    synced: Vec<u8>,
}

/// Which of the changes that were not synced are left.
#[derive(Clone, Copy, Debug)]
enum Left {
    /// None.
    Nothing,
    /// Every name, but no byte.
    Names,
    /// Every name, and the first half of the bytes.
    NamesAndHalf,
}

/// A disk that loses what was not synced.
#[derive(Debug)]
struct Disk {
    /// The folder that was there before.
    folder: PathBuf,
    names: BTreeMap<PathBuf, Node>,
    settled: BTreeMap<PathBuf, Node>,
    files: Vec<Content>,
}

impl Disk {
    fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            names: BTreeMap::new(),
            settled: BTreeMap::new(),
            files: Vec::new(),
        }
    }

    fn content(&mut self, path: &Path) -> Option<&mut Content> {
        match self.names.get(path) {
            Some(&Node::File(index)) => self.files.get_mut(index),
            _ => None,
        }
    }

    fn take(&mut self, call: &Call) {
        match call {
            Call::MakeFolder(path) => {
                self.names.insert(path.clone(), Node::Folder);
            }
            Call::Open(path, opened) => {
                if !self.names.contains_key(path) {
                    self.names
                        .insert(path.clone(), Node::File(self.files.len()));
                    self.files.push(Content::default());
                }
                if *opened == Opened::Emptied
                    && let Some(content) = self.content(path)
                {
                    content.written.clear();
                }
            }
            Call::Truncate(path, length) => self.content(path).unwrap().written.truncate(*length),
            Call::Append(path, bytes) => self.content(path).unwrap().written.extend(bytes),
            Call::Sync(path) => match self.content(path) {
                Some(content) => content.synced.clone_from(&content.written),
                None => self.settle(path),
            },
            Call::Rename(from, to) => {
                let node = self.names.remove(from).unwrap();
                self.names.insert(to.clone(), node);
            }
            Call::Remove(path) => {
                self.names.remove(path);
            }
            Call::Say(_) => {}
        }
    }

    /// The names in a folder are kept as they are.
    fn settle(&mut self, folder: &Path) {
        let is_in = |path: &Path| path.parent() == Some(folder);
        self.settled.retain(|path, _| !is_in(path));
        let now = self.names.iter().filter(|(path, _)| is_in(path));
        self.settled
            .extend(now.map(|(path, node)| (path.clone(), *node)));
    }

    /// Folders (without bytes) and files after a power cut.
    fn after_power_cut(&self, left: Left) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
        let names = match left {
            Left::Nothing => &self.settled,
            Left::Names | Left::NamesAndHalf => &self.names,
        };
        let is_reached = |path: &Path| {
            let above = path.ancestors().skip(1);
            let mut above = above.take_while(|path| *path != self.folder);
            above.all(|path| names.get(path) == Some(&Node::Folder))
        };
        let reached = names.iter().filter(|(path, _)| is_reached(path));
        let bytes = |node: &Node| match (node, left) {
            (Node::Folder, _) => None,
            (Node::File(index), Left::NamesAndHalf) => Some(self.files[*index].half()),
            (Node::File(index), _) => Some(self.files[*index].synced.clone()),
        };
        reached
            .map(|(path, node)| (path.clone(), bytes(node)))
            .collect()
    }
}

impl Content {
    /// What was synced, and the first half of what came after.
    fn half(&self) -> Vec<u8> {
        let kept = match self.written.strip_prefix(&self.synced[..]) {
            Some(new) => self.synced.len() + new.len() / 2,
            None => self.written.len(),
        };
        self.written[..kept].to_vec()
    }
}

/// The calls of a log of `strace -f -y -xx`, those on files below `folder` and what was said.
fn calls(log: &str, folder: &Path) -> Vec<Call> {
    let mut unfinished = HashMap::new();
    let mut calls = Vec::new();
    for line in log.lines() {
        let (process, text) = line.split_once(' ').unwrap();
        let text = text.trim_start();
        let whole = if let Some(begun) = text.strip_suffix("<unfinished ...>") {
            unfinished.insert(process, begun);
            continue;
        } else if let Some((_, rest)) = text.split_once(" resumed>") {
            [unfinished.remove(process).unwrap(), rest].concat()
        } else {
            text.to_owned()
        };
        calls.extend(call(&whole, folder));
    }
    calls
}

/// The bytes of `\x41\x42`.
fn bytes(escaped: &str) -> Vec<u8> {
    let pairs = escaped.split("\\x").skip(1);
    pairs
        .map(|pair| u8::from_str_radix(pair, 16).unwrap())
        .collect()
}

/// One line: `name(arguments) = result`; what failed, and what is elsewhere, is `None`.
fn call(line: &str, folder: &Path) -> Option<Call> {
    let (name, rest) = line.split_once('(')?;
    let (arguments, result) = rest.rsplit_once(" = ")?;
    if result.starts_with('-') || result.starts_with('?') {
        return None;
    }
    let path = |escaped: &str| PathBuf::from(String::from_utf8(bytes(escaped)).unwrap());
    let in_angles = |text: &str| Some(path(text.split_once('<')?.1.split_once('>')?.0));
    let quoted: Vec<&str> = arguments.split('"').skip(1).step_by(2).collect();
    let named = |index: usize| quoted.get(index).map(|text| path(text));
    let is_inside = |path: &PathBuf| path.starts_with(folder);
    let handle = in_angles(arguments).filter(is_inside);
    match name {
        "mkdir" => named(0).filter(is_inside).map(Call::MakeFolder),
        "openat" => {
            let is_folder = arguments.contains("O_DIRECTORY") || !arguments.contains("O_CREAT");
            let is_emptied = arguments.contains("O_TRUNC");
            let opened = if is_emptied {
                Opened::Emptied
            } else {
                Opened::AsItIs
            };
            let path = in_angles(result).filter(is_inside).filter(|_| !is_folder);
            path.map(|path| Call::Open(path, opened))
        }
        "write" if arguments.starts_with("1<") => {
            let said = String::from_utf8_lossy(&bytes(quoted[0])).into_owned();
            Some(Call::Say(said))
        }
        "write" => {
            let count: usize = result.trim().parse().unwrap();
            handle.map(|path| Call::Append(path, bytes(quoted[0])[..count].to_vec()))
        }
        "fsync" | "fdatasync" => handle.map(Call::Sync),
        "ftruncate" => {
            let length = arguments.trim_end_matches([')', ' ']).rsplit_once(", ")?.1;
            handle.map(|path| Call::Truncate(path, length.parse().unwrap()))
        }
        "unlink" | "unlinkat" => named(0).filter(is_inside).map(Call::Remove),
        _ => {
            let from = named(0).filter(is_inside)?;
            named(1).map(|to| Call::Rename(from, to))
        }
    }
}

/// Makes the data folder of `place` again in `root`.
fn rebuild(state: &BTreeMap<PathBuf, Option<Vec<u8>>>, place: &Place, root: &Path) {
    fs::create_dir_all(root).unwrap();
    for (path, bytes) in state {
        let Ok(inside) = path.strip_prefix(&place.options.data_dir) else {
            continue;
        };
        match bytes {
            None => fs::create_dir_all(root.join(inside)).unwrap(),
            Some(bytes) => fs::write(root.join(inside), bytes).unwrap(),
        }
    }
}

#[test]
fn when_the_power_fails_after_any_call_every_rating_that_was_accepted_is_kept() {
    let path = std::env::var_os("PATH").unwrap_or_default();
    if !std::env::split_paths(&path).any(|folder| folder.join("strace").exists()) {
        let line = "SKIPPED: the test of a power cut needs strace\n";
        std::io::Write::write_all(&mut std::io::stderr(), line.as_bytes()).unwrap();
        return;
    }
    let place = Place::new();
    let log = place.folder().join("calls.txt");
    let (trace, log_name) = (format!("trace={CALLS}"), log.to_string_lossy());
    let strace = [
        "strace", "-f", "-y", "-xx", "-s", "1000000", "-e", &trace, "-o", &log_name,
    ];
    let output = victim(&place, &strace).wait_with_output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert_eq!(check_rows(&place), 30);
    let calls = calls(&fs::read_to_string(&log).unwrap(), place.folder());
    let mut disk = Disk::new(place.folder());
    let (mut seen, mut said) = (BTreeSet::new(), String::new());
    for (moment, call) in calls.iter().enumerate() {
        disk.take(call);
        if let Call::Say(words) = call {
            said.push_str(words);
        }
        let accepted = last(&said, "accepted").unwrap_or(0);
        for left in [Left::Nothing, Left::Names, Left::NamesAndHalf] {
            let state = disk.after_power_cut(left);
            if !seen.insert((accepted, state.clone())) {
                continue;
            }
            let mut after = Place::at(place.folder());
            after.options.data_dir = place.folder().join("after-power-cut");
            rebuild(&state, &place, &after.options.data_dir);
            let kept = check_rows(&after);
            let what = format!("{moment}: {call:?}, {left:?}: {accepted} accepted, {kept} on disk");
            assert!((accepted..=accepted + 1).contains(&kept), "{what}");
            // The session goes on from there, or is already complete.
            if kept < 30 && seen.len().is_multiple_of(4) {
                let sitting = after
                    .open()
                    .unwrap_or_else(|error| panic!("{what}: {error}"));
                assert_eq!(sitting.session.rated(), kept, "{what}");
                assert_ne!(sitting.session.screen(), Screen::Thanks);
            }
            fs::remove_dir_all(&after.options.data_dir).unwrap();
        }
    }
    assert!(said.contains("accepted 30"), "{said}");
    assert!(seen.len() > 100, "only {} states", seen.len());
}

#[test]
fn the_model_of_the_disk_loses_what_was_not_synced() {
    let [file, folder] = ["/a/b/c", "/a/b"].map(PathBuf::from);
    let mut disk = Disk::new(Path::new("/a"));
    let here = |disk: &Disk, left| disk.after_power_cut(left).get(Path::new("/a/b/c")).cloned();
    disk.take(&Call::MakeFolder(folder.clone()));
    disk.take(&Call::Open(file.clone(), Opened::AsItIs));
    disk.take(&Call::Append(file.clone(), b"1234".to_vec()));
    assert_eq!(here(&disk, Left::Names), Some(Some(Vec::new())));
    assert_eq!(here(&disk, Left::NamesAndHalf), Some(Some(b"12".to_vec())));
    disk.take(&Call::Sync(file.clone()));
    assert_eq!(here(&disk, Left::Names), Some(Some(b"1234".to_vec())));
    assert_eq!(here(&disk, Left::Nothing), None, "its name is not settled");
    disk.take(&Call::Sync(folder));
    assert_eq!(
        here(&disk, Left::Nothing),
        None,
        "that of its folder is not"
    );
    disk.take(&Call::Sync("/a".into()));
    assert_eq!(here(&disk, Left::Nothing), Some(Some(b"1234".to_vec())));
    disk.take(&Call::Append(file, b"56".to_vec()));
    assert_eq!(here(&disk, Left::Nothing), Some(Some(b"1234".to_vec())));
    assert_eq!(
        here(&disk, Left::NamesAndHalf),
        Some(Some(b"12345".to_vec()))
    );
}

#[test]
fn the_log_of_calls_is_read_as_strace_writes_it() {
    let log = "7 mkdir(\"\\x2f\\x61\\x2f\\x62\", 0700) = 0\n\
        7 mkdir(\"\\x2f\\x61\\x2f\\x62\", 0700) = -1 EEXIST (File exists)\n\
        7 openat(AT_FDCWD<\\x2f>, \"\\x2f\\x61\\x2f\\x63\", O_WRONLY|O_CREAT|O_TRUNC, 0600) = 3<\\x2f\\x61\\x2f\\x63>\n\
        7 write(3<\\x2f\\x61\\x2f\\x63>, \"\\x41\\x42\", 2 <unfinished ...>\n\
        8 write(1<\\x70>, \"\\x68\\x69\", 2) = 2\n\
        7 <... write resumed>) = 2\n\
        7 ftruncate(3<\\x2f\\x61\\x2f\\x63>, 1) = 0\n\
        7 fsync(3<\\x2f\\x61>) = 0\n\
        7 +++ exited with 0 +++\n";
    let [folder, file] = ["/a/b", "/a/c"].map(PathBuf::from);
    let expected = [
        Call::MakeFolder(folder),
        Call::Open(file.clone(), Opened::Emptied),
        Call::Say("hi".to_owned()),
        Call::Append(file.clone(), b"AB".to_vec()),
        Call::Truncate(file, 1),
        Call::Sync("/a".into()),
    ];
    assert_eq!(calls(log, Path::new("/a")), expected);
}
