//! The power of a study as text, as CSV and as JSON.

use std::fmt::Write as _;

use crate::anova_table::{quoted, shortest};
use crate::apa::fraction;
use crate::power::{AsymptoteWidth, Power, PowerPoint};
use crate::text_table::TextTable;

impl Power {
    /// As text for a terminal: a line for each number of subjects, then how many subjects each effect needs.
    pub fn to_text(&self) -> String {
        let settings = &self.settings;
        let mut text = format!(
            "Power at {}, by {} simulated studies a line (95% interval at most ± {})\n",
            settings.alpha,
            settings.n_studies,
            fraction(self.widest_half(), 3)
        );
        text.push_str(&self.table(power_fields));
        if self.points.iter().any(|point| !point.asymptotes.is_empty()) {
            text.push_str("\nWhere the curves flatten: mean width of the interval (and of the estimates, mean and SD)\n");
            text.push_str(&self.table(asymptote_fields));
        }
        // Writing to a `String` cannot fail, here and below.
        _ = writeln!(
            text,
            "\nSubjects from which on the power is at least {} (simple effects after Holm)",
            settings.target
        );
        let mut table = TextTable::new(&["effect", "subjects"]);
        for (effect, needed) in self.subjects_needed() {
            let most = settings.subjects.last().copied().unwrap_or_default();
            let needed = needed.map_or_else(|| format!("more than {most}"), |n| n.to_string());
            table.row(&[effect, needed]);
        }
        text + &table.to_text()
    }

    /// The largest half width of an interval.
    fn widest_half(&self) -> f64 {
        let effects = self.points.iter().flat_map(|point| &point.effects);
        effects.fold(0.0, |widest, one| widest.max((one.high - one.low) / 2.0))
    }

    /// A line for each number of subjects, with a field for each column that a point has.
    fn table(&self, columns: fn(&PowerPoint) -> Vec<(&str, String)>) -> String {
        let names = self.points.first().map(columns).into_iter().flatten();
        let header: Vec<&str> = std::iter::once("subjects")
            .chain(names.map(|(name, _)| name))
            .collect();
        let mut table = TextTable::new(&header);
        for point in &self.points {
            let mut fields = vec![point.subjects.to_string()];
            fields.extend(columns(point).into_iter().map(|(_, field)| field));
            table.row(&fields);
        }
        table.to_text()
    }

    /// A line for each number of subjects and each effect or asymptote.
    pub fn to_csv(&self) -> String {
        let mut csv =
            String::from("subjects,kind,name,studies,power,low,high,estimate,sd,width,unit\n");
        let studies = self.settings.n_studies;
        for point in &self.points {
            let subjects = point.subjects;
            let kinds = [
                ("effect", &point.effects),
                ("simple effect", &point.simple_effects),
            ];
            for (kind, one) in kinds
                .into_iter()
                .flat_map(|(kind, list)| list.iter().map(move |one| (kind, one)))
            {
                _ = writeln!(
                    csv,
                    "{subjects},{kind},{},{studies},{},{},{},,,,",
                    quoted(&one.effect),
                    shortest(one.power),
                    shortest(one.low),
                    shortest(one.high)
                );
            }
            for one in &point.asymptotes {
                _ = writeln!(
                    csv,
                    "{subjects},asymptote,{},{studies},,,,{},{},{},{}",
                    quoted(&one.curve),
                    shortest(one.estimate),
                    shortest(one.sd),
                    shortest(one.width),
                    quoted(&one.unit)
                );
            }
        }
        csv
    }

    /// All of it as JSON, with a line end.
    pub fn to_json(&self) -> String {
        // A struct of numbers and text cannot fail to be written.
        let mut json = serde_json::to_string_pretty(self).unwrap_or_default();
        json.push('\n');
        json
    }
}

/// The power of each effect.
fn power_fields(point: &PowerPoint) -> Vec<(&str, String)> {
    let effects = point.effects.iter();
    effects
        .map(|one| (one.effect.as_str(), fraction(one.power, 3)))
        .collect()
}

/// The width of each interval, and of the estimates mean and SD.
fn asymptote_fields(point: &PowerPoint) -> Vec<(&str, String)> {
    let field = |one: &AsymptoteWidth| {
        let unit = &one.unit;
        format!(
            "{:.1}{unit} ({:.1}{unit}, {:.1}{unit})",
            one.width, one.estimate, one.sd
        )
    };
    let asymptotes = point.asymptotes.iter();
    asymptotes
        .map(|one| (one.curve.as_str(), field(one)))
        .collect()
}
