//! How many spatial samples a channel's image is made from.

use std::fmt;
use std::num::NonZeroU32;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// A number of rays to spend on one channel of one image; never zero.
///
/// Written as in the paper, `140K` for 140 000, or as a plain whole number.
///
/// ```
/// use protocols::RayCount;
/// let count: RayCount = "140K".parse()?;
/// assert_eq!(count.get(), 140_000);
/// assert_eq!(count.to_string(), "140K");
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct RayCount(NonZeroU32);

impl RayCount {
    /// The count, or `None` for zero rays.
    pub const fn new(rays: u32) -> Option<Self> {
        match NonZeroU32::new(rays) {
            Some(rays) => Some(Self(rays)),
            None => None,
        }
    }

    /// The number of rays.
    pub const fn get(self) -> u32 {
        self.0.get()
    }

    /// The number of rays, as a length or an index.
    pub const fn as_usize(self) -> usize {
        self.0.get() as usize
    }
}

impl FromStr for RayCount {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let refused = || {
            format!(
                "found the ray count {text:?}, expected a whole number from 1 to {}, such as 140000 or 140K",
                u32::MAX
            )
        };
        let (digits, unit) = text
            .strip_suffix('K')
            .map_or((text, 1), |digits| (digits, 1000));
        if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
            return Err(refused());
        }
        let count: u32 = digits.parse().map_err(|_too_large| refused())?;
        count
            .checked_mul(unit)
            .and_then(Self::new)
            .ok_or_else(refused)
    }
}

impl TryFrom<String> for RayCount {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<RayCount> for String {
    fn from(count: RayCount) -> Self {
        count.to_string()
    }
}

impl fmt::Display for RayCount {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rays = self.get();
        if rays.is_multiple_of(1000) {
            formatter.pad(&format!("{}K", rays / 1000))
        } else {
            formatter.pad(&rays.to_string())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_is_read_back_as_it_was_written() {
        for rays in [1, 999, 1000, 10_000, 12_345, 140_000, u32::MAX] {
            let count = RayCount::new(rays).unwrap();
            assert_eq!(count.to_string().parse(), Ok(count));
        }
    }

    #[test]
    fn what_is_not_a_positive_whole_number_is_refused() {
        for text in [
            "",
            "0",
            "0K",
            "K",
            "-1",
            "+5",
            "1.5K",
            "10 K",
            "10k",
            "4294968K",
            "99999999999",
        ] {
            assert!(text.parse::<RayCount>().is_err(), "{text:?} was taken");
        }
    }
}
