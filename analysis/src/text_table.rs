//! Columns of text for a terminal: the first to the left, all others to the right.

/// A table whose columns are as wide as their widest field.
#[derive(Debug)]
pub(crate) struct TextTable {
    lines: Vec<Vec<String>>,
}

impl TextTable {
    pub(crate) fn new(header: &[&str]) -> Self {
        Self {
            lines: vec![header.iter().map(|&name| name.to_owned()).collect()],
        }
    }

    /// Adds a line; it has a field for each column.
    pub(crate) fn row(&mut self, fields: &[String]) {
        self.lines.push(fields.to_vec());
    }

    pub(crate) fn to_text(&self) -> String {
        let n_columns = self.lines[0].len();
        let width = |column: usize| {
            let widths = self.lines.iter().filter_map(|line| line.get(column));
            widths.map(|field| field.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..n_columns).map(width).collect();
        let mut text = String::new();
        for line in &self.lines {
            let padded: Vec<String> = (line.iter().zip(&widths).enumerate())
                .map(|(column, (field, &width))| match column {
                    0 => format!("{field:<width$}"),
                    _ => format!("{field:>width$}"),
                })
                .collect();
            text.push_str(padded.join("  ").trim_end());
            text.push('\n');
        }
        text
    }
}

/// A number with `places` decimals, or a dash.
pub(crate) fn decimals(value: Option<f64>, places: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.places$}"))
}

/// A p value as [`p_text`] writes it, or a dash.
pub(crate) fn optional_p(p: Option<f64>) -> String {
    p.map_or_else(|| "-".to_owned(), p_text)
}

/// A p value for a table: four decimals down to .0001, then two digits and an exponent.
pub(crate) fn p_text(p: f64) -> String {
    if p >= 1e-4 {
        format!("{p:.4}")
    } else {
        format!("{p:.1e}")
    }
}
