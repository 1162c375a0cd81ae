//! The figures of Meyer & Liu (1992) that show pictures or sensitivities, drawn from a stimulus set.
//!
//! Figures 3 and 4 are the sensitivities; 6 to 9 are sheets of images that are read through the manifest,
//! so that a figure never shows an image that was changed. Image pixels are copied as they are.
//!
//! Figures 1, 2 and 5 of the paper are other people's data; figure 10 is the analysis's.

mod channel_grey;
mod rasterizer;
pub(crate) mod samples_sheet;
mod sensitivity_plot;
mod sheet;
mod verified_set;

use std::fs;
use std::path::{Path, PathBuf};

use protocols::{Access, Channel, ChannelGroup, PerChannel, RayCount, Study, write_atomically};

use crate::error::RendererError;
use channel_grey::GreyScale;
use rasterizer::Rasterizer;
use sheet::{Sheet, Tile};
use verified_set::VerifiedSet;

/// The paper shows the five lowest ray counts, 10K to 50K.
const SHOWN_COUNTS: usize = 5;

/// Draws figures 3, 4 and 6 to 9 of the paper into the folder `out`, and gives the files.
///
/// # Errors
///
/// [`RendererError::Input`] if the stimulus set in `stimuli_dir` is not that of the study, is not complete
/// or was changed; other variants if a file could not be made.
pub fn draw_figures(
    study: &Study,
    stimuli_dir: &Path,
    out: &Path,
) -> Result<Vec<PathBuf>, RendererError> {
    let set = VerifiedSet::read(study, stimuli_dir)?;
    let rasterizer = Rasterizer::new();
    let mut drawn: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    for (name, svg) in sensitivity_plot::figures_3_and_4() {
        let png = rasterizer.png(&svg, 2.0, &out.join(name))?;
        drawn.push((out.join(format!("{name}.svg")), svg.into_bytes()));
        drawn.push((out.join(format!("{name}.png")), png));
    }
    let sheets = [
        ("figure-6.png", Some(figure_6(&set)?)),
        ("figure-7.png", figure_7(&set)?),
        (
            "figure-8.png",
            figure_8_or_9(&set, ChannelGroup::Achromatic)?,
        ),
        (
            "figure-9.png",
            figure_8_or_9(&set, ChannelGroup::Chromatic)?,
        ),
    ];
    for (name, sheet) in sheets {
        if let Some(sheet) = sheet {
            let path = out.join(name);
            let png = sheet.png(&rasterizer, &path)?;
            drawn.push((path, png));
        }
    }
    // Only now, when every image has been read and found good, is anything written.
    fs::create_dir_all(out).map_err(|error| RendererError::writing(out, error))?;
    for (path, bytes) in &drawn {
        write_atomically(path, bytes, Access::Ordinary)
            .map_err(|error| RendererError::writing(path, error))?;
    }
    Ok(drawn.into_iter().map(|(path, _)| path).collect())
}

/// The three channels of the ten anchor.
fn figure_6(set: &VerifiedSet<'_>) -> Result<Sheet, RendererError> {
    let rays = set.plan().anchors.ten_rays;
    let channels = set.channels(rays, rays)?;
    let scales = PerChannel::from_fn(|channel| GreyScale::of(channel, &channels[channel]));
    let tiles = Channel::ALL.map(|channel| Tile {
        heading: scales[channel].to_string(),
        picture: scales[channel].picture(&channels[channel]),
    });
    Ok(Sheet {
        title: format!("Figure 6: the A, C1 and C2 channels, {rays} samples each"),
        row_headings: vec![String::new()],
        rows: vec![tiles.into()],
    })
}

/// Each channel at the lowest ray counts.
fn figure_7(set: &VerifiedSet<'_>) -> Result<Option<Sheet>, RendererError> {
    let ten = set.plan().anchors.ten_rays;
    let best = set.channels(ten, ten)?;
    let mut rows = Vec::new();
    for channel in Channel::ALL {
        let Some((held, counts)) = shown_counts(set, channel.group()) else {
            return Ok(None);
        };
        let scale = GreyScale::of(channel, &best[channel]);
        let tile = |rays| {
            let (rays_a, rays_c1c2) = ray_counts(channel.group(), rays, held);
            Ok(Tile {
                heading: format!("{rays} rays"),
                picture: scale.picture(&set.channels(rays_a, rays_c1c2)?[channel]),
            })
        };
        let tiles: Result<Vec<Tile>, RendererError> = counts.into_iter().map(tile).collect();
        rows.push(tiles?);
    }
    Ok(Some(Sheet {
        title: "Figure 7: each channel as its number of rays rises".to_owned(),
        row_headings: Channel::ALL.map(|channel| channel.to_string()).into(),
        rows,
    }))
}

/// Figure 8 varies A, figure 9 varies C1 and C2; the other group is held.
fn figure_8_or_9(
    set: &VerifiedSet<'_>,
    group: ChannelGroup,
) -> Result<Option<Sheet>, RendererError> {
    let Some((held, counts)) = shown_counts(set, group) else {
        return Ok(None);
    };
    let (number, varied, other) = match group {
        ChannelGroup::Achromatic => (8, "A", "C1 and C2"),
        ChannelGroup::Chromatic => (9, "C1 and C2", "A"),
    };
    let tile = |rays| {
        let (rays_a, rays_c1c2) = ray_counts(group, rays, held);
        Ok(Tile {
            heading: format!("{varied} {rays}"),
            picture: set.picture(rays_a, rays_c1c2)?,
        })
    };
    let tiles: Result<Vec<Tile>, RendererError> = counts.into_iter().map(tile).collect();
    Ok(Some(Sheet {
        title: format!("Figure {number}: the number of rays of {varied} rises, {other} at {held}"),
        row_headings: vec![String::new()],
        rows: vec![tiles?],
    }))
}

/// The held ray count of the sequence that varies `group`, and the lowest counts of the group.
fn shown_counts(set: &VerifiedSet<'_>, group: ChannelGroup) -> Option<(RayCount, Vec<RayCount>)> {
    let mut sequences = set.plan().sequences.iter();
    let sequence = sequences.find(|sequence| sequence.varied == group)?;
    let counts = sequence.rays.iter().copied().take(SHOWN_COUNTS).collect();
    Some((sequence.held_rays, counts))
}

fn ray_counts(group: ChannelGroup, varied: RayCount, held: RayCount) -> (RayCount, RayCount) {
    match group {
        ChannelGroup::Achromatic => (varied, held),
        ChannelGroup::Chromatic => (held, varied),
    }
}
