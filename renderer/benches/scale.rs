//! Time and memory of one picture, from 10 K rays to 24 M.
//!
//! `cargo bench -p renderer --bench scale` prints a table; `-- --plot docs/scale` also draws it as
//! `docs/scale.svg` and `.png`; `-- --most 1400K` ends earlier. Each picture is a process of its own, on one
//! thread: scene file to EXR file, 1.4 rays a pixel. Time is CPU time; memory is the largest resident set,
//! less 12 bytes a pixel for the three images. Upkeep is the time of a tree over a picture that costs
//! nothing: what is left when the rays are free.
//!
//! Linux only: both are read from `/proc`.
#![expect(clippy::print_stdout, reason = "a bench prints what it measured")]

use std::error::Error;
use std::fmt::Write as _;
use std::num::NonZeroUsize;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;

use protocols::{Channel, PerChannel, Quadrature, RayCount, RefinementDriver, TreePlan};
use renderer::{ImageRequest, Sampler, ScreenPoint, Watch, render_image, trace};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

type Outcome<T> = Result<T, Box<dyn Error>>;

const SCENE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../stimuli/scenes/opponent-solids.toml"
);

/// Rays, and the side of the picture in pixels.
const SIZES: [(u32, u32); 8] = [
    (10_000, 85),
    (30_000, 148),
    (140_000, 320),
    (500_000, 600),
    (1_400_000, 1000),
    (5_000_000, 1870),
    (12_000_000, 2896),
    (24_000_000, 4096),
];

/// What one picture took.
#[derive(Clone, Copy, Debug)]
struct Measured {
    rays: u32,
    whole_ns: f64,
    upkeep_ns: f64,
    bytes: f64,
}

fn main() -> Outcome<()> {
    let arguments: Vec<String> = std::env::args().collect();
    let after = |name: &str| {
        let place = arguments.iter().position(|argument| argument == name)?;
        arguments.get(place + 1).cloned()
    };
    if let Some(one) = after("--one") {
        let (rays, side_px) = one.split_once('x').ok_or("RAYSxSIDE")?;
        let (rays, side_px) = (rays.parse()?, side_px.parse()?);
        let report = match after("--part").as_deref() {
            Some("upkeep") => upkeep_ns(rays, side_px)?,
            _ => whole(rays, side_px)?,
        };
        println!("{report}");
        return Ok(());
    }
    let most: RayCount = after("--most").unwrap_or("24000K".to_owned()).parse()?;
    println!(
        "{:>10} {:>6} {:>12} {:>14} {:>18}",
        "rays", "side", "ns a ray", "upkeep, ns", "bytes a ray"
    );
    let mut table = Vec::new();
    for (rays, side_px) in SIZES {
        if rays <= most.get() {
            let row = measured(rays, side_px)?;
            let Measured {
                whole_ns,
                upkeep_ns,
                bytes,
                ..
            } = row;
            println!("{rays:>10} {side_px:>6} {whole_ns:>12.0} {upkeep_ns:>14.0} {bytes:>18.1}");
            table.push(row);
        }
    }
    if let Some(path) = after("--plot") {
        let svg = plot(&table);
        std::fs::write(Path::new(&path).with_extension("png"), png(&svg)?)?;
        std::fs::write(Path::new(&path).with_extension("svg"), svg)?;
    }
    Ok(())
}

/// Runs both parts in processes of their own.
fn measured(rays: u32, side_px: u32) -> Outcome<Measured> {
    let part = |name: &str| -> Outcome<Vec<f64>> {
        let one = format!("{rays}x{side_px}");
        let output = Command::new(std::env::current_exe()?)
            .args(["--one", &one, "--part", name])
            .env("RAYON_NUM_THREADS", "1")
            .output()?;
        let text = String::from_utf8(output.stdout)?;
        let numbers: Result<Vec<f64>, _> = text.split_whitespace().map(str::parse).collect();
        Ok(numbers?)
    };
    let (whole, upkeep) = (part("whole")?, part("upkeep")?);
    let [whole_ns, bytes] = whole.as_slice() else {
        return Err("the picture was not made".into());
    };
    Ok(Measured {
        rays,
        whole_ns: *whole_ns,
        upkeep_ns: upkeep.first().copied().ok_or("the tree was not made")?,
        bytes: *bytes,
    })
}

