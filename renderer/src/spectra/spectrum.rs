//! A spectrum: values at wavelengths with straight lines between them, or a smooth curve.

use super::Sigmoid;

/// A value at each wavelength.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Spectrum {
    /// Control points in the order of their wavelengths; straight lines between them, and before the first
    /// and after the last the value of that point.
    Points(Vec<[f64; 2]>),
    /// The reflectance of an RGB colour.
    Sigmoid(Sigmoid),
    /// The product of two.
    Product(Box<[Self; 2]>),
}

impl Spectrum {
    /// The spectrum of pairs of wavelength (nm) and value, with wavelengths that rise.
    pub(crate) const fn of_points(points: Vec<[f64; 2]>) -> Self {
        Self::Points(points)
    }

    /// The same value at every wavelength.
    pub(crate) fn constant(value: f64) -> Self {
        Self::of_points(vec![[560.0, value]])
    }

    /// The product with another spectrum.
    pub(crate) fn times(self, other: Self) -> Self {
        Self::Product(Box::new([self, other]))
    }

    /// The value at a wavelength.
    pub(crate) fn at(&self, wavelength_nm: f64) -> f64 {
        match self {
            Self::Points(points) => on_lines(points, wavelength_nm),
            Self::Sigmoid(sigmoid) => sigmoid.at(wavelength_nm),
            Self::Product(factors) => {
                let [one, other] = factors.as_ref();
                one.at(wavelength_nm) * other.at(wavelength_nm)
            }
        }
    }

    /// The largest value, or a bound of it.
    pub(crate) fn peak(&self) -> f64 {
        match self {
            Self::Points(points) => points.iter().fold(0.0, |most, &[_, value]| most.max(value)),
            Self::Sigmoid(sigmoid) => sigmoid.peak(),
            Self::Product(factors) => factors[0].peak() * factors[1].peak(),
        }
    }
}

fn on_lines(points: &[[f64; 2]], wavelength_nm: f64) -> f64 {
    let next = points.partition_point(|&[nm, _]| nm <= wavelength_nm);
    match (next.checked_sub(1), points.get(next)) {
        (None, None) => 0.0,
        (None, Some(&[_, first])) => first,
        (Some(last), None) => points[last][1],
        (Some(before), Some(&[nm_after, after])) => {
            let [nm_before, before] = points[before];
            let part = (wavelength_nm - nm_before) / (nm_after - nm_before);
            before + part * (after - before)
        }
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
