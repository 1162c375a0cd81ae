//! What the session machine must know of the protocol.

use protocols::{BreakPlan, Layout, RatingTime, ResponseStyle, Scale, SessionPlan};

/// Breaks between the test trials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Breaks {
    /// After so many test trials.
    pub every: u32,
    /// How long one is.
    pub seconds: f64,
    /// Whether the subject may go on before it is over.
    pub can_be_cut_short: bool,
}

impl From<&BreakPlan> for Breaks {
    fn from(plan: &BreakPlan) -> Self {
        Self {
            every: plan.every,
            seconds: plan.seconds,
            can_be_cut_short: plan.can_be_cut_short,
        }
    }
}

/// The protocol's layout, scale and times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// How the anchors stand to the test image.
    pub layout: Layout,
    /// For how long the images are shown (in a sequence, each of them).
    pub exposure_s: f64,
    /// Grey before each exposure.
    pub pause_s: f64,
    /// The rating scale.
    pub scale: Scale,
    /// The form of the scale.
    pub response: ResponseStyle,
    /// When the scale is there.
    pub rating: RatingTime,
    /// An answer sooner than this is not taken.
    pub shortest_response_s: f64,
    /// Without an answer by then the images are shown again.
    pub longest_response_s: f64,
    /// How many pages follow the instructions.
    pub pages: usize,
    /// The breaks.
    pub breaks: Option<Breaks>,
}

impl Rules {
    /// The rules of a session at the speed of its protocol.
    pub fn of(plan: &SessionPlan) -> Self {
        Self {
            layout: plan.layout,
            exposure_s: plan.exposure_s,
            pause_s: plan.pause_s,
            scale: plan.scale,
            response: plan.response,
            rating: plan.rating,
            shortest_response_s: plan.shortest_response_s.unwrap_or(0.0),
            longest_response_s: plan.longest_response_s.unwrap_or(f64::INFINITY),
            pages: plan.pages.len(),
            breaks: plan.breaks.as_ref().map(Breaks::from),
        }
    }

    /// The same rules with the times of the images this many times shorter.
    #[must_use]
    pub fn faster(self, speed: f64) -> Self {
        Self {
            exposure_s: self.exposure_s / speed,
            pause_s: self.pause_s / speed,
            shortest_response_s: self.shortest_response_s / speed,
            breaks: self.breaks.map(|breaks| Breaks {
                seconds: breaks.seconds / speed,
                ..breaks
            }),
            ..self
        }
    }

    /// How many ratings one trial wants.
    pub fn marks(&self) -> usize {
        if self.layout == Layout::Dscqs { 2 } else { 1 }
    }
}
