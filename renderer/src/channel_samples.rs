//! The values of one channel, for the samples at which it was shaded and no others.
//!
//! A channel that was shaded up to some sample holds a plain list; one that left samples out, since they
//! lay below its depth, holds beside it one bit for each sample, and every 64 bits how many came before.

/// The values of one channel.
#[derive(Clone, Debug, Default)]
pub(crate) struct ChannelSamples {
    values: Vec<f32>,
    /// Which samples have a value; empty as long as they are 0, 1, 2, ...
    shaded: Vec<Shaded>,
}

/// Which of 64 samples have a value.
#[derive(Clone, Copy, Debug, Default)]
struct Shaded {
    bits: u64,
    /// How many values the samples before have.
    before: usize,
}

impl ChannelSamples {
    /// Nothing yet, with room for this many values.
    pub(crate) fn with_capacity(values: usize) -> Self {
        Self {
            values: Vec::with_capacity(values),
            shaded: Vec::new(),
        }
    }

    /// Adds the values of the samples from `first` on, each with its number, in any order; `None` where it was
    /// not shaded. All are later than those before.
    pub(crate) fn extend(
        &mut self,
        first: u32,
        values: impl ExactSizeIterator<Item = (u32, Option<f32>)> + Clone,
    ) {
        let gapless = first as usize;
        if self.shaded.is_empty() && self.values.len() == gapless {
            self.values.resize(gapless + values.len(), f32::NAN);
            let mut is_gapless = true;
            for (sample, value) in values.clone() {
                is_gapless &= value.is_some();
                self.values[sample as usize] = value.unwrap_or(f32::NAN);
            }
            if is_gapless {
                return;
            }
            self.values.truncate(gapless);
        }
        let mut in_order = vec![None; values.len()];
        for (sample, value) in values {
            in_order[(sample - first) as usize] = value;
        }
        for (sample, value) in (first..).zip(in_order) {
            if let Some(value) = value {
                self.push(sample, value);
            }
        }
    }

    /// Adds the value of a sample later than all before.
    #[inline]
    fn push(&mut self, sample: u32, value: f32) {
        let is_gapless = self.shaded.is_empty() && self.values.len() == sample as usize;
        if !is_gapless {
            if self.shaded.is_empty() {
                for (earlier, before) in (0..sample).zip(0..self.values.len()) {
                    self.mark(earlier, before);
                }
            }
            self.mark(sample, self.values.len());
        }
        self.values.push(value);
    }

    /// Notes that a sample has a value, and how many values came before.
    fn mark(&mut self, sample: u32, before: usize) {
        let word = sample as usize / 64;
        if word >= self.shaded.len() {
            self.shaded.resize(word + 1, Shaded { bits: 0, before });
        }
        self.shaded[word].bits |= 1 << (sample % 64);
    }

    /// The value of a sample, if the channel was shaded there.
    pub(crate) fn get(&self, sample: u32) -> Option<f32> {
        let place = if self.shaded.is_empty() {
            sample as usize
        } else {
            let Shaded { bits, before } = *self.shaded.get(sample as usize / 64)?;
            let bit = 1_u64 << (sample % 64);
            if bits & bit == 0 {
                return None;
            }
            before + (bits & (bit - 1)).count_ones() as usize
        };
        self.values.get(place).copied()
    }

    /// How many values are held.
    pub(crate) fn len(&self) -> usize {
        self.values.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_was_pushed_is_found() {
        let shaded = [0, 1, 2, 5, 9, 10, 63, 64, 127, 400, 401];
        let mut samples = ChannelSamples::default();
        for sample in shaded {
            samples.push(sample, sample as f32);
        }
        for sample in 0..500 {
            let expected = shaded.contains(&sample).then_some(sample as f32);
            assert_eq!(samples.get(sample), expected, "sample {sample}");
        }
        assert_eq!(samples.len(), shaded.len());
    }

    /// The second piece has a gap, the third comes after one.
    #[test]
    fn pieces_are_added_in_any_order_of_their_samples() {
        let mut samples = ChannelSamples::default();
        let value = |sample: u32| (![4, 7].contains(&sample)).then_some(sample as f32);
        for piece in [[2_u32, 0, 1], [5, 3, 4], [6, 8, 7]] {
            let first = piece.into_iter().min().unwrap();
            samples.extend(
                first,
                piece.map(|sample| (sample, value(sample))).into_iter(),
            );
        }
        assert_eq!(samples.len(), 7);
        for sample in 0..9 {
            assert_eq!(samples.get(sample), value(sample), "sample {sample}");
        }
    }

    #[test]
    fn a_first_sample_that_is_not_the_roots_is_a_gap() {
        let mut samples = ChannelSamples::default();
        samples.push(3, 1.0);
        assert_eq!((samples.get(0), samples.get(3)), (None, Some(1.0)));
    }
}
