//! A self-contained HTML page: no script, no network, one style sheet inside.

/// The text of `text` in HTML.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// A page with `title` and, in HTML, `body`.
pub(crate) fn page(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n\
         <style>\n{}</style>\n</head>\n<body>\n{body}</body>\n</html>\n",
        escaped(title),
        include_str!("report.css")
    )
}

/// A table in HTML; its cells are HTML already.
#[derive(Debug, Default)]
pub(crate) struct Table {
    caption: String,
    head: String,
    rows: String,
}

impl Table {
    pub(crate) fn new(caption: &str, columns: &[&str]) -> Self {
        let cells = columns.iter().fold(String::new(), |cells, column| {
            cells + "<th>" + column + "</th>"
        });
        Self {
            caption: caption.to_owned(),
            head: format!("<tr>{cells}</tr>"),
            rows: String::new(),
        }
    }

    /// Puts a line of group headings above the header: each with the number of columns that it spans.
    pub(crate) fn grouped(mut self, groups: &[(&str, usize)]) -> Self {
        let cells: Vec<String> = (groups.iter())
            .map(|(text, span)| {
                let class = if text.is_empty() {
                    ""
                } else {
                    " class=\"group\""
                };
                format!("<th colspan=\"{span}\"{class} scope=\"colgroup\">{text}</th>")
            })
            .collect();
        let cells = cells.concat();
        self.head = format!("<tr>{cells}</tr>{}", self.head);
        self
    }

    pub(crate) fn row(&mut self, cells: &[String]) {
        self.rows.push_str("<tr>");
        for cell in cells {
            self.rows.push_str("<td>");
            self.rows.push_str(cell);
            self.rows.push_str("</td>");
        }
        self.rows.push_str("</tr>\n");
    }

    pub(crate) fn to_html(&self) -> String {
        format!(
            "<div class=\"wide\"><table><caption>{}</caption><thead>{}</thead>\n<tbody>\n{}</tbody></table></div>\n",
            self.caption, self.head, self.rows
        )
    }
}
