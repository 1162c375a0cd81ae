//! A report as a self-contained HTML page: no script, no network, one style sheet inside.

use std::fmt::Write as _;

use crate::document::{Block, Document, Style, Table, joined};

/// With more columns a table is set closer.
const MANY_COLUMNS: usize = 8;
/// A table with more rows may break over printed pages.
const LONG: usize = 16;

/// The text of `text` in HTML.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

impl Document {
    /// The document as a page.
    pub(crate) fn to_html(&self) -> String {
        let bylines = joined(&self.bylines, |line| {
            format!("<p class=\"byline\">{line}</p>\n")
        });
        let mut body = format!(
            "<header>\n<p class=\"byline\">Report of the study <b>{}</b></p>\n<h1>{}</h1>\n{bylines}</header>\n",
            self.study, self.title
        );
        for section in &self.sections {
            let blocks: String = section.blocks.iter().map(block_in_html).collect();
            // Writing to a `String` cannot fail.
            _ = match section.heading {
                Some(heading) => {
                    writeln!(body, "<section>\n<h2>{heading}</h2>\n{blocks}</section>")
                }
                None => write!(body, "{blocks}"),
            };
        }
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Report: {}</title>\n\
             <style>\n{}</style>\n</head>\n<body>\n{body}</body>\n</html>\n",
            self.study,
            include_str!("report.css")
        )
    }
}

fn block_in_html(block: &Block) -> String {
    match block {
        Block::Paragraph(Style::Banner, text) => format!("<div class=\"banner\">{text}</div>\n"),
        Block::Paragraph(style, text) => format!("<p{}>{text}</p>\n", class(*style)),
        Block::List(style, items) => {
            let items = joined(items, |item| format!("<li>{item}</li>\n"));
            format!("<ul{}>\n{items}</ul>\n", class(*style))
        }
        Block::Terms(terms) => {
            let terms = joined(terms, |(term, text)| {
                format!("<dt>{term}</dt><dd>{text}</dd>\n")
            });
            format!("<dl>\n{terms}</dl>\n")
        }
        Block::Table(table) => table_in_html(table),
        Block::Figure { svg, caption, .. } => {
            format!("<figure>\n{svg}<figcaption>{caption}</figcaption>\n</figure>\n")
        }
        Block::Beside(blocks) => format!(
            "<div class=\"beside\">\n{}</div>\n",
            joined(blocks, block_in_html)
        ),
    }
}

const fn class(style: Style) -> &'static str {
    match style {
        Style::Plain => "",
        Style::Result => " class=\"result\"",
        Style::Banner => " class=\"banner\"",
        Style::Note => " class=\"note\"",
    }
}

fn table_in_html(table: &Table) -> String {
    let cells =
        |tag: &str, cells: &[String]| joined(cells, |cell| format!("<{tag}>{cell}</{tag}>"));
    let mut head = format!("<tr>{}</tr>", cells("th", &table.columns));
    if !table.groups.is_empty() {
        let groups = joined(&table.groups, |(text, span)| {
            let class = if text.is_empty() {
                ""
            } else {
                " class=\"group\""
            };
            format!("<th colspan=\"{span}\"{class} scope=\"colgroup\">{text}</th>")
        });
        head = format!("<tr>{groups}</tr>{head}");
    }
    let rows = joined(&table.rows, |row| {
        format!("<tr>{}</tr>\n", cells("td", row))
    });
    let many = if table.columns.len() > MANY_COLUMNS {
        " many"
    } else {
        ""
    };
    let long = if table.rows.len() > LONG { " long" } else { "" };
    format!(
        "<div class=\"wide{many}{long}\"><table><caption>{}</caption><thead>{head}</thead>\n<tbody>\n{rows}</tbody></table></div>\n",
        table.caption
    )
}
