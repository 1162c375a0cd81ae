//! A report in Markdown (GitHub's, for its tables).

use std::fmt::Write as _;

use crate::document::{Block, Document, Style, Table, joined};
use crate::rich_text::markdown;

impl Document {
    /// The document in Markdown; figures are the files beside it.
    pub(crate) fn to_markdown(&self) -> String {
        let mut text = format!("# {}\n\n", markdown(&self.title));
        // Writing to a `String` cannot fail, here and below.
        _ = writeln!(text, "Report of the study **{}**  ", markdown(&self.study));
        for line in &self.bylines {
            _ = writeln!(text, "{}  ", markdown(line));
        }
        for section in &self.sections {
            if let Some(heading) = section.heading {
                _ = write!(text, "\n## {heading}\n");
            }
            for block in &section.blocks {
                text.push('\n');
                text.push_str(&block_in_markdown(block));
            }
        }
        text
    }
}

fn block_in_markdown(block: &Block) -> String {
    match block {
        Block::Paragraph(Style::Banner, text) => format!("> {}\n", markdown(text)),
        Block::Paragraph(_, text) => format!("{}\n", markdown(text)),
        Block::List(_, items) => joined(items, |item| format!("- {}\n", markdown(item))),
        Block::Terms(terms) => joined(terms, |(term, text)| {
            format!("- **{term}**: {}\n", markdown(text))
        }),
        Block::Table(table) => table_in_markdown(table),
        Block::Figure { file, caption, .. } => {
            format!("![Figure]({file}.png)\n\n{}\n", markdown(caption))
        }
        Block::Beside(blocks) => {
            let blocks: Vec<String> = blocks.iter().map(block_in_markdown).collect();
            blocks.join("\n")
        }
    }
}

/// The caption, then the table; a group's heading stands before the columns that it spans.
fn table_in_markdown(table: &Table) -> String {
    let mut groups: Vec<&str> = (table.groups.iter())
        .flat_map(|(text, span)| std::iter::repeat_n(text.as_str(), *span))
        .collect();
    groups.resize(table.columns.len(), "");
    let columns: Vec<String> = (table.columns.iter().zip(&groups))
        .map(|(column, group)| match *group {
            "" => markdown(column),
            group => format!("{}: {}", markdown(group), markdown(column)),
        })
        .collect();
    let mut rule = vec!["---:"; columns.len()];
    if let Some(first) = rule.first_mut() {
        *first = "---";
    }
    let mut text = format!(
        "{}\n\n| {} |\n| {} |\n",
        markdown(&table.caption),
        columns.join(" | "),
        rule.join(" | ")
    );
    for row in &table.rows {
        let cells: Vec<String> = row.iter().map(|cell| markdown(cell)).collect();
        // Writing to a `String` cannot fail.
        _ = writeln!(text, "| {} |", cells.join(" | "));
    }
    text
}
