//! Where the time of a whole stimulus set goes: the study's 28 images, from the scene file to the last file.
//!
//! `cargo bench -p renderer --bench set` prints wall and CPU time of the whole and of its parts, each the least of
//! five, in a folder beside the build's own. What is left of the whole is the encoding of EXR and PNG. Written are
//! the files of the whole, by as many threads as there are images.
#![expect(clippy::print_stdout, reason = "a bench prints what it measured")]

use std::error::Error;
use std::fs;
use std::hint::black_box;
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::thread;

use protocols::{Access, Channel, PerChannel, Sha256Digest, Study, write_atomically};
use renderer::{
    Cell, ImageRequest, Scene, SrgbEncoder, Wanted, Watch, render_set, snapshots, trace,
};
use rustix::time::{ClockId, clock_gettime};

const ROUNDS: usize = 5;
const PROTOCOL: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../protocols/meyer-liu-1992.toml"
);

/// Seconds on the wall, and of all threads together.
#[derive(Clone, Copy)]
struct Cost {
    wall_s: f64,
    cpu_s: f64,
}

impl Cost {
    fn now() -> Self {
        let seconds = |clock| {
            let time = clock_gettime(clock);
            time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
        };
        Self {
            wall_s: seconds(ClockId::Monotonic),
            cpu_s: seconds(ClockId::ProcessCPUTime),
        }
    }
}

/// Prints the least time of some work, and gives what it made last.
fn measure<T>(
    name: &str,
    mut work: impl FnMut() -> Result<T, Box<dyn Error>>,
) -> Result<T, Box<dyn Error>> {
    let mut least = Cost {
        wall_s: f64::INFINITY,
        cpu_s: f64::INFINITY,
    };
    let mut made = None;
    for _ in 0..ROUNDS {
        let start = Cost::now();
        made = Some(work()?);
        let end = Cost::now();
        least.wall_s = least.wall_s.min(end.wall_s - start.wall_s);
        least.cpu_s = least.cpu_s.min(end.cpu_s - start.cpu_s);
    }
    println!(
        "{name:<36}{:>8.1}{:>8.1}",
        1e3 * least.wall_s,
        1e3 * least.cpu_s
    );
    made.ok_or_else(|| "no round".into())
}

fn main() -> Result<(), Box<dyn Error>> {
    let study = Study::read(Path::new(PROTOCOL))?;
    let plan = study.render_plan()?;
    let folder = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR"))?;
    let out = folder.path().join("set");
    println!("{:<36}{:>8}{:>8}", "ms", "wall", "CPU");
    measure("the whole set", || {
        if out.exists() {
            fs::remove_dir_all(&out)?;
        }
        Ok(render_set(&study, &out, None, &Watch::UNWATCHED)?)
    })?;
    let scene = measure("reading the scene", || {
        Ok(Scene::read(&study.scene_path()?)?)
    })?;
    let sampler = measure("its tables", || {
        Ok(scene.sampler(plan.quadrature, plan.size_px))
    })?;
    let most = ImageRequest::of_study(study.rendering()?, plan.most_rays(), plan.most_rays());
    let tree = measure("trace, 140K rays", || {
        Ok(trace(&sampler, &most.trace_plan(), &|_, _| ()))
    })?;
    let images = measure("42 channel images", || {
        snapshots(&tree, &wanted(plan), plan.size_px).ok_or_else(|| "no images".into())
    })?;
    let last = PerChannel::from_fn(|channel| images[channel].values().next_back());
    let PerChannel {
        a: Some(a),
        c1: Some(c1),
        c2: Some(c2),
    } = last
    else {
        return Err("no images".into());
    };
    let encoder = SrgbEncoder::new();
    measure("28 pictures in sRGB, on one thread", || {
        for _ in 0..plan.stimuli().len() {
            black_box(encoder.encode(PerChannel { a, c1, c2 }));
        }
        Ok(())
    })?;
    files(&out, folder.path())
}

/// All counts of the study for each channel.
fn wanted(plan: &protocols::StimulusPlan) -> PerChannel<Wanted> {
    let stimuli = plan.stimuli();
    PerChannel::from_fn(|channel| Wanted {
        rays: (stimuli.iter())
            .map(|stimulus| match channel {
                Channel::A => stimulus.rays_a.as_usize(),
                Channel::C1 | Channel::C2 => stimulus.rays_c1c2.as_usize(),
            })
            .collect(),
        depth: Cell::DEEPEST,
    })
}

/// What it takes to hash the files of a set and to write them.
fn files(set: &Path, folder: &Path) -> Result<(), Box<dyn Error>> {
    let mut files: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    for entry in fs::read_dir(set)? {
        let entry = entry?;
        files.push((entry.file_name().into(), fs::read(entry.path())?));
    }
    measure("hashing them, on one thread", || {
        for (_, bytes) in &files {
            black_box(Sha256Digest::of(bytes));
        }
        Ok(())
    })?;
    let out = folder.join("again");
    measure("writing and syncing them", || {
        if out.exists() {
            fs::remove_dir_all(&out)?;
        }
        let write = &|files: &[(PathBuf, Vec<u8>)]| {
            files.iter().try_for_each(|(name, bytes)| {
                write_atomically(&out.join(name), bytes, Access::Ordinary)
            })
        };
        thread::scope(|scope| {
            let threads: Vec<_> = files
                .chunks(2)
                .map(|two| scope.spawn(move || write(two)))
                .collect();
            for thread in threads {
                thread.join().unwrap_or_else(|panic| resume_unwind(panic))?;
            }
            Ok(())
        })
    })
}
