//! How deep the tree must be for what the eye can resolve, channel by channel.
//!
//! A cutoff is carried by two samples to a cycle. A cell is refined as long as one of its sides is longer
//! than the spacing that this implies; on the display there is no more than a sample a pixel to see, so the
//! spacing is never less than a pixel. Sides are halved, so the smallest cells are between half of the
//! spacing and the whole.
//!
//! Source: Meyer & Liu (1992), sections 2.3, 3 and 3.2.

use std::fmt;

use protocols::{Acuity, Channel, ChannelGroup, PerChannel, Viewing};

use crate::cell::Cell;

/// How far one group of channels is refined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AcuityLimit {
    /// The highest spatial frequency that is seen.
    pub cutoff_cpd: f64,
    /// The samples on a square lattice that carry it over the whole picture.
    ///
    /// ```text
    /// samples = (width / spacing) (height / spacing),  spacing = pixels per degree / (2 cutoff)
    /// ```
    pub lattice_samples: f64,
    /// The same, but no more than one a pixel.
    pub shown_samples: f64,
    /// No side of the smallest cell is longer than this.
    pub spacing_px: f64,
    /// The depth of the smallest cells.
    pub depth: u32,
}

/// How far the channels of a picture are refined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AcuityLimits {
    /// Of A.
    pub achromatic: AcuityLimit,
    /// Of C1 and C2.
    pub chromatic: AcuityLimit,
}

impl AcuityLimits {
    /// The limits for a picture of this size, seen from there.
    pub fn new(acuity: Acuity, viewing: Viewing, size_px: [u32; 2]) -> Self {
        let limit = |group| {
            let cutoff_cpd = acuity.cutoff_cpd(group);
            let carrying_px = acuity.spacing_px(group, viewing);
            let spacing_px = carrying_px.max(1.0);
            let [width, height] = size_px.map(f64::from);
            AcuityLimit {
                cutoff_cpd,
                lattice_samples: (width / carrying_px) * (height / carrying_px),
                shown_samples: (width / spacing_px) * (height / spacing_px),
                spacing_px,
                depth: Cell::depth_of_side(size_px, spacing_px),
            }
        };
        Self {
            achromatic: limit(ChannelGroup::Achromatic),
            chromatic: limit(ChannelGroup::Chromatic),
        }
    }

    /// The limit of a channel.
    pub const fn of(&self, channel: Channel) -> &AcuityLimit {
        match channel.group() {
            ChannelGroup::Achromatic => &self.achromatic,
            ChannelGroup::Chromatic => &self.chromatic,
        }
    }

    /// The depths below which no channel is shaded; C1 and C2 go no deeper than A, which says where to go.
    pub fn stop_depths(&self) -> PerChannel<Option<u32>> {
        let deepest = self.achromatic.depth;
        PerChannel::from_fn(|channel| Some(self.of(channel).depth.min(deepest)))
    }
}

impl fmt::Display for AcuityLimits {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, (name, limit)) in [("A", self.achromatic), ("C1 and C2", self.chromatic)]
            .into_iter()
            .enumerate()
        {
            let AcuityLimit {
                cutoff_cpd,
                lattice_samples,
                shown_samples,
                spacing_px,
                depth,
            } = limit;
            let separator = if place == 0 { "" } else { "\n" };
            let lattice = lattice_samples / 1000.0;
            write!(
                formatter,
                "{separator}acuity of {name}: {cutoff_cpd} cycles/degree, {lattice:.1}K samples on a square lattice"
            )?;
            if shown_samples < lattice_samples {
                let shown = shown_samples / 1000.0;
                write!(formatter, ", capped by the display at {shown:.1}K")?;
            }
            write!(
                formatter,
                "; refined to cells of {spacing_px:.2} pixels, depth {depth}"
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper(size_px: [u32; 2]) -> AcuityLimits {
        AcuityLimits::new(Acuity::MULLEN_1985, Viewing::MEYER_LIU_1992, size_px)
    }

    /// 320 pixels at 0.019° and two samples to a cycle of 34 and 11 cycles per degree, by numpy:
    /// (2 · 34 · 6.08)² and (2 · 11 · 6.08)²; the display has 320².
    #[test]
    fn at_the_papers_geometry_the_samples_are_those_of_the_closed_form() {
        let limits = paper([320, 320]);
        let is_near = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-12;
        assert!(is_near(limits.achromatic.lattice_samples, 170_932.633_6));
        assert!(is_near(limits.achromatic.shown_samples, 102_400.0));
        assert!(is_near(limits.chromatic.lattice_samples, 17_891.737_6));
        assert!(is_near(limits.chromatic.shown_samples, 17_891.737_6));
        let printed = limits.to_string();
        assert!(printed.contains("170.9K") && printed.contains("102.4K"));
        assert!(printed.contains("17.9K"), "{printed}");
    }

    /// Sides of 320/2⁹ = .625 pixels are the first that are not above 1; 320/2⁸ = 1.25 not above 2.39.
    #[test]
    fn at_the_papers_geometry_luminance_ends_at_depth_18_and_chroma_at_16() {
        let limits = paper([320, 320]);
        assert_eq!((limits.achromatic.depth, limits.chromatic.depth), (18, 16));
    }

    /// Four times as wide: two more halvings along x and none along y.
    #[test]
    fn a_longer_picture_is_refined_to_cells_of_the_same_size() {
        for size_px in [[1280, 320], [320, 1280]] {
            let limits = paper(size_px);
            assert_eq!((limits.achromatic.depth, limits.chromatic.depth), (20, 18));
        }
    }

    #[test]
    fn chroma_is_never_deeper_than_the_luminance_that_leads_there() {
        let acuity = Acuity {
            luminance_cutoff_cpd: 5.0,
            chromatic_cutoff_cpd: 11.0,
        };
        let limits = AcuityLimits::new(acuity, Viewing::MEYER_LIU_1992, [320, 320]);
        let depths = limits.stop_depths();
        assert!(limits.chromatic.depth > limits.achromatic.depth);
        assert_eq!(depths.c1, depths.a);
    }
}
