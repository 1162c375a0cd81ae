//! Which images a part of a trial shows.

use protocols::Layout;

/// Which images are on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Picture {
    /// Zero anchor, test image and ten anchor, side by side.
    Flanked,
    /// The zero anchor alone.
    ZeroAnchor,
    /// The test image alone.
    Test,
    /// The ten anchor alone.
    TenAnchor,
}

/// Which member of a pair comes first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum First {
    /// The test image.
    #[default]
    Test,
    /// The reference.
    Reference,
}

impl Picture {
    /// The parts of a trial, one after another.
    pub(crate) fn all_of(layout: Layout, first: First) -> &'static [Self] {
        match (layout, first) {
            (Layout::Flanking, _) => &[Self::Flanked],
            (Layout::Sequence, _) => &[Self::ZeroAnchor, Self::Test, Self::TenAnchor],
            (Layout::Single, _) => &[Self::Test],
            (Layout::Dsis, _) => &[Self::TenAnchor, Self::Test],
            (Layout::Dscqs, First::Test) => {
                &[Self::Test, Self::TenAnchor, Self::Test, Self::TenAnchor]
            }
            (Layout::Dscqs, First::Reference) => {
                &[Self::TenAnchor, Self::Test, Self::TenAnchor, Self::Test]
            }
        }
    }

    pub(crate) fn has_test_image(self) -> bool {
        matches!(self, Self::Flanked | Self::Test)
    }
}
