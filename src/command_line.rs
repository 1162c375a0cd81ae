//! The words of the command line and what they mean.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use analysis::EffectScale;
use clap::{Args, Parser, Subcommand, ValueEnum};
use protocols::{
    Channel, Export, Observer, Quadrature, RayCount, RefinementDriver, Study, SubjectId,
};

use crate::analysis_arguments::{AnovaArguments, ReportArguments};

/// A psychophysics experiment harness: scene, rays, tree, channel images, stimuli, session, ratings, ANOVA,
/// report. Without a command it opens the app.
#[derive(Debug, Parser)]
#[command(name = "acuity", version)]
pub(crate) struct CommandLine {
    /// Print no progress.
    #[arg(short, long, global = true)]
    pub(crate) quiet: bool,
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Open the app on a study: its stimuli, station, sessions and report.
    App(AppArguments),
    /// Is everything ready for the first subject, or is a scene all supported? One line for each thing that is not.
    Check(CheckArguments),
    /// Make the stimulus set of a protocol, and print what was spent and saved per channel.
    Render(RenderArguments),
    /// Make one image of a scene.
    Image(ImageArguments),
    /// Draw the paper's figures from the stimulus set of a protocol.
    Figures(FiguresArguments),
    /// Run one session in a full-screen window; it resumes where it stopped.
    Run(RunArguments),
    /// The experimenter's view of a session: `run --experimenter` starts it.
    #[command(hide = true)]
    View(ViewArguments),
    /// Close a session that will never be complete: it is kept, but not resumed.
    Close(CloseArguments),
    /// Write down this computer's screen and chair, and say where to sit.
    Station(StationArguments),
    /// Write people's ratings in the form of another standard.
    Export(ExportArguments),
    /// Let simulated observers sit the same session.
    Simulate(SimulateArguments),
    /// Which ratings do two models of vision expect? The report draws them beside those that were given.
    Predict(PredictArguments),
    /// How many subjects does the study need? Simulated studies of each size, analysed as the protocol says.
    Power(PowerArguments),
    /// Analyse the ratings of a study and write the report.
    Report(Box<ReportArguments>),
    /// Analysis of variance of any table in long format.
    Anova(Box<AnovaArguments>),
    /// The paper's study end to end: render, simulate, report. Needs no display.
    Replicate(ReplicateArguments),
}

#[derive(Debug, Args)]
pub(crate) struct StimuliFolder {
    /// Folder of the stimulus set [default: stimuli/SET]
    #[arg(id = "stimuli", long, value_name = "DIR")]
    named: Option<PathBuf>,
}

impl StimuliFolder {
    /// The folder named, or the study's own.
    pub(crate) fn of(&self, study: &Study) -> PathBuf {
        let named = self.named.clone();
        named.unwrap_or_else(|| study.default_stimuli_dir())
    }
}

#[derive(Debug, Args)]
pub(crate) struct DataFolder {
    /// Folder of the ratings [default: data/STUDY]
    #[arg(id = "data", long, value_name = "DIR")]
    named: Option<PathBuf>,
}

impl DataFolder {
    /// Whether a folder was named.
    pub(crate) fn is_named(&self) -> bool {
        self.named.is_some()
    }

    /// The folder named, or the study's own.
    pub(crate) fn of(&self, study: &Study) -> PathBuf {
        let named = self.named.clone();
        named.unwrap_or_else(|| study.default_data_dir(Observer::Person))
    }
}

#[derive(Debug, Args)]
pub(crate) struct AppArguments {
    /// The protocol file.
    pub(crate) protocol: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    /// The protocol file, or a scene (TOML, .gltf, .glb, .obj, .ply).
    pub(crate) protocol: PathBuf,
    /// The measured screen and chair [default: that of `acuity station`, if there is one]
    #[arg(long, value_name = "FILE")]
    pub(crate) station: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) stimuli: StimuliFolder,
    #[command(flatten)]
    pub(crate) data: DataFolder,
}

#[derive(Debug, Args)]
pub(crate) struct RenderArguments {
    /// The protocol file.
    pub(crate) protocol: PathBuf,
    /// Folder for the images and their manifest [default: stimuli/SET]
    #[arg(long)]
    pub(crate) out: Option<PathBuf>,
    /// How many threads [default: one for each core]
    #[arg(long, value_parser = threads)]
    pub(crate) threads: Option<NonZeroUsize>,
}

