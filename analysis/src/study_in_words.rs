//! The design of a study in words, from its protocol.

use protocols::{ChannelGroup, Layout, PictureSet, Protocol, RayCount, Stimuli, StimulusPlan};

use crate::page::escaped;
use crate::results_text::group_name;

/// What was made, what was rated against what, and how it was shown.
pub(crate) fn design_in_words(protocol: &Protocol) -> String {
    let made = match &protocol.stimuli {
        Stimuli::Rendered(plan) => sequences_in_words(plan),
        Stimuli::Pictures(pictures) => factors_in_words(pictures),
    };
    let images = protocol.stimuli.images();
    let n_shown = images.iter().filter(|image| image.is_rated).count();
    let layout = match protocol.session.layout {
        Layout::Flanking => "between the two, all three at once,",
        Layout::Sequence => "after the one and before the other, one at a time,",
        Layout::Single => "alone",
        Layout::Dsis => "after that one",
        Layout::Dscqs => "twice in turn with that one, both being rated,",
    };
    let scale = protocol.session.scale;
    format!(
        "{made} Each of the {n_shown} images was rated from {} to {}{}. The image to be rated was shown {layout} for {} s.",
        scale.lowest,
        scale.highest,
        anchors_in_words(protocol),
        protocol.session.exposure_s
    )
}

fn sequences_in_words(plan: &StimulusPlan) -> String {
    let sequences: Vec<String> = (plan.sequences.iter().enumerate())
        .map(|(index, sequence)| {
            let range = [sequence.rays.first(), sequence.rays.last()]
                .map(|rays| rays.map_or_else(String::new, RayCount::to_string));
            format!(
                "in {} sequence the {} channel{} had {} to {} rays and the rest {}",
                if index == 0 { "one" } else { "another" },
                group_name(sequence.varied),
                if sequence.varied == ChannelGroup::Chromatic {
                    "s"
                } else {
                    ""
                },
                range[0],
                range[1],
                sequence.held_rays
            )
        })
        .collect();
    format!(
        "One scene was ray traced so that its achromatic (A) and chromatic (C1, C2) channels had different numbers of \
         spatial samples, here called rays: {}.",
        sequences.join("; ")
    )
}

fn factors_in_words(pictures: &PictureSet) -> String {
    let levels = |place: usize| {
        let rated = pictures.table.pictures.iter().filter(|p| p.is_rated());
        let mut levels: Vec<&str> = rated.map(|p| p.levels[place].as_str()).collect();
        levels.sort_by(|left, right| crate::natural_order(left, right));
        levels.dedup();
        escaped(&levels.join(", "))
    };
    let factors = pictures.table.factors.iter().enumerate();
    let factors: Vec<String> = factors
        .map(|(place, name)| format!("{} ({})", escaped(name), levels(place)))
        .collect();
    format!(
        "The images were pictures made elsewhere, which differ in {}.",
        factors.join(", ")
    )
}

/// What the images were rated against.
fn anchors_in_words(protocol: &Protocol) -> String {
    let scale = protocol.session.scale;
    let [zero, ten] = match &protocol.stimuli {
        Stimuli::Rendered(plan) => [
            format!(
                "an image with {} rays in all channels",
                plan.anchors.zero_rays
            ),
            format!("one with {}", plan.anchors.ten_rays),
        ],
        Stimuli::Pictures(pictures) => match &pictures.anchors {
            Some([zero, ten]) => [zero, ten].map(|id| format!("the picture {id}")),
            None => [(); 2].map(|()| "its undisturbed picture".to_owned()),
        },
    };
    match protocol.session.layout {
        Layout::Flanking | Layout::Sequence => format!(
            " against {zero}, which stands for {}, and {ten}, which stands for {}",
            scale.lowest, scale.highest
        ),
        Layout::Single => String::new(),
        Layout::Dsis | Layout::Dscqs => match protocol.stimuli.rendered() {
            Some(plan) => {
                format!(
                    " against an image with {} rays in all channels",
                    plan.anchors.ten_rays
                )
            }
            None => format!(" against {ten}"),
        },
    }
}
