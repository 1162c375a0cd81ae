//! One channel of a picture, as pixels.

/// The tristimulus values of one channel, row by row from the top, each row from the left.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelImage {
    size_px: [u32; 2],
    values: Vec<f32>,
}

impl ChannelImage {
    /// An image of these values, or `None` if there are not width × height of them.
    pub fn new(size_px: [u32; 2], values: Vec<f32>) -> Option<Self> {
        let pixels = u64::from(size_px[0]) * u64::from(size_px[1]);
        (values.len() as u64 == pixels).then_some(Self { size_px, values })
    }

    /// An image of as many values as it has pixels.
    pub(crate) fn from_rows(size_px: [u32; 2], values: Vec<f32>) -> Self {
        debug_assert_eq!(
            values.len() as u64,
            u64::from(size_px[0]) * u64::from(size_px[1])
        );
        Self { size_px, values }
    }

    /// Width and height.
    pub const fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// The values, row by row.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The values alone, row by row.
    pub(crate) fn into_values(self) -> Vec<f32> {
        self.values
    }

    /// The root of the mean squared difference from another image; `None` if their sizes differ.
    pub fn rms_difference(&self, other: &Self) -> Option<f64> {
        if self.size_px != other.size_px {
            return None;
        }
        let pairs = self.values.iter().zip(&other.values);
        let sum: f64 = pairs
            .map(|(&one, &two)| (f64::from(one) - f64::from(two)).powi(2))
            .sum();
        Some((sum / self.values.len() as f64).sqrt())
    }
}