#[derive(Debug, Args)]
pub(crate) struct ImageArguments {
    /// The scene file.
    pub(crate) scene: PathBuf,
    /// Rays for the achromatic channel, such as 50K.
    #[arg(long)]
    pub(crate) rays_a: RayCount,
    /// Rays for the chromatic channels, such as 140K [default: as many as for A]
    #[arg(long)]
    pub(crate) rays_c1c2: Option<RayCount>,
    /// Width and height in pixels.
    #[arg(long, default_value = "320x320", value_parser = size_px)]
    pub(crate) size: [u32; 2],
    /// Seed of the sample positions.
    #[arg(long, default_value_t = 1992)]
    pub(crate) seed: u64,
    /// Wavelengths: "16 bands" (3 to 301) or "meyer 1988".
    #[arg(long, default_value = "16 bands", value_parser = quadrature)]
    pub(crate) quadrature: Quadrature,
    /// Down to this depth of the tree every cell is split.
    #[arg(long, default_value_t = 8)]
    pub(crate) min_depth: u32,
    /// Which channels say where more samples are needed: A, or AC1C2 (a channel that stops then changes the tree).
    #[arg(long, default_value = "A", value_parser = driver)]
    pub(crate) driver: RefinementDriver,
    /// Neither shade nor store A below this depth of the tree (p of section 3.3).
    #[arg(long)]
    pub(crate) depth_a: Option<u32>,
    /// The same for C1 (q of section 3.3).
    #[arg(long)]
    pub(crate) depth_c1: Option<u32>,
    /// The same for C2 (r of section 3.3).
    #[arg(long)]
    pub(crate) depth_c2: Option<u32>,
    /// End where the mean of every region is known within this, with 95% confidence; the rays are the most to take.
    #[arg(long, value_name = "K/255", value_parser = tolerance_steps)]
    pub(crate) until_within: Option<u8>,
    /// The channel whose means are to be known: A, C1 or C2.
    #[arg(long, default_value = "A", value_name = "CHANNEL", value_parser = channel, requires = "until_within")]
    pub(crate) confidence_channel: Channel,
    /// Refine no channel beyond what can be seen: by the tables acuity and viewing of PROTOCOL, or if none is named by
    /// Mullen's cutoffs (34 and 11 cycles/degree) at 0.019 degrees a pixel.
    #[arg(long, value_name = "PROTOCOL", num_args = 0..=1, default_missing_value = "paper", value_parser = eye)]
    pub(crate) acuity: Option<Eye>,
    /// Make the image without these limits too, to FILE, and print rays, shadings, time and visible difference.
    #[arg(long, value_name = "FILE", requires = "acuity")]
    pub(crate) compare: Option<PathBuf>,
    /// Write the samples in each pixel and the depth of the tree, per channel: .png to look at, .exr as numbers. May be repeated.
    #[arg(long, value_name = "FILE")]
    pub(crate) samples_map: Vec<PathBuf>,
    /// How many threads [default: one for each core]
    #[arg(long, value_parser = threads)]
    pub(crate) threads: Option<NonZeroUsize>,
    /// Further files: xyz (EXR), spectral (EXR, Fichet et al. 2021), png16.
    #[arg(long, value_name = "KINDS", value_delimiter = ',', value_parser = export)]
    pub(crate) export: Vec<Export>,
    /// The image: .exr (A, C1, C2) or .png (sRGB).
    #[arg(short, long)]
    pub(crate) out: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct FiguresArguments {
    /// The protocol file.
    pub(crate) protocol: PathBuf,
    #[command(flatten)]
    pub(crate) stimuli: StimuliFolder,
    /// Folder for the figures.
    #[arg(short, long)]
    pub(crate) out: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct RunArguments {
    /// The protocol file.
    pub(crate) protocol: PathBuf,
    /// Code of the subject: 1 to 32 letters and digits, never a name.
    #[arg(long)]
    pub(crate) subject: SubjectId,
    #[command(flatten)]
    pub(crate) stimuli: StimuliFolder,
    #[command(flatten)]
    pub(crate) data: DataFolder,
    /// Which sitting of the subject, from 1.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) session: u32,
    /// The measured screen and chair [default: that of `acuity station`, if there is one]
    #[arg(long, value_name = "FILE")]
    pub(crate) station: Option<PathBuf>,
    /// Show the session on the monitor with this name [default: that of the station]
    #[arg(long, value_name = "NAME")]
    pub(crate) monitor: Option<String>,
    /// Open a view for the experimenter: trial, time left, ratings so far; pause, stop, notes.
    #[arg(long)]
    pub(crate) experimenter: bool,
    /// Name of the monitor for that view [default: that of the station]
    #[arg(long, value_name = "NAME", requires = "experimenter")]
    pub(crate) experimenter_monitor: Option<String>,
    /// Try the session out, this many times faster; marked PILOT on the screen and in the data.
    #[arg(long, value_name = "SPEED", value_parser = pilot_speed)]
    pub(crate) pilot: Option<f64>,
}

#[derive(Debug, Args)]
pub(crate) struct ViewArguments {
    /// The monitor by its name.
    #[arg(long, value_name = "NAME")]
    pub(crate) monitor: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct CloseArguments {
    /// The protocol file.
    pub(crate) protocol: PathBuf,
    /// Code of the subject.
    #[arg(long)]
    pub(crate) subject: SubjectId,
    /// Why, in a few words.
    #[arg(long)]
    pub(crate) reason: String,
    /// Which sitting of the subject.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) session: u32,
    #[command(flatten)]
    pub(crate) data: DataFolder,
}

/// The colours of a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ThemeWord {
    /// Dark on light.
    Light,
    /// Light on dark.
    Dark,
}

#[derive(Debug, Args)]
pub(crate) struct StationArguments {
    /// The protocol whose angle is wanted.
    pub(crate) protocol: PathBuf,
    /// Measure on the screen itself: size by a bank card, distance, refresh, colour by a meter, the room.
    #[arg(long, conflicts_with_all = ["width_mm", "width_px", "distance_cm", "icc", "primaries"])]
    pub(crate) window: bool,
    /// Width of the picture on the screen, without the frame, by a ruler.
    #[arg(long, required_unless_present = "window")]
    pub(crate) width_mm: Option<f64>,
    /// Pixels of that width: the monitor's native resolution.
    #[arg(long, required_unless_present = "window")]
    pub(crate) width_px: Option<u32>,
    /// From the subject's eye to the screen [default: where a pixel subtends the protocol's angle]
    #[arg(long)]
    pub(crate) distance_cm: Option<f64>,
    /// Name of the monitor.
    #[arg(long, value_name = "NAME")]
    pub(crate) monitor: Option<String>,
    /// Peak luminance by a meter (ITU-R BT.500 advises 70 to 250 cd/m2 in a laboratory).
    #[arg(long)]
    pub(crate) peak_luminance: Option<f64>,
    /// Lights and surround, in words.
    #[arg(long)]
    pub(crate) surround: Option<String>,
    /// Luminance of what stands behind the screen, in cd/m2.
    #[arg(long)]
    pub(crate) background_luminance: Option<f64>,
    /// Light of the room on the screen, in lux.
    #[arg(long)]
    pub(crate) room_lux: Option<f64>,
    /// Name of the monitor for the experimenter's view.
    #[arg(long, value_name = "NAME")]
    pub(crate) experimenter_monitor: Option<String>,
    /// Colours of the window, as the app passes them on [default: dark]
    #[arg(long, value_enum, requires = "window")]
    pub(crate) theme: Option<ThemeWord>,
    /// Why the monitor runs at another resolution than its own (a cathode-ray tube, a projector); without it no session does.
    #[arg(long, value_name = "WORDS")]
    pub(crate) not_native_because: Option<String>,
    /// The monitor's ICC profile (primaries and curves) [default: sRGB by declaration]
    #[arg(long, value_name = "FILE", conflicts_with = "primaries")]
    pub(crate) icc: Option<PathBuf>,
    /// Chromaticities by a colorimeter: x,y of red, green, blue and white.
    #[arg(long, value_name = "X,Y,...", value_parser = chromaticities)]
    pub(crate) primaries: Option<[f64; 8]>,
    /// Exponent of the measured transfer curve [default: the curve of sRGB]
    #[arg(long, requires = "primaries")]
    pub(crate) gamma: Option<f64>,
    /// The station's file [default: ~/.config/acuity/station.toml]
    #[arg(short, long)]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct ExportArguments {
    /// The protocol file.
    pub(crate) protocol: PathBuf,
    /// New folder for a BIDS data set.
    #[arg(long, value_name = "DIR")]
    pub(crate) bids: PathBuf,
    #[command(flatten)]
    pub(crate) stimuli: StimuliFolder,
    #[command(flatten)]
    pub(crate) data: DataFolder,
}

#[derive(Debug, Args)]
pub(crate) struct SimulateArguments {
    /// The protocol file.
    pub(crate) protocol: PathBuf,
    /// How many observers.
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) subjects: u32,
    /// Seed of the observers.
    #[arg(long)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) stimuli: StimuliFolder,
    /// Folder of the simulated ratings [default: data/STUDY-simulated]
    #[arg(long)]
    pub(crate) data: Option<PathBuf>,
    /// Replace the simulated ratings that are there.
    #[arg(long)]
    pub(crate) replace: bool,
}

#[derive(Debug, Args)]
pub(crate) struct PredictArguments {
    /// The protocol file.
    pub(crate) protocol: PathBuf,
    #[command(flatten)]
    pub(crate) stimuli: StimuliFolder,
    /// The file of the predictions [default: reports/STUDY-predicted/predictions.csv]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct PowerArguments {
    /// The protocol file.
    pub(crate) protocol: PathBuf,
    /// Numbers of subjects: 6..30, 6..30/4 (every fourth), or 12.
    #[arg(long, default_value = "6..30/3", value_name = "RANGE", value_parser = subject_range)]
    pub(crate) subjects: SubjectRange,
    /// Simulated studies for each number of subjects.
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u32).range(20..=1_000_000))]
    pub(crate) studies: u32,
    /// Make an effect of the images' qualities larger or smaller, such as "channel=0.5" or "channel:rays=0". May be repeated.
    #[arg(long, value_name = "EFFECT=FACTOR", value_parser = effect_scale)]
    pub(crate) effect: Vec<EffectScale>,
    /// The level of significance.
    #[arg(long, default_value_t = 0.05, value_parser = share)]
    pub(crate) alpha: f64,
    /// The power that is wanted.
    #[arg(long, default_value_t = 0.8, value_parser = share)]
    pub(crate) target: f64,
    /// How often the subjects of a study are drawn again for the interval of an asymptote.
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u32).range(200..=100_000))]
    pub(crate) resamples: u32,
    /// The seed of the observers and of the resampled subjects.
    #[arg(long, default_value_t = 1992)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) stimuli: StimuliFolder,
    /// Folder for power.csv, power.json and power.svg [default: reports/STUDY-power]
    #[arg(long)]
    pub(crate) out: Option<PathBuf>,
    /// Print JSON, and write no files.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Numbers of subjects from a first to a last, with the same step between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SubjectRange {
    first: u32,
    last: u32,
    step: u32,
}

