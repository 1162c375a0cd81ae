//! A spectrum: values at wavelengths, with straight lines between them.

/// Control points in the order of their wavelengths; straight lines between them, and before the first and
/// after the last the value of that point.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spectrum {
    points: Vec<[f64; 2]>,
}

impl Spectrum {
    /// The spectrum of pairs of wavelength (nm) and value, with wavelengths that rise.
    pub(crate) const fn of_points(points: Vec<[f64; 2]>) -> Self {
        Self { points }
    }

    /// The same value at every wavelength.
    pub(crate) fn constant(value: f64) -> Self {
        Self::of_points(vec![[560.0, value]])
    }

    /// The value at a wavelength.
    pub(crate) fn at(&self, wavelength_nm: f64) -> f64 {
        let next = self.points.partition_point(|&[nm, _]| nm <= wavelength_nm);
        match (next.checked_sub(1), self.points.get(next)) {
            (None, None) => 0.0,
            (None, Some(&[_, first])) => first,
            (Some(last), None) => self.points[last][1],
            (Some(before), Some(&[nm_after, after])) => {
                let [nm_before, before] = self.points[before];
                let part = (wavelength_nm - nm_before) / (nm_after - nm_before);
                before + part * (after - before)
            }
        }
    }

    /// The largest value.
    pub(crate) fn peak(&self) -> f64 {
        let values = self.points.iter().map(|&[_, value]| value);
        values.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_lie_on_straight_lines_and_stay_level_outside() {
        let spectrum = Spectrum::of_points(vec![[400.0, 0.2], [500.0, 0.4], [600.0, 0.0]]);
        for (nm, value) in [
            (360.0, 0.2),
            (400.0, 0.2),
            (450.0, 0.3),
            (500.0, 0.4),
            (575.0, 0.1),
            (600.0, 0.0),
            (830.0, 0.0),
        ] {
            assert!((spectrum.at(nm) - value).abs() < 1e-15, "at {nm} nm");
        }
    }

    #[test]
    fn one_point_is_a_constant() {
        let spectrum = Spectrum::constant(0.5);
        assert_eq!(
            [spectrum.at(400.0), spectrum.at(560.0), spectrum.at(700.0)],
            [0.5; 3]
        );
    }
}