fn request(rays: u32, side_px: u32) -> Outcome<ImageRequest> {
    let rays = RayCount::new(rays).ok_or("no rays")?;
    Ok(ImageRequest {
        rays_a: rays,
        rays_c1c2: rays,
        stop_depths: PerChannel::default(),
        size_px: [side_px; 2],
        seed: 1992,
        quadrature: Quadrature::Bands(16),
        tree: TreePlan {
            min_depth: 8,
            driver: RefinementDriver::A,
        },
        exports: Vec::new(),
        threads: NonZeroUsize::new(1),
        until: None,
        samples_maps: Vec::new(),
    })
}

/// How often to repeat what is too short for the clock of `/proc`, which ticks a hundred times a second.
fn repetitions(rays: u32) -> u32 {
    (2_000_000 / rays).max(1)
}

/// CPU time and memory of one picture, both for a ray.
fn whole(rays: u32, side_px: u32) -> Outcome<String> {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("picture.exr");
    let request = request(rays, side_px)?;
    let begun = cpu_s()?;
    for _ in 0..repetitions(rays) {
        render_image(Path::new(SCENE), &request, &out, &Watch::UNWATCHED)?;
    }
    let ns = per_ray_ns(cpu_s()? - begun, rays);
    let images = 12.0 * f64::from(side_px) * f64::from(side_px);
    let bytes = (peak_bytes()? - images) / f64::from(rays);
    Ok(format!("{ns} {bytes}"))
}

fn per_ray_ns(seconds: f64, rays: u32) -> f64 {
    1e9 * seconds / f64::from(repetitions(rays)) / f64::from(rays)
}

/// A board of checks, at no cost.
struct Checks;

impl Sampler for Checks {
    type RayTree = f32;

    fn intersect(&self, at: ScreenPoint, tree: &mut f32) {
        let is_dark = ((at.x * 37.0).floor() + (at.y * 29.0).floor()).rem_euclid(2.0) == 0.0;
        *tree = if is_dark { 0.1 } else { 0.9 };
    }

    fn shade(&self, tree: &f32, _channel: Channel) -> f32 {
        *tree
    }
}

fn upkeep_ns(rays: u32, side_px: u32) -> Outcome<String> {
    let plan = request(rays, side_px)?.trace_plan();
    let begun = cpu_s()?;
    for _ in 0..repetitions(rays) {
        std::hint::black_box(trace(&Checks, &plan, &|_, _| ()));
    }
    Ok(per_ray_ns(cpu_s()? - begun, rays).to_string())
}

/// The CPU time of this process, from the 14th and 15th fields of `stat`, in hundredths of a second.
fn cpu_s() -> Outcome<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat")?;
    let (_, fields) = stat.rsplit_once(')').ok_or("no name in stat")?;
    let ticks: Result<Vec<f64>, _> = fields
        .split_whitespace()
        .skip(11)
        .take(2)
        .map(str::parse)
        .collect();
    Ok(ticks?.iter().sum::<f64>() / 100.0)
}

/// The largest resident set of this process.
fn peak_bytes() -> Outcome<f64> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.split_whitespace().next());
    Ok(1024.0 * kib.ok_or("no VmHWM in status")?.parse::<f64>()?)
}

const LEFT: f64 = 74.0;
const WIDTH: f64 = 250.0;
const TOP: f64 = 56.0;
const HEIGHT: f64 = 210.0;

/// One frame of the plot.
struct Frame<'a> {
    left: f64,
    title: &'a str,
    /// The largest value, and the step of the axis.
    highest: f64,
    step: f64,
}

