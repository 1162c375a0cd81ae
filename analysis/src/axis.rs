//! The axis of a measured value: its ends, and the numbers along it.

use protocols::Scale;

/// No more steps than this from one end to the other.
const MOST_STEPS: f64 = 6.0;
/// A number of an axis with more signs is written as a power of ten.
const LONGEST: usize = 14;

/// The ends of an axis and the distance of its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis {
    pub(crate) low: f64,
    pub(crate) high: f64,
    step: f64,
}

impl Axis {
    /// From one end of a scale to the other.
    pub(crate) fn of_scale(scale: Scale) -> Self {
        let (low, high) = (f64::from(scale.lowest), f64::from(scale.highest));
        Self {
            low,
            high,
            step: round_step(high - low).max(1.0),
        }
    }

    /// About some values, its ends on numbers of the axis.
    pub(crate) fn around(values: impl Iterator<Item = f64>) -> Self {
        let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
            [low.min(value), high.max(value)]
        });
        let room = if high > low {
            0.0
        } else {
            (0.1 * low.abs()).max(1.0)
        };
        let (low, high) = (low - room, high + room);
        let step = round_step(high - low);
        Self {
            low: (low / step).floor() * step,
            high: (high / step).ceil() * step,
            step,
        }
    }

    /// Where a value lies between the ends, as a share; beyond them, the end.
    pub(crate) fn share(&self, value: f64) -> f64 {
        (value.clamp(self.low, self.high) - self.low) / (self.high - self.low)
    }

    /// The numbers along the axis, each with its text.
    pub(crate) fn numbers(&self) -> Vec<(f64, String)> {
        let mut numbers = Vec::new();
        let mut index = 0.0;
        while self.step.mul_add(index, self.low) <= self.high + 1e-6 * self.step {
            let value = self.step.mul_add(index, self.low);
            numbers.push((value, self.text(value)));
            index += 1.0;
        }
        numbers
    }

    fn text(&self, value: f64) -> String {
        let (mut decimals, mut unit) = (0, 1.0);
        while unit > 1.000_001 * self.step && decimals < 12 {
            decimals += 1;
            unit /= 10.0;
        }
        let text = format!("{:.decimals$}", value + 0.0);
        if text.len() > LONGEST {
            return format!("{value:.4e}");
        }
        let is_zero = text.bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.'));
        match text.strip_prefix('-') {
            Some(digits) if is_zero => digits.to_owned(),
            Some(digits) => format!("−{digits}"),
            None => text,
        }
    }
}

/// The smallest of 1, 2 and 5 times a power of ten that divides `range` into few steps.
fn round_step(range: f64) -> f64 {
    // Powers of ten by multiplication, so that every platform has the same.
    let mut power = 1.0;
    while power * 10.0 * MOST_STEPS <= range {
        power *= 10.0;
    }
    while power * MOST_STEPS > range * 1.000_001 && power > 1e-300 {
        power /= 10.0;
    }
    let steps = [1.0, 2.0, 5.0, 10.0].map(|part| part * power);
    let is_few = |step: &f64| step * MOST_STEPS >= range * 0.999_999;
    steps.into_iter().find(is_few).unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: Axis) -> Vec<String> {
        axis.numbers().into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn numbers_are_round_and_few() {
        let scale = |lowest, highest| Axis::of_scale(Scale { lowest, highest });
        assert_eq!(texts(scale(0, 10)), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(texts(scale(1, 5)), ["1", "2", "3", "4", "5"]);
        assert_eq!(
            texts(scale(0, 1000)),
            ["0", "200", "400", "600", "800", "1000"]
        );
        let around = |values: &[f64]| texts(Axis::around(values.iter().copied()));
        assert_eq!(
            around(&[-0.03, 0.11]),
            ["−0.05", "0.00", "0.05", "0.10", "0.15"]
        );
        assert_eq!(around(&[412.0, 588.0]), ["400", "450", "500", "550", "600"]);
        assert_eq!(
            around(&[1e9 + 0.001, 1e9 + 0.005]),
            [
                "1000000000.001",
                "1000000000.002",
                "1000000000.003",
                "1000000000.004",
                "1000000000.005"
            ]
        );
    }

    #[test]
    fn values_that_are_all_the_same_have_an_axis() {
        for value in [0.0, 5.0, -1e9] {
            let axis = Axis::around([value, value].into_iter());
            assert!(axis.low < value && value < axis.high, "{axis:?}");
            assert!((3..=8).contains(&axis.numbers().len()), "{axis:?}");
        }
    }
}
