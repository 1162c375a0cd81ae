//! The section of a report that says where the sessions departed from the protocol, and that they did not.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use protocols::Observer;

use crate::document::{Section, Style};
use crate::page::escaped;
use crate::sections::Sections;
use crate::study_ratings::SessionRecord;

/// Two stations are alike if their angles of a pixel differ by less than this part.
const SAME_ANGLE: f64 = 0.02;

impl Sections<'_> {
    pub(crate) fn deviations(&self) -> Section {
        let mut items = vec![self.of_protocol(), self.of_images(), self.of_programs()];
        items.push(self.of_incomplete());
        items.extend(self.of_sittings());
        if self.ratings.observer == Observer::Person {
            items.push(self.of_stations());
            items.push(self.of_angles());
            items.push(self.of_exposures());
        }
        items.extend(self.of_pilots());
        Section::new("Deviations from the protocol").list(Style::Plain, items)
    }

    fn sessions(&self) -> &[SessionRecord] {
        &self.ratings.sessions
    }

    /// The files of sessions with some property, by subject and sitting.
    fn named(&self, is_meant: impl Fn(&SessionRecord) -> bool) -> Vec<String> {
        (self.sessions().iter())
            .filter(|session| is_meant(session))
            .map(|session| format!("subject {}, session {}", session.subject, session.session))
            .collect()
    }

    fn of_protocol(&self) -> String {
        let here = self.study.sha256.to_string();
        let has = |session: &SessionRecord, same: bool| {
            let sha256 = session.sidecar.protocol_sha256.as_deref();
            sha256.is_some_and(|sha256| (sha256 == here) == same)
        };
        let other = self.named(|session| has(session, false));
        let unknown = self.named(|session| session.sidecar.protocol_sha256.is_none());
        let mut text = match other.as_slice() {
            [] if unknown.is_empty() => {
                "Protocol: every session followed the file that is analysed here (same SHA-256)."
                    .to_owned()
            }
            [] => "Protocol: no session is known to have followed another file.".to_owned(),
            some => format!(
                "<b>Protocol: changed.</b> Under another version of the file: {}.",
                some.join("; ")
            ),
        };
        if !unknown.is_empty() {
            // Writing to a `String` cannot fail.
            _ = write!(text, " <b>Not known</b> for {}.", unknown.join("; "));
        }
        text
    }

    fn of_images(&self) -> String {
        let counts = counted(self.sessions(), |session| {
            session.sidecar.manifest_sha256.clone()
        });
        match counts.len() {
            0 => "Images: the sidecars do not say which were shown.".to_owned(),
            1 => "Images: the same set in every session that says.".to_owned(),
            n => format!(
                "<b>Images: {n} different sets</b> were shown, by the digests of their manifests."
            ),
        }
    }

    fn of_programs(&self) -> String {
        let counts = counted(self.sessions(), |session| {
            session.sidecar.acuity_version.clone()
        });
        match counts.len() {
            0 => "Program: the sidecars do not name its version.".to_owned(),
            1 => "Program: one version in every session that says.".to_owned(),
            n => format!(
                "<b>Program: {n} versions</b> took the ratings: {}.",
                in_words(&counts)
            ),
        }
    }

    fn of_incomplete(&self) -> String {
        let closed: Vec<String> = (self.sessions().iter())
            .filter_map(|session| {
                let reason = session.sidecar.closed.as_ref()?;
                Some(format!("subject {} ({})", session.subject, escaped(reason)))
            })
            .collect();
        let closed = if closed.is_empty() {
            String::new()
        } else {
            format!(" Closed before the end: {}.", closed.join("; "))
        };
        match self.analysis.incomplete.as_slice() {
            [] => format!("Sessions: all complete.{closed}"),
            some => {
                let names: Vec<String> = some.iter().map(|one| escaped(&one.to_string())).collect();
                format!(
                    "<b>Sessions: incomplete and left out:</b> {}.{closed}",
                    names.join(", ")
                )
            }
        }
    }

    fn of_sittings(&self) -> Vec<String> {
        let cut_off = self.named(|session| session.sidecar.sittings_cut_off > 0);
        let resumed = self.named(|session| session.sidecar.sittings > 1);
        let unfocused = self.named(|session| session.sidecar.focus_losses > 0);
        let mut items = Vec::new();
        for (what, named) in [
            ("Cut off (a crash, or the mains)", cut_off),
            ("In more than one sitting", resumed),
            ("The window lost the keyboard", unfocused),
        ] {
            if !named.is_empty() {
                items.push(format!("<b>{what}:</b> {}.", named.join("; ")));
            }
        }
        items
    }

    fn of_stations(&self) -> String {
        let counts = counted(self.sessions(), |session| {
            let stations = session.sidecar.stations.iter();
            let named: Vec<String> = stations
                .map(|station| escaped(&station.in_words()))
                .collect();
            (!named.is_empty()).then(|| named.join(", then "))
        });
        match counts.len() {
            0 => "Station: the sidecars do not describe it.".to_owned(),
            1 => format!(
                "Station: one in every session that says, {}.",
                in_words(&counts)
            ),
            n => format!(
                "<b>Stations: {n} different ones:</b> {}.",
                in_words(&counts)
            ),
        }
    }

    fn of_angles(&self) -> String {
        let planned = self.study.protocol.viewing.degrees_per_pixel;
        let angles: Vec<f64> = (self.sessions().iter())
            .flat_map(|session| &session.sidecar.stations)
            .filter_map(|station| station.degrees_per_pixel)
            .collect();
        if angles.is_empty() {
            return "Viewing distance: not measured (no station file), so the angle of a pixel is not known.".to_owned();
        }
        let worst = angles.iter().fold(0.0_f64, |worst, angle| {
            worst.max((angle / planned - 1.0).abs())
        });
        if worst < SAME_ANGLE {
            format!(
                "Viewing: a pixel subtended {planned}° within {:.1}% wherever it was measured.",
                100.0 * worst
            )
        } else {
            format!(
                "<b>Viewing: the angle of a pixel differed</b> from the {planned}° of the protocol by up to {:.1}%.",
                100.0 * worst
            )
        }
    }

    fn of_exposures(&self) -> String {
        let planned = self.study.protocol.session.exposure_s;
        let worst_s = (self.sessions().iter())
            .map(|session| session.largest_exposure_error_s)
            .fold(0.0, f64::max);
        format!(
            "Exposure: {planned} s as submitted, within {:.0} ms in every trial.",
            1000.0 * worst_s
        )
    }

    fn of_pilots(&self) -> Vec<String> {
        let mut items = Vec::new();
        let included = self.named(|session| session.is_pilot);
        if !included.is_empty() {
            items.push(format!(
                "<b>Trial runs are included:</b> {}.",
                included.join("; ")
            ));
        }
        if !self.ratings.pilots_left_out.is_empty() {
            items.push(format!(
                "Trial runs left out: {}.",
                self.ratings.pilots_left_out.len()
            ));
        }
        items
    }
}

/// How many sessions have each value; those without are not counted.
fn counted(
    sessions: &[SessionRecord],
    of: impl Fn(&SessionRecord) -> Option<String>,
) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for value in sessions.iter().filter_map(of) {
        *counts.entry(value).or_insert(0) += 1;
    }
    counts
}

fn in_words(counts: &BTreeMap<String, usize>) -> String {
    let each: Vec<String> = (counts.iter())
        .map(|(value, count)| {
            format!(
                "{value} ({count} session{})",
                if *count == 1 { "" } else { "s" }
            )
        })
        .collect();
    each.join("; ")
}
