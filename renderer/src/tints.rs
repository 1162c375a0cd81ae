//! What metal mirrors do to the colour of light: the products of their reflectances.
//!
//! A tint is a set of metals, each as often as light met it, in any order. There are few of them, so each is
//! given a number, and the number that a further metal leads to stands in a table.

use std::collections::BTreeMap;

use crate::scene::material::ReflectanceIndex;

/// The number of a tint; 0 is light that met no metal.
pub(crate) type TintIndex = u16;

/// A path that has met this many metals ends at the next one; fewer if a scene has too many metals.
const MAX_METALS: usize = 4;
/// No more tints than have numbers.
const MAX_TINTS: usize = 1 << 16;

/// All tints of a scene.
#[derive(Clone, Debug)]
pub(crate) struct Tints {
    /// For each tint the reflectances of its metals, rising; tints of fewer metals come first.
    metals: Vec<Vec<ReflectanceIndex>>,
    /// The tint after a tint and a metal, by `tint · number of metals + place of the metal`.
    next: Vec<Option<TintIndex>>,
    /// The reflectances of the scene's metals, rising.
    known: Vec<ReflectanceIndex>,
}

impl Tints {
    /// Every tint of up to [`MAX_METALS`] of these metals.
    pub(crate) fn of(metals: impl Iterator<Item = ReflectanceIndex>) -> Self {
        let mut known: Vec<ReflectanceIndex> = metals.collect();
        known.sort_unstable();
        known.dedup();
        let mut tints = vec![Vec::new()];
        let mut level = tints.clone();
        for _ in 0..MAX_METALS {
            level = one_more(&level, &known);
            if tints.len() + level.len() > MAX_TINTS {
                break;
            }
            tints.extend(level.iter().cloned());
        }
        let numbers: BTreeMap<&[ReflectanceIndex], TintIndex> =
            tints.iter().map(Vec::as_slice).zip(0..=u16::MAX).collect();
        let next = tints.iter().flat_map(|tint| {
            known.iter().map(|&metal| {
                let mut longer = tint.clone();
                longer.push(metal);
                longer.sort_unstable();
                numbers.get(longer.as_slice()).copied()
            })
        });
        let next = next.collect();
        Self {
            metals: tints,
            next,
            known,
        }
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.metals.len()
    }

    /// The metals of each tint.
    pub(crate) fn metals(&self) -> &[Vec<ReflectanceIndex>] {
        &self.metals
    }

    /// The tint after one more metal; `None` where the path ends.
    pub(crate) fn after(&self, tint: TintIndex, metal: ReflectanceIndex) -> Option<TintIndex> {
        let place = self.known.binary_search(&metal).ok()?;
        self.next[usize::from(tint) * self.known.len() + place]
    }
}

/// Each tint with each metal that does not come before its last one.
fn one_more(
    tints: &[Vec<ReflectanceIndex>],
    known: &[ReflectanceIndex],
) -> Vec<Vec<ReflectanceIndex>> {
    let longer = tints.iter().flat_map(|tint| {
        let last = tint.last().copied().unwrap_or(0);
        let further = known.iter().filter(move |&&metal| metal >= last);
        further.map(|&metal| {
            let mut longer = tint.clone();
            longer.push(metal);
            longer
        })
    });
    longer.take(MAX_TINTS).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_the_metals_does_not_matter_and_the_fifth_ends_the_path() {
        let tints = Tints::of([7, 3, 7].into_iter());
        // Multisets of at most 4 of 2 metals: 1 + 2 + 3 + 4 + 5.
        assert_eq!(tints.len(), 15);
        let walk = |metals: &[ReflectanceIndex]| {
            let mut metals = metals.iter();
            metals.try_fold(0, |tint, &metal| tints.after(tint, metal))
        };
        assert_eq!(walk(&[3, 7, 3]), walk(&[7, 3, 3]));
        assert_ne!(walk(&[3, 7, 3]), walk(&[7, 7, 3]));
        let number = walk(&[3, 7, 3, 3]).unwrap();
        assert_eq!(tints.metals()[usize::from(number)], [3, 3, 3, 7]);
        assert_eq!(walk(&[3, 7, 3, 3, 3]), None);
    }

    #[test]
    fn many_metals_shorten_the_paths() {
        let tints = Tints::of(0..300);
        assert_eq!(tints.len(), 1 + 300 + 300 * 301 / 2);
        let two = tints.after(0, 5).and_then(|tint| tints.after(tint, 9));
        assert!(two.is_some_and(|tint| tints.after(tint, 9).is_none()));
    }
}
