//! The protocol: one TOML file that states a whole study.

use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::{
    Acuity, AnalysisPlan, InputError, Layout, ModelObserver, PicturePlan, PictureSet, SessionPlan,
    Stimuli, StimulusPlan, Viewing,
};

/// A whole study: its images, its sessions, its analysis. Unknown keys are refused.
#[derive(Clone, Debug, PartialEq)]
pub struct Protocol {
    /// The name of the study, and of its folders below `data/` and `reports/`.
    pub study: String,
    /// One line for the head of the report.
    pub title: String,
    /// Where the study comes from: a paper, a pre-registration.
    pub source: String,
    /// Which images are made.
    pub stimuli: Stimuli,
    /// Where the subject sits.
    pub viewing: Viewing,
    /// What the eye resolves from there; if it is said, no channel is refined beyond it.
    pub acuity: Option<Acuity>,
    /// How the images are shown and rated.
    pub session: SessionPlan,
    /// What a simulated observer is.
    pub simulation: ModelObserver,
    /// How the ratings are analysed.
    pub analysis: AnalysisPlan,
}

impl Protocol {
    /// Reads the text of a protocol, and beside `file` the table of own pictures, if it names one.
    ///
    /// # Errors
    ///
    /// The text is not TOML, has an unknown or missing key, a value out of range, or contradicts itself;
    /// the table cannot be used.
    pub fn from_toml(file: &Path, text: &str) -> Result<Self, InputError> {
        let stimuli: StimuliKind = parse(file, text, REMEDY)?;
        let protocol = if stimuli.has_images() {
            let written: Written<PicturePlan> =
                parse(file, text, "see \"Your own pictures\" in docs/manual.md")?;
            written.into_protocol(|plan| PictureSet::read(plan, file).map(Stimuli::Pictures))?
        } else {
            let written: Written<StimulusPlan> = parse(file, text, REMEDY)?;
            written.into_protocol(|plan| Ok(Stimuli::Rendered(plan)))?
        };
        match protocol.fault() {
            None => Ok(protocol),
            Some((field, found, expected)) => {
                Err(InputError::new(file, found, expected).at(format!("field {field}")))
            }
        }
    }

    fn fault(&self) -> Option<(&'static str, String, &'static str)> {
        let is_plain =
            |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'-';
        if !self.study.bytes().all(is_plain)
            || !self.study.bytes().any(|byte| byte.is_ascii_alphanumeric())
        {
            let expected = "lower-case letters, digits and '-' (it names folders)";
            return Some(("study", format!("{:?}", self.study), expected));
        }
        let stimuli = self.stimuli.rendered().and_then(StimulusPlan::fault);
        let factors = self.stimuli.factors();
        stimuli
            .or_else(|| self.viewing.fault())
            .or_else(|| self.acuity.and_then(Acuity::fault))
            .or_else(|| self.session.fault(&factors))
            .or_else(|| self.simulation.fault())
            .or_else(|| self.analysis.fault(&factors))
            .or_else(|| self.missing_anchors())
            .or_else(|| self.unknown_image())
    }

    fn missing_anchors(&self) -> Option<(&'static str, String, &'static str)> {
        let found = |layout: &str| format!("the layout {layout}, and not what it shows");
        let rated = self
            .stimuli
            .images()
            .into_iter()
            .filter(|image| image.is_rated);
        let lacks_reference = rated
            .map(|image| image.id)
            .find(|id| self.stimuli.reference_of(id).is_none());
        match self.session.layout {
            Layout::Flanking | Layout::Sequence if self.stimuli.zero_anchor().is_none() => Some((
                "session.layout",
                found("with two anchors"),
                "anchors in [stimuli.anchors], or the layout \"single\"",
            )),
            Layout::Dsis | Layout::Dscqs => lacks_reference.map(|id| {
                let expected = "anchors in [stimuli.anchors], or a reference for each picture";
                let found = found("with a reference");
                ("session.layout", format!("{found} for \"{id}\""), expected)
            }),
            _ => None,
        }
    }

    fn unknown_image(&self) -> Option<(&'static str, String, &'static str)> {
        let images = self.stimuli.images();
        let is_unknown = |id: &&crate::StimulusId| images.iter().all(|image| image.id != **id);
        let practice = self.session.practice.iter().find(is_unknown);
        let mut pages = self.session.pages.iter().flat_map(|page| &page.pictures);
        let unknown = practice.map(|id| ("session.practice", id));
        let unknown = unknown.or_else(|| Some(("session.pages.pictures", pages.find(is_unknown)?)));
        let (field, unknown) = unknown?;
        Some((
            field,
            format!("{:?}", unknown.as_str()),
            "images of the set, such as \"a140k_c140k\", or the name of a picture without .png",
        ))
    }
}

const REMEDY: &str = "compare it with protocols/meyer-liu-1992.toml";

fn parse<T: DeserializeOwned>(file: &Path, text: &str, remedy: &str) -> Result<T, InputError> {
    toml::from_str(text).map_err(|error| {
        let found = error.to_string();
        InputError::new(file, found.trim_end(), "a protocol (TOML)").remedy(remedy)
    })
}

/// Enough of the file to tell which kind of stimuli it states.
#[derive(Deserialize)]
struct StimuliKind {
    stimuli: Option<toml::Table>,
}

impl StimuliKind {
    fn has_images(&self) -> bool {
        let stimuli = self.stimuli.as_ref();
        stimuli.is_some_and(|table| table.contains_key("images"))
    }
}

/// The file as it is written, with stimuli of one kind: so an error in them keeps its line.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written<S> {
    study: String,
    title: String,
    source: String,
    stimuli: S,
    viewing: Viewing,
    #[serde(default)]
    acuity: Option<Acuity>,
    session: SessionPlan,
    simulation: ModelObserver,
    analysis: AnalysisPlan,
}

impl<S> Written<S> {
    fn into_protocol(
        self,
        stimuli: impl FnOnce(S) -> Result<Stimuli, InputError>,
    ) -> Result<Protocol, InputError> {
        Ok(Protocol {
            study: self.study,
            title: self.title,
            source: self.source,
            stimuli: stimuli(self.stimuli)?,
            viewing: self.viewing,
            acuity: self.acuity,
            session: self.session,
            simulation: self.simulation,
            analysis: self.analysis,
        })
    }
}
