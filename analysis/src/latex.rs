//! The tables of a report in LaTeX, to be taken into a paper with `\input`.

use std::fmt::Write as _;

use crate::document::{Block, Document, Table};
use crate::rich_text::latex;

impl Document {
    /// Every table as a `table` environment with rules of the package booktabs; long ones break over pages (longtable).
    pub(crate) fn to_latex(&self) -> String {
        let mut text = String::from(
            "% \\usepackage{booktabs}, \\usepackage{longtable}, \\usepackage{graphicx}; UTF-8; any LaTeX of 2018 or later\n",
        );
        let blocks = self.sections.iter().flat_map(|section| &section.blocks);
        let tables = blocks.filter_map(|block| match block {
            Block::Table(table) => Some(table),
            _ => None,
        });
        for (index, table) in tables.enumerate() {
            text.push_str(&table_in_latex(table, index + 1));
        }
        text
    }
}

/// Tables of more rows break over pages.
const LONGEST: usize = 32;

fn table_in_latex(table: &Table, number: usize) -> String {
    let alignment = format!(
        "@{{}}l{}@{{}}",
        "r".repeat(table.columns.len().saturating_sub(1))
    );
    let caption = format!(
        "\\caption{{{}}}\\label{{tab:acuity-{number}}}",
        latex(&table.caption)
    );
    let line = |cells: &[String]| {
        let cells: Vec<String> = cells.iter().map(|cell| latex(cell)).collect();
        format!("{} \\\\\n", cells.join(" & "))
    };
    let mut head = String::from("\\toprule\n");
    if !table.groups.is_empty() {
        head.push_str(&groups_in_latex(table));
    }
    head.push_str(&line(&table.columns));
    head.push_str("\\midrule\n");
    let rows: String = table.rows.iter().map(|row| line(row)).collect();
    let mut text = String::new();
    // Writing to a `String` cannot fail.
    _ = if table.rows.len() > LONGEST {
        write!(
            text,
            "\n{{\\small\n\\begin{{longtable}}{{{alignment}}}\n{caption}\\\\\n{head}\\endhead\n{rows}\\bottomrule\n\
             \\end{{longtable}}}}\n"
        )
    } else {
        write!(
            text,
            "\n\\begin{{table}}\n{caption}\\smallskip\n\\centering\\resizebox{{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}}{{!}}{{%\n\
             \\begin{{tabular}}{{{alignment}}}\n{head}{rows}\\bottomrule\n\\end{{tabular}}}}\n\\end{{table}}\n"
        )
    };
    text
}

fn groups_in_latex(table: &Table) -> String {
    let cells: Vec<String> = (table.groups.iter())
        .map(|(text, span)| match text.as_str() {
            "" => " & ".repeat(span - 1),
            text => format!("\\multicolumn{{{span}}}{{c}}{{{}}}", latex(text)),
        })
        .collect();
    let mut text = format!("{} \\\\\n", cells.join(" & "));
    let mut first = 1;
    for (name, span) in &table.groups {
        if !name.is_empty() {
            // Writing to a `String` cannot fail.
            _ = write!(text, "\\cmidrule(lr){{{first}-{}}}", first + span - 1);
        }
        first += span;
    }
    text.push('\n');
    text
}
