//! The order of the trials: a subject's own, and the same whenever it is asked for.
//!
//! First the practice images as the protocol lists them, then, block by block, every image that is rated. An
//! image that is only an anchor is rated outside practice only where the protocol repeats the anchors.

use std::collections::BTreeMap;

use protocols::rating::Phase;
use protocols::{
    InputError, Layout, LevelBlocks, OrderScheme, RunLimit, StimulusId, Study, SubjectId,
};

use crate::arrangement::{Arrangement, Limits, RunOfLevels};
use crate::latin_square;
use crate::picture::First;
use crate::random::Random;

/// One trial to come: what is shown, and how it stands in the ratings file.
#[derive(Clone, Debug, PartialEq, Eq)]
#[expect(clippy::struct_field_names, reason = "the names of the columns")]
pub struct Trial {
    /// Its number in the session, practice included, from 1.
    pub trial_id: u32,
    /// Whether it counts.
    pub phase: Phase,
    /// The test image.
    pub stimulus_id: StimulusId,
    /// The how-manieth time in this phase that the subject sees this image, from 1.
    pub repetition: u32,
    /// Which member of a pair comes first; by lot where the protocol has pairs.
    pub first: First,
    /// The level of each factor, in the order of `Stimuli::factors`.
    pub levels: Vec<String>,
}

/// All trials of one session, in the subject's own order.
///
/// The order of the test trials depends on `order_seed`, the subject and the session alone: one ChaCha20
/// stream keyed by the SHA-256 of `acuity trial order 1, seed S, subject ID, session N` shuffles each
/// block, one after another, until the order is as the protocol's `[session.order]` wants it. What is balanced
/// across subjects depends on the number at the end of the subject's code.
///
/// # Errors
///
/// No order can be as the protocol wants it, or the subject's code has no number to balance by.
pub fn trials(study: &Study, subject: &SubjectId, session: u32) -> Result<Vec<Trial>, InputError> {
    let order = Order::new(study, subject, session)?;
    let seed = study.protocol.session.order_seed;
    let purpose =
        format!("acuity trial order 1, seed {seed}, subject {subject}, session {session}");
    let tested = order.draw(&mut Random::keyed_by(&purpose))?;
    let practice = study.protocol.session.practice.iter();
    let tested = tested
        .iter()
        .map(|&image| (Phase::Test, &order.images[image].0));
    let shown = practice.map(|id| (Phase::Practice, id)).chain(tested);

    let levels: BTreeMap<_, _> = order
        .images
        .iter()
        .map(|(id, levels)| (id, levels))
        .collect();
    let of_pairs =
        format!("acuity pair order 1, seed {seed}, subject {subject}, session {session}");
    let has_pairs = study.protocol.session.layout == Layout::Dscqs;
    let mut lots = has_pairs.then(|| Random::keyed_by(&of_pairs));
    let mut seen: BTreeMap<(bool, &StimulusId), u32> = BTreeMap::new();
    let numbered = (1..).zip(shown).map(|(trial_id, (phase, id))| {
        let repetition = seen.entry((phase == Phase::Test, id)).or_insert(0);
        *repetition += 1;
        Trial {
            trial_id,
            phase,
            stimulus_id: id.clone(),
            repetition: *repetition,
            first: match lots.as_mut().map(|lots| lots.index(2)) {
                None | Some(0) => First::Test,
                Some(_) => First::Reference,
            },
            levels: levels.get(id).copied().cloned().unwrap_or_default(),
        }
    });
    Ok(numbered.collect())
}

/// What the order of one session is made from.
struct Order<'a> {
    study: &'a Study,
    /// Every image of the study with its levels.
    images: Vec<(StimulusId, Vec<String>)>,
    /// The images of a block, by their place in `images`.
    rated: Vec<usize>,
    /// The anchors, where they are repeated.
    anchors: Vec<usize>,
    /// Which row of a Latin square this session takes.
    row: usize,
}

impl<'a> Order<'a> {
    fn new(study: &'a Study, subject: &SubjectId, session: u32) -> Result<Self, InputError> {
        let stimuli = &study.protocol.stimuli;
        let images = stimuli.images();
        let anchors = [stimuli.zero_anchor(), stimuli.ten_anchor()];
        let is_rated = |&index: &usize| images[index].is_rated;
        let is_anchor = |&index: &usize| anchors.iter().flatten().any(|id| *id == images[index].id);
        let order = &study.protocol.session.order;
        let row = match (order.is_counterbalanced(), subject.number()) {
            (false, _) => 0,
            (true, Some(number)) => number as usize + session as usize,
            (true, None) => {
                let expected = "a code that ends in a number, such as 01: the protocol balances the order across subjects";
                return Err(
                    InputError::new(&study.path, format!("subject {subject}"), expected)
                        .at("field session.order"),
                );
            }
        };
        Ok(Self {
            study,
            rated: (0..images.len()).filter(is_rated).collect(),
            anchors: (0..images.len()).filter(is_anchor).collect(),
            images: images
                .into_iter()
                .map(|image| (image.id, image.levels))
                .collect(),
            row,
        })
    }