impl SubjectRange {
    /// Every number, rising; the last whether or not a step leads to it.
    pub(crate) fn numbers(self) -> Vec<u32> {
        let mut numbers: Vec<u32> = (self.first..=self.last)
            .step_by(self.step as usize)
            .collect();
        if numbers.last() != Some(&self.last) {
            numbers.push(self.last);
        }
        numbers
    }
}

fn subject_range(text: &str) -> Result<SubjectRange, String> {
    let parse = || {
        let (range, step) = text.split_once('/').unwrap_or((text, "1"));
        let (first, last) = range.split_once("..").unwrap_or((range, range));
        let [first, last, step] = [first.parse().ok()?, last.parse().ok()?, step.parse().ok()?];
        let is_usable = 2 <= first && first <= last && last <= 1000 && step > 0;
        is_usable.then_some(SubjectRange { first, last, step })
    };
    parse().ok_or_else(|| {
        format!("found {text:?}, expected FIRST..LAST or FIRST..LAST/STEP with 2 to 1000 subjects, such as 6..30/3")
    })
}

fn effect_scale(text: &str) -> Result<EffectScale, String> {
    let parse = || {
        let (effect, factor) = text.rsplit_once('=')?;
        Some(EffectScale {
            effect: effect.trim().to_owned(),
            factor: factor.trim().parse().ok()?,
        })
    };
    parse().ok_or_else(|| format!("found {text:?}, expected EFFECT=FACTOR, such as channel=0.5"))
}

