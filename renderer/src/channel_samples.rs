//! The values of one channel, for the samples at which it was shaded and no others.
//!
//! A channel that was shaded up to some sample holds a plain list; one that left samples out, since they
//! lay below its depth, holds beside it which samples it has.

/// The values of one channel.
#[derive(Clone, Debug, Default)]
pub(crate) struct ChannelSamples {
    values: Vec<f32>,
    /// The samples of the values, rising; empty as long as they are 0, 1, 2, ...
    samples: Vec<u32>,
}

impl ChannelSamples {
    /// Nothing yet, with room for this many values.
    pub(crate) fn with_capacity(values: usize) -> Self {
        Self {
            values: Vec::with_capacity(values),
            samples: Vec::new(),
        }
    }

    /// Adds the value of a sample later than all before.
    pub(crate) fn push(&mut self, sample: u32, value: f32) {
        let is_gapless = self.samples.is_empty() && self.values.len() == sample as usize;
        if !is_gapless {
            if self.samples.is_empty() {
                self.samples.extend((0..).take(self.values.len()));
            }
            self.samples.push(sample);
        }
        self.values.push(value);
    }

    /// The value of a sample, if the channel was shaded there.
    pub(crate) fn get(&self, sample: u32) -> Option<f32> {
        let place = if self.samples.is_empty() {
            sample as usize
        } else {
            self.samples.binary_search(&sample).ok()?
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
        let shaded = [0, 1, 2, 5, 9, 10];
        let mut samples = ChannelSamples::default();
        for sample in shaded {
            samples.push(sample, sample as f32);
        }
        for sample in 0..20 {
            let expected = shaded.contains(&sample).then_some(sample as f32);
            assert_eq!(samples.get(sample), expected, "sample {sample}");
        }
        assert_eq!(samples.len(), shaded.len());
    }

    #[test]
    fn a_first_sample_that_is_not_the_roots_is_a_gap() {
        let mut samples = ChannelSamples::default();
        samples.push(3, 1.0);
        assert_eq!((samples.get(0), samples.get(3)), (None, Some(1.0)));
    }
}