    /// The test images of all blocks.
    fn draw(&self, random: &mut Random) -> Result<Vec<usize>, InputError> {
        let plan = &self.study.protocol.session;
        let limits = Limits {
            runs: self.runs(&plan.order.most_in_a_row)?,
            gaps: self.gaps(),
        };
        let mut images = Vec::new();
        let mut segments = Vec::new();
        for block in 0..plan.blocks as usize {
            for part in self.block(block, random)? {
                let start = images.len();
                images.extend(part);
                segments.push(start..images.len());
            }
        }
        if plan.order.scheme == OrderScheme::LatinSquare {
            return Ok(images);
        }
        let mut arrangement = Arrangement {
            images,
            segments,
            limits: &limits,
        };
        arrangement.draw(random).map_err(|reason| {
            InputError::new(&self.study.path, "limits that no order keeps", reason)
                .at("field session.order")
                .remedy("loosen a limit")
        })?;
        Ok(arrangement.images)
    }

    /// The images of one block, in the parts that stay together.
    fn block(&self, block: usize, random: &mut Random) -> Result<Vec<Vec<usize>>, InputError> {
        let order = &self.study.protocol.session.order;
        if order.scheme == OrderScheme::LatinSquare {
            let row = latin_square::row(self.rated.len(), self.row + block);
            return Ok(vec![
                row.into_iter().map(|place| self.rated[place]).collect(),
            ]);
        }
        let mut images = self.rated.clone();
        for _ in 0..order.anchor_repeats {
            images.extend(&self.anchors);
        }
        match &order.blocked_by {
            None => Ok(vec![images]),
            Some(blocks) => self.parts(blocks, &images, self.row + block, random),
        }
    }

    /// The images of a block by level, the levels in the order of a row of the Latin square.
    fn parts(
        &self,
        blocks: &LevelBlocks,
        images: &[usize],
        row: usize,
        random: &mut Random,
    ) -> Result<Vec<Vec<usize>>, InputError> {
        let factor = self.factor(&blocks.factor, "session.order.blocked_by.factor")?;
        let mut parts = vec![Vec::new(); blocks.levels.len()];
        for &image in images {
            let level = &self.images[image].1[factor];
            let named = blocks.levels.iter().position(|named| named == level);
            let part = named.unwrap_or_else(|| random.index(parts.len()));
            parts[part].push(image);
        }
        if let Some(empty) = parts.iter().position(Vec::is_empty) {
            let found = format!("{:?}", blocks.levels[empty]);
            return Err(
                InputError::new(&self.study.path, found, "levels that images have")
                    .at("field session.order.blocked_by.levels"),
            );
        }
        let row = latin_square::row(parts.len(), row);
        Ok(row
            .into_iter()
            .map(|part| std::mem::take(&mut parts[part]))
            .collect())
    }

    fn runs(&self, limits: &[RunLimit]) -> Result<Vec<RunOfLevels>, InputError> {
        let run = |limit: &RunLimit| {
            let factor = self.factor(&limit.factor, "session.order.most_in_a_row")?;
            let levels = self.images.iter().map(|(_, levels)| levels[factor].clone());
            Ok(RunOfLevels {
                factor: limit.factor.clone(),
                levels: levels.collect(),
                most: limit.most as usize,
            })
        };
        limits.iter().map(run).collect()
    }

    /// The gap of each image; an anchor that is repeated keeps half of the mean distance of its showings.
    fn gaps(&self) -> Vec<usize> {
        let order = &self.study.protocol.session.order;
        let gap = order.repeat_gap as usize;
        let mut gaps = vec![gap; self.images.len()];
        let repeats = order.anchor_repeats as usize;
        if repeats > 0 {
            let length = self.rated.len() + repeats * self.anchors.len();
            for &anchor in &self.anchors {
                let showings = repeats + usize::from(self.rated.contains(&anchor));
                gaps[anchor] = gap.max(length / showings / 2);
            }
        }
        gaps
    }

    fn factor(&self, name: &str, place: &str) -> Result<usize, InputError> {
        let factors = self.study.protocol.stimuli.factors();
        let place_of = factors.iter().position(|factor| factor == name);
        place_of.ok_or_else(|| {
            let expected = format!("a factor of the stimuli: {}", factors.join(", "));
            InputError::new(&self.study.path, format!("{name:?}"), expected)
                .at(format!("field {place}"))
        })
    }
}
