//! Measured reflectances that a scene may name: the `ColorChecker`.

use std::sync::LazyLock;

use super::Spectrum;
use super::table::Table;

/// What stands before the name of a patch.
const PREFIX: &str = "colorchecker ";

static COLORCHECKER: LazyLock<Table> =
    LazyLock::new(|| Table::compiled_in(include_str!("../../data/colorchecker_ohta_1997.csv")));

/// The name of a patch without what it says in parentheses: `white 9.5 (.05 D)` is `white 9.5`.
fn short(name: &str) -> &str {
    name.split(" (").next().unwrap_or(name)
}

/// The names of all measured reflectances, such as `colorchecker red`.
pub(crate) fn names() -> Vec<String> {
    let patches = COLORCHECKER.names.iter().skip(1);
    patches
        .map(|name| format!("{PREFIX}{}", short(name)))
        .collect()
}

/// The measured reflectance of a name.
pub(crate) fn reflectance(name: &str) -> Option<Spectrum> {
    let patch = name.strip_prefix(PREFIX)?;
    let mut columns = COLORCHECKER.names.iter().enumerate().skip(1);
    let (column, _) = columns.find(|(_, name)| short(name) == patch)?;
    Some(Spectrum::of_points(COLORCHECKER.column(column)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_24_patches_are_found_by_name_and_are_reflectances() {
        assert_eq!(names().len(), 24);
        for name in names() {
            let reflectance = reflectance(&name).unwrap();
            assert!((360..=830).all(|nm| (0.0..=1.0).contains(&reflectance.at(f64::from(nm)))));
        }
        // The table of colour-science, row 550 nm, columns `red` and `white 9.5 (.05 D)`.
        assert_eq!(reflectance("colorchecker red").unwrap().at(380.0), 0.052);
        assert_eq!(
            reflectance("colorchecker white 9.5").unwrap().at(380.0),
            0.153
        );
        assert!(reflectance("colorchecker wavelength_nm").is_none());
    }
}
