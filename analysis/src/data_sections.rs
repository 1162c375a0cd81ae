//! The sections of a report that say how good the data are and where they come from.

use protocols::{Observer, Stimuli, Study};

use crate::document::{Block, Section, Style, Table};
use crate::page::escaped;
use crate::sections::Sections;
use crate::study_ratings::SessionRecord;

impl Sections<'_> {
    pub(crate) fn quality(&self) -> Section {
        let mut facts = vec![match self.analysis.incomplete.as_slice() {
            [] => format!("All {} rated every image.", self.who()),
            some => {
                let names: Vec<String> = some.iter().map(ToString::to_string).collect();
                format!(
                    "Left out, because ratings are missing: {}.",
                    names.join(", ")
                )
            }
        }];
        match self.ratings.observer {
            Observer::Simulated => {
                facts.push(
                    "No image was shown, so there are no late frames and no exposures to check."
                        .to_owned(),
                );
            }
            Observer::Person => facts.extend(self.timing()),
        }
        if !self.ratings.pilots_left_out.is_empty() {
            facts.push(format!(
                "Trial runs left out: {}.",
                escaped(&self.ratings.pilots_left_out.join(", "))
            ));
        }
        facts.extend(
            self.ratings
                .warnings
                .iter()
                .map(|warning| escaped(warning) + "."),
        );
        let columns = [
            "Subject",
            "session",
            "started (UTC)",
            "rated",
            "late frames",
            "median answer",
            "SHA-256 of the ratings",
        ];
        let mut table = Table::new("The sessions.", &columns);
        for session in &self.ratings.sessions {
            table.row(&session_cells(session, self.ratings.observer));
        }
        Section::new("Quality of the data")
            .list(Style::Plain, facts)
            .table(table)
    }

    fn timing(&self) -> [String; 2] {
        let sessions = &self.ratings.sessions;
        let n_late: u32 = sessions.iter().map(|session| session.missed_frames).sum();
        let n_trials: usize = sessions
            .iter()
            .map(|session| session.trials_with_missed_frames)
            .sum();
        let n_all: usize = sessions.iter().map(|session| session.n_rated).sum();
        let worst_s = (sessions.iter())
            .map(|session| session.largest_exposure_error_s)
            .fold(0.0, f64::max);
        [
            format!("{n_late} frames came late, in {n_trials} of {n_all} trials."),
            format!(
                "The exposure submitted differed from the one asked for by at most {:.0} ms. It is a software time: the onset \
                 of light was not measured.",
                1000.0 * worst_s
            ),
        ]
    }

    /// With which versions of the program the ratings were taken, as far as the sidecars say.
    fn taken_with(&self) -> String {
        let mut versions: Vec<&str> = (self.ratings.sessions.iter())
            .filter_map(|session| session.sidecar.acuity_version.as_deref())
            .collect();
        versions.sort_unstable();
        versions.dedup();
        if versions.is_empty() {
            return String::new();
        }
        format!("; ratings taken with {}", escaped(&versions.join(" and ")))
    }

    pub(crate) fn provenance(&self) -> Section {
        let protocol = self
            .study
            .path
            .file_name()
            .map_or_else(String::new, |name| escaped(&name.to_string_lossy()));
        let entries = vec![
            (
                "Protocol",
                format!("{protocol}, SHA-256 <code>{}</code>", self.study.sha256),
            ),
            (
                "Ratings",
                format!(
                    "{} files, SHA-256 of their digests <code>{}</code>",
                    self.ratings.sessions.len(),
                    self.ratings.sha256()
                ),
            ),
            (
                "Program",
                format!("Acuity {}{}", env!("CARGO_PKG_VERSION"), self.taken_with()),
            ),
            (
                "Files",
                format!(
                    "<code>report.pdf</code>, <code>report.md</code>, <code>tables.tex</code>, <code>to-paste.txt</code>, <code>anova.json</code>, <code>anova.csv</code>, \
                     <code>follow-ups.csv</code>, <code>asymptotes.csv</code>, <code>means.csv</code>, {}<code>{}</code>{} as \
                     <code>.svg</code>, <code>-outlined.svg</code>, <code>.pdf</code> and <code>.png</code> (300 dpi) beside this page",
                    self.findings().observer_files(),
                    figure_name(self.study),
                    if self.plain_svg.is_some() {
                        format!(" and <code>{PLAIN_FIGURE}</code>")
                    } else {
                        String::new()
                    }
                ),
            ),
        ];
        Section::new("Where this comes from").block(Block::Terms(entries))
    }
}

/// The name of the files of the paper's figure in the form in which it was published.
pub(crate) const PLAIN_FIGURE: &str = "figure-10-plain";

/// The name of the figure's files: the paper's number for the paper's figure.
pub(crate) fn figure_name(study: &Study) -> &'static str {
    match study.protocol.stimuli {
        Stimuli::Rendered(_) => "figure-10",
        Stimuli::Pictures(_) => "figure",
    }
}

fn session_cells(session: &SessionRecord, observer: Observer) -> Vec<String> {
    let started: String = match observer {
        Observer::Person => session.started_at.chars().take(16).collect(),
        Observer::Simulated => "virtual clock".to_owned(),
    };
    let pilot = if session.is_pilot { " (pilot)" } else { "" };
    vec![
        format!("{}{pilot}", session.subject),
        session.session.to_string(),
        escaped(&started.replace('T', " ")),
        session.n_rated.to_string(),
        session.missed_frames.to_string(),
        format!("{:.1} s", session.median_response_time_s),
        format!(
            "<code>{}…</code>",
            session.sha256.as_str().get(..12).unwrap_or_default()
        ),
    ]
}