fn share(text: &str) -> Result<f64, String> {
    let share = text
        .parse()
        .ok()
        .filter(|share: &f64| *share > 0.0 && *share < 1.0);
    share.ok_or_else(|| format!("found {text:?}, expected a number above 0 and below 1"))
}

#[derive(Debug, Args)]
pub(crate) struct ReplicateArguments {
    /// How many simulated observers.
    #[arg(long, default_value_t = 12, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    pub(crate) subjects: u32,
    /// Seed of the observers.
    #[arg(long, default_value_t = 1992)]
    pub(crate) seed: u64,
    /// The protocol file.
    #[arg(long, default_value = "protocols/meyer-liu-1992.toml")]
    pub(crate) protocol: PathBuf,
}

/// Whose cutoffs and viewing geometry limit an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Eye {
    /// Mullen's cutoffs (1985) where the paper's subjects sat.
    Paper,
    /// Those of a protocol.
    OfProtocol(PathBuf),
}

#[expect(clippy::unnecessary_wraps, reason = "the form of a value parser")]
fn eye(text: &str) -> Result<Eye, String> {
    Ok(match text {
        "paper" => Eye::Paper,
        path => Eye::OfProtocol(path.into()),
    })
}

fn size_px(text: &str) -> Result<[u32; 2], String> {
    let sides = text
        .split_once('x')
        .and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    sides
        .filter(|sides: &[u32; 2]| sides.iter().all(|side| (1..=16_384).contains(side)))
        .ok_or_else(|| format!("found the size {text:?}, expected WIDTHxHEIGHT in pixels, each from 1 to 16384, such as 320x320"))
}

