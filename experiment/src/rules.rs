//! What the session machine must know of the protocol.

use protocols::{Layout, RatingTime, ResponseStyle, Scale, SessionPlan};

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
        }
    }

    /// The same rules with the times of the images this many times shorter.
    #[must_use]
    pub fn faster(self, speed: f64) -> Self {
        Self {
            exposure_s: self.exposure_s / speed,
            pause_s: self.pause_s / speed,
            shortest_response_s: self.shortest_response_s / speed,
            ..self
        }
    }

    /// How many ratings one trial wants.
    pub fn marks(&self) -> usize {
        if self.layout == Layout::Dscqs { 2 } else { 1 }
    }
}
