//! The files of a report, in every format, of one document and one analysis.

use std::path::{Path, PathBuf};

use protocols::{Access, write_atomically};

use crate::document::Document;
use crate::picture::FigurePicture;
use crate::{AnalysisError, TableAnalysis};

/// What the files are made from.
pub(crate) struct ReportFiles<'a> {
    pub(crate) document: &'a Document,
    pub(crate) table: &'a TableAnalysis,
    /// The methods paragraph and the sentences.
    pub(crate) to_paste: String,
    pub(crate) means_csv: String,
    /// The name of each figure, and the figure as SVG for paper.
    pub(crate) figures: Vec<(&'static str, String)>,
    /// The curves of each observer, likewise.
    pub(crate) observers: Option<String>,
}

impl ReportFiles<'_> {
    /// Each file with its name, the page first.
    ///
    /// # Errors
    ///
    /// A figure that cannot be drawn.
    pub(crate) fn files(self) -> Result<Vec<(String, Vec<u8>)>, AnalysisError> {
        let text = |name: &str, text: String| (name.to_owned(), text.into_bytes());
        let mut files = vec![
            text("report.html", self.document.to_html()),
            text("report.md", self.document.to_markdown()),
            ("report.pdf".to_owned(), self.document.to_pdf()?),
            text("tables.tex", self.document.to_latex()),
            text("to-paste.txt", self.to_paste),
            text("anova.json", self.table.to_json()),
            text("anova.csv", self.table.anova.to_csv()),
            text("follow-ups.csv", self.table.follow_ups_csv()),
            text("asymptotes.csv", self.table.asymptotes_csv()),
            text("means.csv", self.means_csv),
        ];
        for (name, svg) in self.figures {
            let picture = FigurePicture::new(&svg)?;
            files.push((format!("{name}.png"), picture.to_png()?));
            files.push((format!("{name}.pdf"), picture.to_pdf()));
            files.push(text(&format!("{name}-outlined.svg"), picture.to_outlines()));
            files.push(text(&format!("{name}.svg"), svg));
        }
        if let Some(svg) = self.observers {
            files.push((
                "observers.png".to_owned(),
                FigurePicture::new(&svg)?.to_png()?,
            ));
            files.push(text("observers.svg", svg));
        }
        Ok(files)
    }
}

/// Writes every file into a folder, each whole or not at all.
///
/// # Errors
///
/// The system would not write one.
pub(crate) fn write_files(
    folder: &Path,
    files: Vec<(String, Vec<u8>)>,
) -> Result<Vec<PathBuf>, AnalysisError> {
    let mut written = Vec::new();
    for (name, bytes) in files {
        let file = folder.join(name);
        if let Err(source) = write_atomically(&file, &bytes, Access::Owner) {
            return Err(AnalysisError::Write { file, source });
        }
        written.push(file);
    }
    Ok(written)
}
