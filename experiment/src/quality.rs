//! How good each image looks to a published model of colour vision.
//!
//! ColorVideoVDP compares every image with the ten anchor (an own picture with the reference that its table
//! names, if any) and gives a quality in JOD (just-objectionable
//! differences): 10 for no visible difference, and one less for each difference that 75% of people would
//! call worse. A study's scale has its own ends, so the qualities are stretched onto it: the zero anchor
//! lies at its lowest rating, the ten anchor at its highest.
//!
//! Source: Mantiuk, Hanji, Ashraf, Asano & Chapiro (2024), "ColorVideoVDP: A visual difference predictor
//! for image, video and display distortions", ACM Transactions on Graphics 43(4).

use std::collections::BTreeMap;

use colorvideovdp::{
    Color, Cvvdp, DisplayModel, Execution, Geometry, Image, Options, Photometry, Prediction,
};
use protocols::{InputError, StimulusId, Study, Viewing};
use rayon::prelude::*;

use crate::{ExperimentError, ScreenImage, StimulusSet};

/// The contrast of a display in a dark room, as in ColorVideoVDP's own `standard_4k`.
const DISPLAY_CONTRAST: f64 = 1000.0;
/// What ColorVideoVDP gives for two pictures without a visible difference.
const NO_DIFFERENCE_JOD: f64 = 10.0;
/// Nothing else lights the screen.
const AMBIENT_LX: f64 = 0.0;

/// What the model of vision says of one image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Against its reference, in just-objectionable differences; 10 is perfect.
    pub jod: f64,
    /// The same on the study's scale: the anchors lie at its ends.
    pub on_scale: f64,
}

/// The quality of every image of the study.
///
/// # Errors
///
/// The images cannot be judged, or the model sees no difference between the anchors.
pub fn qualities(
    study: &Study,
    set: &StimulusSet,
) -> Result<BTreeMap<StimulusId, Quality>, ExperimentError> {
    let peak_cd_m2 = study.protocol.simulation.peak_luminance_cd_m2;
    let metric =
        metric(study.protocol.viewing, peak_cd_m2, set.size_px()).map_err(refused("size"))?;
    let stimuli = &study.protocol.stimuli;
    let judge = |(id, image): (&StimulusId, &ScreenImage)| {
        let reference = set.image(&stimuli.reference_of(id).unwrap_or_else(|| id.clone()))?;
        let judged = coded_image(image)
            .and_then(|test| metric.predict_image(&test, &coded_image(reference)?, Color::Srgb));
        let prediction: Prediction = judged.map_err(refused(id.as_str()))?;
        Ok((id.clone(), f64::from(prediction.jod)))
    };
    let jods: BTreeMap<StimulusId, f64> = set
        .images()
        .par_iter()
        .map(judge)
        .collect::<Result<_, ExperimentError>>()?;
    let [worst, best] = ends(study, &jods)?;
    let scale = study.protocol.session.scale;
    let (lowest, highest) = (f64::from(scale.lowest), f64::from(scale.highest));
    let stretched = |jod: f64| lowest + (highest - lowest) * (jod - worst) / (best - worst);
    let quality = |(id, jod): (StimulusId, f64)| {
        let on_scale = stretched(jod);
        (id, Quality { jod, on_scale })
    };
    Ok(jods.into_iter().map(quality).collect())
}

/// The qualities in JOD that lie at the ends of the scale: those of the anchors, or else those of the worst
/// image and of one that shows no difference.
fn ends(study: &Study, jods: &BTreeMap<StimulusId, f64>) -> Result<[f64; 2], InputError> {
    let stimuli = &study.protocol.stimuli;
    let of = |id: StimulusId| jods.get(&id).copied().unwrap_or(f64::NAN);
    let lowest = jods.values().copied().fold(NO_DIFFERENCE_JOD, f64::min);
    let worst = stimuli.zero_anchor().map_or(lowest, of);
    let best = stimuli.ten_anchor().map_or(NO_DIFFERENCE_JOD, of);
    // Below a thousandth of a JOD the stretched scale would be rounding errors.
    if best - worst >= 1e-3 && (best - worst).is_finite() {
        return Ok([worst, best]);
    }
    let found = format!("the worst image at {worst} JOD and the best at {best} JOD");
    let expected = "a zero anchor that looks worse than the ten anchor";
    let remedy = "name anchors in [stimuli.anchors], or references in the table of pictures";
    let error = InputError::new(&study.path, found, expected).at("field stimuli.anchors");
    Err(match stimuli.rendered() {
        Some(_) => error,
        None => error.remedy(remedy),
    })
}

/// How close an image looks to its reference, in just-objectionable differences; 10 is no visible difference.
///
/// The display is an sRGB monitor in the dark with this peak luminance.
///
/// # Errors
///
/// The images differ in size or are too small for the model.
pub fn visible_difference_jod(
    image: &ScreenImage,
    reference: &ScreenImage,
    viewing: Viewing,
    peak_luminance_cd_m2: f64,
) -> Result<f64, ExperimentError> {
    let judged = metric(viewing, peak_luminance_cd_m2, reference.size_px).and_then(|metric| {
        metric.predict_image(&coded_image(image)?, &coded_image(reference)?, Color::Srgb)
    });
    let prediction: Prediction = judged.map_err(|error| ExperimentError::Vision {
        stimulus: "the image".to_owned(),
        reason: error.to_string(),
    })?;
    Ok(f64::from(prediction.jod))
}

fn metric(viewing: Viewing, peak_cd_m2: f64, size_px: [u32; 2]) -> colorvideovdp::Result<Cvvdp> {
    let photometry = Photometry::new(peak_cd_m2, DISPLAY_CONTRAST, AMBIENT_LX, 0.0, 1.0)?;
    let size = size_px.map(|pixels| pixels as usize);
    let geometry = Geometry::from_ppd(size, viewing.pixels_per_degree())?;
    let display = DisplayModel::new("monitor of the study", photometry, geometry, "sRGB");
    let options = Options::default().with_execution(Execution::SingleThread);
    Cvvdp::new(display?, options)
}

fn coded_image(image: &ScreenImage) -> colorvideovdp::Result<Image> {
    let [width, height] = image.size_px.map(|pixels| pixels as usize);
    let values = image.rgb.iter().map(|&byte| f32::from(byte) / 255.0);
    Image::new(width, height, 3, values.collect())
}

fn refused(id: &str) -> impl Fn(colorvideovdp::Error) -> ExperimentError {
    let stimulus = id.to_owned();
    move |error| ExperimentError::Vision {
        stimulus: stimulus.clone(),
        reason: error.to_string(),
    }
}
