//! What is wrong with a scene, and where: the checks that all of its tables share.

use std::path::Path;

use protocols::InputError;

use crate::geometry::Vector;

/// The largest length, distance or brightness that a scene may state.
const LARGEST: f64 = 1e6;

/// A table of the scene file: what an error names.
#[derive(Clone, Copy, Debug)]
pub(super) struct Table<'file> {
    pub(super) file: &'file Path,
    /// What the table is, such as `sphere`.
    pub(super) kind: &'file str,
    /// Which of its kind, from 1; `None` if there is only one, or if its name is enough.
    pub(super) number: Option<usize>,
    pub(super) name: Option<&'file str>,
}

impl Table<'_> {
    /// The kind, the number and the name, as far as there are any.
    pub(super) fn label(&self) -> String {
        let number = self.number.map_or(String::new(), |n| format!(" {n}"));
        let name = self.name.map_or(String::new(), |n| format!(" \"{n}\""));
        format!("{}{number}{name}", self.kind)
    }

    /// The error that a field of this table holds what was `found`.
    pub(super) fn error(
        &self,
        field: &str,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> InputError {
        let place = format!("{}, field {field}", self.label());
        InputError::new(self.file, found, expected).at(place)
    }

    /// A number from `least` to `most`.
    pub(super) fn number_within(
        &self,
        field: &str,
        value: f64,
        (least, most): (f64, f64),
    ) -> Result<f64, InputError> {
        if (least..=most).contains(&value) {
            Ok(value)
        } else {
            let expected = format!("a number from {least} to {most}");
            Err(self.error(field, value.to_string(), expected))
        }
    }

    /// A length above zero.
    pub(super) fn length_m(&self, field: &str, value: f64) -> Result<f64, InputError> {
        if value > 0.0 && value <= LARGEST {
            Ok(value)
        } else {
            let expected = format!("a length above 0 and up to {LARGEST} m");
            Err(self.error(field, value.to_string(), expected))
        }
    }

    /// A brightness above zero.
    pub(super) fn brightness(&self, field: &str, value: f64) -> Result<f64, InputError> {
        if value > 0.0 && value <= LARGEST {
            Ok(value)
        } else {
            let expected = format!("a number above 0 and up to {LARGEST}");
            Err(self.error(field, value.to_string(), expected))
        }
    }

    /// A place, or any other vector of numbers.
    pub(super) fn place(&self, field: &str, value: [f64; 3]) -> Result<Vector, InputError> {
        let is_usual = |coordinate: &f64| coordinate.abs() <= LARGEST;
        if value.iter().all(is_usual) {
            Ok(value.into())
        } else {
            let expected = format!("three numbers from -{LARGEST} to {LARGEST}");
            Err(self.error(field, format!("{value:?}"), expected))
        }
    }

    /// A direction of any length but zero, as a unit vector.
    pub(super) fn direction(&self, field: &str, value: [f64; 3]) -> Result<Vector, InputError> {
        let unit = self.place(field, value)?.normalized();
        if (unit.length() - 1.0).abs() < 1e-9 {
            Ok(unit)
        } else {
            let expected = "a direction: three numbers, not all of them 0";
            Err(self.error(field, format!("{value:?}"), expected))
        }
    }

    /// The edges of a rectangle, `edge_u_m` and `edge_v_m`, which are at right angles.
    pub(super) fn edges(&self, u: [f64; 3], v: [f64; 3]) -> Result<[Vector; 2], InputError> {
        let unit_u = self.direction("edge_u_m", u)?;
        let unit_v = self.direction("edge_v_m", v)?;
        if unit_u.dot(unit_v).abs() > 1e-6 {
            let expected = "an edge at right angles to edge_u_m";
            return Err(self.error("edge_v_m", format!("{v:?}"), expected));
        }
        Ok([u.into(), v.into()])
    }

    /// Two places that differ.
    pub(super) fn two_places(
        &self,
        (from_field, from): (&str, [f64; 3]),
        (field, to): (&str, [f64; 3]),
    ) -> Result<[Vector; 2], InputError> {
        let places = [self.place(from_field, from)?, self.place(field, to)?];
        if (places[1] - places[0]).length() > 1e-9 {
            Ok(places)
        } else {
            let expected = format!("a place that differs from {from_field}");
            Err(self.error(field, format!("{to:?}"), expected))
        }
    }
}