impl Frame<'_> {
    fn x(&self, rays: u32) -> f64 {
        let decades = (24e6_f64 / 1e4).log10();
        self.left + WIDTH * (f64::from(rays) / 1e4).log10() / decades
    }

    fn y(&self, value: f64) -> f64 {
        TOP + HEIGHT * (1.0 - value / self.highest)
    }

    fn axes(&self, svg: &mut String) {
        let Self { left, title, .. } = self;
        _ = write!(
            svg,
            "<text x=\"{left}\" y=\"{}\" font-size=\"15\">{title}</text>\
             <rect x=\"{left}\" y=\"{TOP}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"none\" stroke=\"#888\"/>",
            TOP - 12.0
        );
        let mut value = 0.0;
        while value <= self.highest {
            let y = self.y(value);
            _ = write!(
                svg,
                "<line x1=\"{left}\" y1=\"{y}\" x2=\"{}\" y2=\"{y}\" stroke=\"#ddd\"/>\
                 <text x=\"{}\" y=\"{}\" font-size=\"12\" text-anchor=\"end\">{value}</text>",
                left + WIDTH,
                left - 6.0,
                y + 4.0
            );
            value += self.step;
        }
        for (rays, name) in [
            (10_000, "10K"),
            (140_000, "140K"),
            (1_400_000, "1.4M"),
            (24_000_000, "24M"),
        ] {
            _ = write!(
                svg,
                "<text x=\"{}\" y=\"{}\" font-size=\"12\" text-anchor=\"middle\">{name}</text>",
                self.x(rays),
                TOP + HEIGHT + 18.0
            );
        }
        _ = write!(
            svg,
            "<text x=\"{}\" y=\"{}\" font-size=\"12\" text-anchor=\"middle\">rays</text>",
            left + WIDTH / 2.0,
            TOP + HEIGHT + 36.0
        );
    }

    fn curve(&self, svg: &mut String, dashes: &str, points: &[(u32, f64)]) {
        let places: Vec<String> = points
            .iter()
            .map(|&(rays, value)| {
                format!("{:.1},{:.1}", self.x(rays), self.y(value.min(self.highest)))
            })
            .collect();
        _ = write!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"#222\" stroke-width=\"1.6\" stroke-dasharray=\"{dashes}\"/>",
            places.join(" ")
        );
        for place in places {
            let (x, y) = place.split_once(',').unwrap_or_default();
            _ = write!(svg, "<circle cx=\"{x}\" cy=\"{y}\" r=\"3\" fill=\"#222\"/>");
        }
    }
}

/// Time on the left, memory on the right, over the logarithm of the rays.
fn plot(table: &[Measured]) -> String {
    let mut svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"700\" height=\"320\" font-family=\"Ubuntu\" \
         fill=\"#111\"><rect width=\"700\" height=\"320\" fill=\"#fff\"/>"
        .to_owned();
    let slowest = table.iter().map(|row| row.whole_ns).fold(0.0, f64::max);
    let step = if slowest > 1000.0 { 400.0 } else { 100.0 };
    let time = Frame {
        left: LEFT,
        title: "CPU time, ns a ray (dashed: the tree alone)",
        highest: (slowest / step).ceil() * step,
        step,
    };
    let memory = Frame {
        left: LEFT + WIDTH + 90.0,
        title: "memory beyond the images, bytes a ray",
        highest: 200.0,
        step: 25.0,
    };
    let rows = |value: fn(&Measured) -> f64| -> Vec<(u32, f64)> {
        table.iter().map(|row| (row.rays, value(row))).collect()
    };
    time.axes(&mut svg);
    time.curve(&mut svg, "none", &rows(|row| row.whole_ns));
    time.curve(&mut svg, "5 4", &rows(|row| row.upkeep_ns));
    memory.axes(&mut svg);
    let (y, left) = (memory.y(64.0), memory.left);
    _ = write!(
        svg,
        "<line x1=\"{left}\" y1=\"{y}\" x2=\"{}\" y2=\"{y}\" stroke=\"#b03020\" stroke-dasharray=\"2 3\"/>\
         <text x=\"{}\" y=\"{}\" font-size=\"12\" fill=\"#b03020\" text-anchor=\"end\">64</text>",
        left + WIDTH,
        left + WIDTH - 4.0,
        y - 4.0
    );
    let large: Vec<(u32, f64)> = rows(|row| row.bytes);
    let shown: Vec<(u32, f64)> = large
        .into_iter()
        .filter(|&(_, bytes)| bytes <= 200.0)
        .collect();
    memory.curve(&mut svg, "none", &shown);
    svg.push_str("</svg>\n");
    svg
}

fn png(svg: &str) -> Outcome<Vec<u8>> {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    let options = Options {
        font_family: "Ubuntu".to_owned(),
        fontdb: Arc::new(fonts),
        ..Options::default()
    };
    let tree = Tree::from_str(svg, &options)?;
    let mut pixmap = Pixmap::new(1400, 640).ok_or("no pixels")?;
    pixmap.fill(Color::WHITE);
    resvg::render(&tree, Transform::from_scale(2.0, 2.0), &mut pixmap.as_mut());
    Ok(pixmap.encode_png()?)
}
