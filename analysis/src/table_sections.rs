//! The sections of a report on tables that a report on a study of ours words otherwise.

use crate::TableStudy;
use crate::document::{Block, Document, Section, Style};
use crate::findings::Findings;
use crate::page::escaped;
use crate::rich_text::plain;
use crate::table_study::TableNumbers;

/// With more cells their means stand in a file only.
const MOST_CELLS: usize = 200;

/// All that the sections speak of.
pub(crate) struct TableSections<'a> {
    pub(crate) study: &'a TableStudy,
    pub(crate) numbers: &'a TableNumbers,
    /// The figure in the colours of the page.
    pub(crate) figure_svg: String,
}

impl TableSections<'_> {
    /// The whole report.
    pub(crate) fn document(&self) -> Document {
        let findings = self.findings();
        let sections = [
            self.banners(),
            Some(findings.result_of_effects()),
            Some(self.figure()),
            Some(findings.anova()),
            findings.published(),
            findings.asymptotes(),
            Some(self.means()),
            findings.follow_ups(),
            findings.distribution_free(),
            findings.agreement(&[]),
            Some(findings.fragility()),
            Some(self.data()),
            Some(self.to_paste()),
            Some(self.provenance()),
        ];
        let source = escaped(&self.study.source);
        let n_ratings = self.n_rated();
        let facts = format!("{} · {n_ratings} ratings", findings.who);
        Document {
            study: escaped(&self.study.study),
            title: escaped(&self.study.title),
            bylines: [source, facts]
                .into_iter()
                .filter(|line| !line.is_empty())
                .collect(),
            sections: sections.into_iter().flatten().collect(),
        }
    }

    pub(crate) fn findings(&self) -> Findings<'_> {
        let numbers = self.numbers;
        let n_subjects = numbers.cells.subjects.len();
        let noun = if numbers.observations.has_simulated {
            "simulated observer"
        } else {
            "subject"
        };
        let plural = if n_subjects == 1 { "" } else { "s" };
        let mut ratings = numbers.observations.ratings.iter().flatten();
        Findings {
            plan: &self.study.plan,
            table: &numbers.table,
            cells: &numbers.cells,
            fragility: &numbers.fragility,
            observers: numbers.observers.as_ref(),
            n_subjects,
            n_groups: numbers.cells.n_groups(),
            who: format!("{n_subjects} {noun}{plural}"),
            scale: self.study.scale,
            is_simulated: numbers.observations.has_simulated,
            are_whole: ratings.all(|rating| rating.fract() == 0.0),
        }
    }

    /// How many rows have a rating.
    fn n_rated(&self) -> usize {
        self.numbers.observations.ratings.iter().flatten().count()
    }

    fn banners(&self) -> Option<Section> {
        let mut banners = Vec::new();
        if self.numbers.observations.has_simulated {
            banners.push(
                "<strong>SIMULATED.</strong> By the column <code>observer</code> of the tables no person gave these ratings: they are \
                 no evidence about people."
                    .to_owned(),
            );
        }
        banners.extend(self.findings().too_few());
        let section = Section::without_heading().paragraphs(Style::Banner, banners);
        (!section.blocks.is_empty()).then_some(section)
    }

    fn figure(&self) -> Section {
        let (all, shown) = (&self.numbers.means.factors, &self.numbers.shown.factors);
        let averaged: Vec<String> = (all.iter())
            .filter(|name| !shown.contains(name))
            .map(|name| escaped(name))
            .collect();
        let averaged = if averaged.is_empty() {
            String::new()
        } else {
            format!(", averaged over {}", averaged.join(" and "))
        };
        let shown: Vec<String> = shown.iter().map(|name| escaped(name)).collect();
        let has_within = self
            .numbers
            .shown
            .cells
            .iter()
            .any(|cell| cell.summary.half_within.is_some());
        let bars = if has_within {
            "within-subject intervals (Cousineau–Morey): they are for comparing levels within subjects, not for comparing groups"
        } else {
            "intervals of the mean over subjects (<i>t</i>)"
        };
        let findings = self.findings();
        Section::without_heading().block(Block::Figure {
            svg: self.figure_svg.clone(),
            file: "figure".to_owned(),
            caption: format!(
                "Mean {} of {} for each level of {}{averaged}. Bars are {} {bars}.",
                escaped(&self.study.design.rating),
                findings.who,
                shown.join(" and "),
                findings.percent(),
            ),
        })
    }

    fn means(&self) -> Section {
        let n_cells = self.numbers.means.cells.len();
        if n_cells > MOST_CELLS {
            return Section::new("Means").paragraph(format!(
                "The means of all {n_cells} cells, with their intervals, stand in <code>means.csv</code>."
            ));
        }
        self.findings().means_of_cells(&self.numbers.means, "")
    }

    /// What was read and what was not.
    fn data(&self) -> Section {
        let observations = &self.numbers.observations;
        let (n_files, n_rows) = (self.numbers.files.len(), observations.len());
        let files = if n_files == 1 { "file" } else { "files" };
        let mut facts = vec![format!(
            "{n_rows} rows of {n_files} {files} are ratings; {} of them {} no value.",
            n_rows - self.n_rated(),
            if n_rows - self.n_rated() == 1 {
                "has"
            } else {
                "have"
            }
        )];
        let filters: Vec<String> = (self.study.design.filters.iter())
            .map(|filter| format!("<code>{}</code>", escaped(&filter.to_string())))
            .collect();
        if observations.n_filtered > 0 {
            facts.push(format!(
                "{} rows are left out by {}.",
                observations.n_filtered,
                if filters.is_empty() {
                    "the exclusions of the protocol".to_owned()
                } else {
                    filters.join(" and ")
                }
            ));
        }
        let dropped = &self.numbers.cells.dropped_subjects;
        facts.push(if dropped.is_empty() {
            "Nobody was left out: every subject has a rating in every cell.".to_owned()
        } else {
            let names = escaped(&dropped.join(", "));
            format!("Left out, because a rating is missing: {names}.")
        });
        if self.numbers.cells.n_averaged_cells > 0 {
            facts.push(format!(
                "{} cells were rated more than once by a subject; their ratings were averaged.",
                self.numbers.cells.n_averaged_cells
            ));
        }
        Section::new("The data").list(Style::Plain, facts)
    }

    /// The methods paragraph, as far as tables say it.
    fn methods(&self) -> String {
        let findings = self.findings();
        let numbers = self.numbers;
        let factors: Vec<String> = (numbers.means.factors.iter().zip(&numbers.means.levels))
            .map(|(name, levels)| format!("{} ({} levels)", escaped(name), levels.len()))
            .collect();
        let left_out = match numbers.cells.dropped_subjects.len() {
            0 => "nobody was left out".to_owned(),
            1 => "1 more lacked a rating and was left out".to_owned(),
            n => format!("{n} more lacked a rating and were left out"),
        };
        let mut sentences = vec![format!(
            "The data are the {} of {} by {}; {left_out}.",
            escaped(&self.study.design.rating),
            findings.who,
            factors.join(" and ")
        )];
        sentences.push(findings.of_analysis());
        sentences.extend(findings.of_what_follows());
        let digests: Vec<String> = (numbers.files.iter())
            .map(|(_, sha256)| sha256.to_string().chars().take(12).collect::<String>() + "…")
            .collect();
        sentences.push(if digests.len() > 4 {
            format!("Analysed with Acuity {}.", env!("CARGO_PKG_VERSION"))
        } else {
            format!(
                "Analysed with Acuity {} (SHA-256 of the data {}).",
                env!("CARGO_PKG_VERSION"),
                digests.join(", ")
            )
        });
        sentences.join(" ")
    }

    fn to_paste(&self) -> Section {
        Section::new("To paste into a paper")
            .paragraph(self.methods())
            .list(Style::Plain, self.findings().sentences())
    }

    /// The paragraph and the sentences as plain text.
    pub(crate) fn to_paste_as_text(&self) -> String {
        let sentences = self.findings().sentences();
        let lines: Vec<String> = sentences.iter().map(|text| plain(text)).collect();
        format!("{}\n\n{}\n", plain(&self.methods()), lines.join("\n"))
    }

    fn provenance(&self) -> Section {
        let mut entries = Vec::new();
        if let Some((path, sha256)) = &self.study.protocol {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            entries.push((
                "Protocol",
                format!("{}, SHA-256 <code>{sha256}</code>", escaped(&name)),
            ));
        }
        let files = self.numbers.files.iter();
        entries.extend(files.map(|(name, sha256)| {
            (
                "Data",
                format!("{}, SHA-256 <code>{sha256}</code>", escaped(name)),
            )
        }));
        entries.push(("Program", format!("Acuity {}", env!("CARGO_PKG_VERSION"))));
        entries.push((
            "Files",
            format!(
                "<code>report.pdf</code>, <code>report.md</code>, <code>tables.tex</code>, <code>to-paste.txt</code>, <code>anova.json</code>, \
                 <code>anova.csv</code>, <code>follow-ups.csv</code>, <code>asymptotes.csv</code>, <code>means.csv</code>, {}\
                 <code>figure</code> as <code>.svg</code>, <code>-outlined.svg</code>, <code>.pdf</code> and <code>.png</code> (300 dpi) \
                 beside this page",
                self.findings().observer_files()
            ),
        ));
        Section::new("Where this comes from").block(Block::Terms(entries))
    }
}
