//! The order of the trials: a subject's own, and the same whenever it is asked for.
//!
//! First the practice images as the protocol lists them, then, block by block, every image that belongs to
//! a sequence, shuffled. The zero anchor belongs to none and is never rated outside practice.

use std::collections::BTreeMap;

use protocols::rating::Phase;
use protocols::{Protocol, StimulusId, StimulusPlan, SubjectId};

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
    /// The level of each factor, in the order of [`StimulusPlan::factors`].
    pub levels: Vec<String>,
}

/// All trials of one session, in the subject's own order.
///
/// The order of the test trials depends on `order_seed`, the subject and the session alone: one ChaCha20
/// stream keyed by the SHA-256 of `acuity trial order 1, seed S, subject ID, session N` shuffles each
/// block, one after another.
pub fn trials(protocol: &Protocol, subject: &SubjectId, session: u32) -> Vec<Trial> {
    let stimuli = protocol.stimuli.stimuli();
    let levels: BTreeMap<&StimulusId, Vec<String>> = stimuli
        .iter()
        .map(|stimulus| {
            let levels = stimulus.factors();
            let level = |factor: &String| levels.get(factor).cloned().unwrap_or_default();
            let levels = StimulusPlan::factors().iter().map(level).collect();
            (&stimulus.id, levels)
        })
        .collect();
    let rated = stimuli
        .iter()
        .filter(|stimulus| !stimulus.sequences.is_empty());
    let rated: Vec<&StimulusId> = rated.map(|stimulus| &stimulus.id).collect();

    let seed = protocol.session.order_seed;
    let purpose =
        format!("acuity trial order 1, seed {seed}, subject {subject}, session {session}");
    let mut random = Random::keyed_by(&purpose);
    let mut shown: Vec<(Phase, &StimulusId)> = Vec::new();
    shown.extend(
        protocol
            .session
            .practice
            .iter()
            .map(|id| (Phase::Practice, id)),
    );
    for _ in 0..protocol.session.blocks {
        let mut block = rated.clone();
        random.shuffle(&mut block);
        shown.extend(block.into_iter().map(|id| (Phase::Test, id)));
    }

    let mut seen: BTreeMap<(bool, &StimulusId), u32> = BTreeMap::new();
    let numbered = (1..).zip(shown).map(|(trial_id, (phase, id))| {
        let repetition = seen.entry((phase == Phase::Test, id)).or_insert(0);
        *repetition += 1;
        Trial {
            trial_id,
            phase,
            stimulus_id: id.clone(),
            repetition: *repetition,
            levels: levels.get(id).cloned().unwrap_or_default(),
        }
    });
    numbered.collect()
}
