//! Spectra, and how they become opponent channels.
//!
//! Wavelengths in nm. A reflectance is from 0 to 1; an emittance is relative power per nm. Every sum over
//! wavelengths is divided by that of ȳ over 360–830 nm, so that a spectrum of constant 1 has Y = 1.

pub(crate) mod cie;
#[cfg(test)]
mod colour_difference;
pub(crate) mod emission;
pub(crate) mod measured;
pub(crate) mod quadrature;
pub(crate) mod sensitivity;
pub(crate) mod sigmoid;
pub(crate) mod spectrum;
mod table;
pub(crate) mod uplift;
pub(crate) mod uplift_table;

pub(crate) use emission::Emission;
pub(crate) use quadrature::WavelengthRule;
pub(crate) use sensitivity::sensitivities;
pub(crate) use sigmoid::Sigmoid;
pub(crate) use spectrum::Spectrum;
