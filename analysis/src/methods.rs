//! What can be pasted into a paper: a methods paragraph and the results in the style of the APA.
//!
//! Every number comes from the protocol or the data; what neither says is not claimed.

use std::fmt::Write as _;

use protocols::{Observer, OrderScheme, RatingTime, ResponseStyle, Stimuli};

use crate::document::{Section, Style};
use crate::rich_text::plain;
use crate::sections::Sections;
use crate::study_in_words::design_in_words;

impl Sections<'_> {
    pub(crate) fn to_paste(&self) -> Section {
        Section::new("To paste into a paper")
            .paragraph(self.methods())
            .list(Style::Plain, self.findings().sentences())
    }

    /// The methods paragraph.
    pub(crate) fn methods(&self) -> String {
        let mut sentences = vec![self.of_people(), design_in_words(&self.study.protocol)];
        sentences.push(self.of_viewing());
        sentences.push(self.of_procedure());
        let findings = self.findings();
        sentences.push(findings.of_analysis());
        sentences.extend(findings.of_what_follows());
        sentences.push(self.of_software());
        sentences.join(" ")
    }

    fn of_people(&self) -> String {
        let sessions = self.ratings.sessions.len();
        let left_out = match self.analysis.incomplete.len() {
            0 => "nobody was left out".to_owned(),
            n => format!("{n} more did not rate every image and were left out"),
        };
        let plural = if sessions == 1 { "" } else { "s" };
        let took_part = match self.ratings.observer {
            Observer::Person => "took part",
            Observer::Simulated => {
                "(ColorVideoVDP with a bias, gain and noise of each) rated the images"
            }
        };
        format!(
            "{} {took_part}, in {sessions} session{plural}; {left_out}.",
            self.who()
        )
    }

    fn of_viewing(&self) -> String {
        let protocol = &self.study.protocol;
        let viewing = protocol.viewing;
        let pixel = format!(
            "{} cm from the screen, where a pixel ({:.3} mm) subtended {}°",
            viewing.distance_cm,
            viewing.pixel_pitch_mm(),
            viewing.degrees_per_pixel
        );
        let seen = match self.ratings.observer {
            Observer::Person => "Subjects sat",
            Observer::Simulated => "The modelled observers sat",
        };
        match &protocol.stimuli {
            Stimuli::Rendered(plan) => {
                let [width, height] = plan.size_px;
                let angle = |pixels: u32| f64::from(pixels) * viewing.degrees_per_pixel;
                format!(
                    "{seen} {pixel} and an image ({width} × {height} pixels) {:.2}° × {:.2}°.",
                    angle(width),
                    angle(height)
                )
            }
            Stimuli::Pictures(_) => format!("{seen} {pixel}."),
        }
    }

    fn of_procedure(&self) -> String {
        let session = &self.study.protocol.session;
        let order = match session.order.scheme {
            OrderScheme::Shuffled => format!(
                "in a random order of each subject’s own (seed {})",
                session.order_seed
            ),
            OrderScheme::LatinSquare => {
                "in the order of a row of a balanced Latin square".to_owned()
            }
        };
        let times = match session.blocks {
            1 => "once".to_owned(),
            n => format!("{n} times"),
        };
        let practice = match session.practice.len() {
            0 => String::new(),
            1 => " after 1 practice trial".to_owned(),
            n => format!(" after {n} practice trials"),
        };
        let response = match session.response {
            ResponseStyle::Buttons => "on buttons with whole numbers",
            ResponseStyle::Labelled => "on a scale with a word for each rating",
            ResponseStyle::Continuous => "on an upright bar",
        };
        let when = match session.rating {
            RatingTime::AfterExposure => "after the exposure",
            RatingTime::DuringExposure => "while the images stood",
        };
        let mut text = format!(
            "Each image was rated {times}, {order}{practice}; ratings were given {response}, {when}, and {} s of grey (sRGB {}) \
             followed.",
            session.pause_s, session.background_srgb
        );
        if self.ratings.observer == Observer::Person {
            let sessions = &self.ratings.sessions;
            let late: u32 = sessions.iter().map(|session| session.missed_frames).sum();
            let trials: usize = sessions.iter().map(|session| session.n_rated).sum();
            // Writing to a `String` cannot fail.
            _ = write!(text, " In {trials} trials {late} frames came late.");
        }
        text
    }

    fn of_software(&self) -> String {
        let start = |sha256: &dyn std::fmt::Display| {
            sha256.to_string().chars().take(12).collect::<String>()
        };
        format!(
            "Analysed with Acuity {} (SHA-256 of the protocol {}…, of the ratings {}…).",
            env!("CARGO_PKG_VERSION"),
            start(&self.study.sha256),
            start(&self.ratings.sha256())
        )
    }

    /// The paragraph and the sentences as plain text.
    pub(crate) fn to_paste_as_text(&self) -> String {
        let mut text = plain(&self.methods());
        text.push('\n');
        for sentence in self.findings().sentences() {
            text.push('\n');
            text.push_str(&plain(&sentence));
        }
        text.push('\n');
        text
    }
}