fn quadrature(text: &str) -> Result<Quadrature, String> {
    text.to_owned().try_into()
}

fn export(text: &str) -> Result<Export, String> {
    let known = Export::ALL
        .into_iter()
        .find(|export| export.as_str() == text);
    known.ok_or_else(|| format!("found the export {text:?}, expected xyz, spectral or png16"))
}

fn driver(text: &str) -> Result<RefinementDriver, String> {
    match text {
        "A" => Ok(RefinementDriver::A),
        "AC1C2" => Ok(RefinementDriver::All),
        _ => Err(format!("found the driver {text:?}, expected A or AC1C2")),
    }
}

fn tolerance_steps(text: &str) -> Result<u8, String> {
    let steps = text
        .strip_suffix("/255")
        .and_then(|steps| steps.parse().ok());
    steps.filter(|&steps| steps > 0).ok_or_else(|| {
        format!("found {text:?}, expected K/255 with a whole K from 1 to 255, such as 1/255")
    })
}

fn channel(text: &str) -> Result<Channel, String> {
    let mut channels = Channel::ALL.into_iter();
    let found = channels.find(|channel| channel.to_string() == text);
    found.ok_or_else(|| format!("found the channel {text:?}, expected A, C1 or C2"))
}

fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let threads = text
        .parse()
        .ok()
        .filter(|threads: &NonZeroUsize| threads.get() <= 1024);
    threads.ok_or_else(|| format!("found {text:?} threads, expected a number from 1 to 1024"))
}

fn chromaticities(text: &str) -> Result<[f64; 8], String> {
    let numbers: Result<Vec<f64>, _> = text
        .split(',')
        .map(|number| number.trim().parse())
        .collect();
    let eight = numbers.ok().and_then(|numbers| numbers.try_into().ok());
    eight.ok_or_else(|| {
        format!("found {text:?}, expected eight numbers with commas between: x,y of red, green, blue and white")
    })
}

fn pilot_speed(text: &str) -> Result<f64, String> {
    let speed = text
        .parse()
        .ok()
        .filter(|speed: &f64| (1.0..=1000.0).contains(speed));
    speed.ok_or_else(|| {
        format!("found the speed {text:?}, expected a number from 1 to 1000, such as 20")
    })
}
