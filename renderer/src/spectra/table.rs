//! The tables of `renderer/data`: a line that names the source, a line that names the columns, numbers.
//!
//! They are part of the program and known by their digests, so that a fault in one is a fault in the build.

/// The columns of a table by name, in the order of the file.
pub(crate) struct Table {
    pub(crate) names: Vec<&'static str>,
    pub(crate) rows: Vec<Vec<f64>>,
}

impl Table {
    /// Reads a table that was compiled into the program.
    ///
    /// # Panics
    ///
    /// If the table is not one; the digests of all tables are tested.
    pub(crate) fn compiled_in(text: &'static str) -> Self {
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let names = lines.next().unwrap_or_default().split(',').collect();
        let number = |field: &str| -> f64 {
            let parsed = field.parse();
            parsed.expect("a table of renderer/data holds numbers; its digest is tested")
        };
        let rows = lines.map(|line| line.split(',').map(number).collect());
        Self {
            names,
            rows: rows.collect(),
        }
    }

    /// A column as pairs of wavelength and value.
    pub(crate) fn column(&self, column: usize) -> Vec<[f64; 2]> {
        self.rows.iter().map(|row| [row[0], row[column]]).collect()
    }
}

#[cfg(test)]
mod tests {
    use protocols::Sha256Digest;

    #[test]
    fn the_tables_are_those_that_export_py_wrote() {
        // sha256sum of the files that `renderer/data/export.py` wrote with colour-science 0.4.7.
        for (text, digest) in [
            (
                include_str!("../../data/cie_1931_2deg.csv"),
                "414cb30cc546e376dd9de342041b361a2507296f13e8fd0840edaee46f5a9ce1",
            ),
            (
                include_str!("../../data/cie_illuminants.csv"),
                "de358912aef2f46b63b1b5fa39eada0e166ee5b6545fd301144398ece4eedbdd",
            ),
            (
                include_str!("../../data/colorchecker_ohta_1997.csv"),
                "392df2bc49f4b891e52dc693dc93fe15d767f9f29ef1eb1f0f807d0ea899169b",
            ),
        ] {
            assert_eq!(Sha256Digest::of(text.as_bytes()).as_str(), digest);
        }
    }
}
