//! The map of samples and depths as a sheet to look at: two rows of three channels, and the scale of each row.
//!
//! Samples are coloured by `log2(1 + samples)`, depths by themselves; one scale for all channels of a row, so
//! that they can be compared. The colours are those of viridis (van der Walt & Smith 2015, CC0): dark blue is
//! few, yellow is many, and both differ in lightness for any colour vision.

use std::fmt::Write as _;
use std::path::Path;

use protocols::{Channel, PerChannel};

use super::rasterizer::{FONT_FAMILY, Rasterizer};
use super::sheet::copy;
use crate::channel_image::ChannelImage;
use crate::error::RendererError;
use crate::samples_map::SamplesMap;
use crate::srgb_png::SrgbImage;

/// Viridis at 0, 1/8, ..., 1.
const VIRIDIS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 45, 123],
    [59, 82, 139],
    [44, 114, 142],
    [33, 145, 140],
    [40, 174, 128],
    [94, 201, 98],
    [173, 220, 48],
    [253, 231, 37],
];

const MARGIN_PX: u32 = 20;
const TITLE_PX: u32 = 30;
const HEADING_PX: u32 = 44;
const BAR_PX: u32 = 14;
const LEGEND_PX: u32 = 56;
/// A picture is enlarged to about this, or reduced to no more than twice of it.
const TILE_PX: u32 = 400;

/// One row of the sheet.
struct Row<'a> {
    images: &'a PerChannel<ChannelImage>,
    /// Below the heading of each tile.
    notes: [String; 3],
    legend: &'static str,
    /// From a value to its place on the scale, not yet divided by that of the greatest.
    place: fn(f64) -> f64,
    least: f64,
    greatest: f64,
}

/// The bytes of the PNG file; `path` is only named in errors.
pub(crate) fn png(map: &SamplesMap, path: &Path) -> Result<Vec<u8>, RendererError> {
    let rows = [samples_row(map), depth_row(map)];
    let scale = Scale::of(map.samples.a.size_px());
    let mut sheet = Rasterizer::new().picture(&svg(&rows, scale), 1.0, path)?;
    for (place, row) in (0..).zip(&rows) {
        for (column, channel) in (0..).zip(Channel::ALL) {
            let picture = row.picture(&row.images[channel], scale);
            copy(&picture, &mut sheet, corner(place, column, scale));
        }
        copy(&bar(scale), &mut sheet, bar_corner(place, scale));
    }
    sheet.to_png(path)
}

fn samples_row(map: &SamplesMap) -> Row<'_> {
    let note = |channel: Channel| {
        let values = map.samples[channel].values();
        let sum: f64 = values.iter().copied().map(f64::from).sum();
        let mean = sum / values.len() as f64;
        let (least, greatest) = range([&map.samples[channel]]);
        format!("{sum} samples; {least} to {greatest} a pixel, mean {mean:.2}")
    };
    let (_, greatest) = range(Channel::ALL.map(|channel| &map.samples[channel]));
    Row {
        images: &map.samples,
        notes: Channel::ALL.map(note),
        legend: "samples in a pixel",
        place: libm::log1p,
        least: 0.0,
        greatest: greatest.max(1.0),
    }
}

fn depth_row(map: &SamplesMap) -> Row<'_> {
    let note = |channel: Channel| {
        let (least, greatest) = range([&map.depths[channel]]);
        format!("depth of the tree from {least} to {greatest}")
    };
    let (least, greatest) = range(Channel::ALL.map(|channel| &map.depths[channel]));
    Row {
        images: &map.depths,
        notes: Channel::ALL.map(note),
        legend: "depth of the tree at the centre of a pixel",
        place: |depth| depth,
        least,
        greatest: greatest.max(least + 1.0),
    }
}

fn range<const N: usize>(images: [&ChannelImage; N]) -> (f64, f64) {
    let values = images.into_iter().flat_map(ChannelImage::values);
    let both = values.copied_range();
    (both.0, both.1)
}

/// The least and the greatest of some values.
trait ValueRange {
    fn copied_range(self) -> (f64, f64);
}

impl<'a, I: Iterator<Item = &'a f32>> ValueRange for I {
    fn copied_range(self) -> (f64, f64) {
        self.fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            |(least, most), &value| {
                let value = f64::from(value);
                (least.min(value), most.max(value))
            },
        )
    }
}

impl Row<'_> {
    fn color(&self, value: f64) -> [u8; 3] {
        let [from, to] = [self.least, self.greatest].map(self.place);
        viridis(((self.place)(value) - from) / (to - from))
    }

    /// A channel in colours, enlarged or reduced.
    fn picture(&self, image: &ChannelImage, scale: Scale) -> SrgbImage {
        let [width, height] = scale.tile_px;
        let mut bytes = Vec::with_capacity(3 * (width * height) as usize);
        for y in 0..height {
            for x in 0..width {
                bytes.extend(self.color(scale.value(image, [x, y])));
            }
        }
        SrgbImage {
            size_px: scale.tile_px,
            bytes,
            out_of_gamut_px: 0,
        }
    }

    /// Whole values with their places on the bar, from 0 to 1; none nearer than `apart` to another.
    fn ticks(&self, apart: f64) -> Vec<(f64, f64)> {
        let [from, to] = [self.least, self.greatest].map(self.place);
        let mut ticks: Vec<(f64, f64)> = Vec::new();
        let mut value = self.least;
        while value <= self.greatest {
            let place = ((self.place)(value) - from) / (to - from);
            let is_free = ticks.last().is_none_or(|&(_, last)| place - last >= apart);
            if is_free && (value == self.least || 1.0 - place >= apart) {
                ticks.push((value, place));
            }
            value += 1.0;
        }
        ticks.push((self.greatest, 1.0));
        ticks
    }
}

/// All colours from the least to the greatest value.
fn bar(scale: Scale) -> SrgbImage {
    let width = scale.tile_px[0];
    let line: Vec<u8> = (0..width)
        .flat_map(|x| viridis(f64::from(x) / f64::from(width.max(2) - 1)))
        .collect();
    SrgbImage {
        size_px: [width, BAR_PX],
        bytes: line.repeat(BAR_PX as usize),
        out_of_gamut_px: 0,
    }
}

/// The colour at a place from 0 to 1.
fn viridis(place: f64) -> [u8; 3] {
    let place = place.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let below = (0..VIRIDIS.len() - 1)
        .rev()
        .find(|&below| below as f64 <= place);
    let below = below.unwrap_or(0);
    let part = place - below as f64;
    std::array::from_fn(|primary| {
        let [from, to] = [below, below + 1].map(|at| f64::from(VIRIDIS[at][primary]));
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between two codes"
        )]
        let code = (from + part * (to - from) + 0.5) as u8;
        code
    })
}

/// How many pixels of the sheet a pixel of the picture has, or the other way round.
#[derive(Clone, Copy, Debug)]
struct Scale {
    enlarged: u32,
    reduced: u32,
    tile_px: [u32; 2],
}

impl Scale {
    fn of(size_px: [u32; 2]) -> Self {
        let longest = size_px[0].max(size_px[1]);
        let enlarged = (TILE_PX / longest).max(1);
        let reduced = longest.div_ceil(2 * TILE_PX);
        Self {
            enlarged,
            reduced,
            tile_px: size_px.map(|size| (enlarged * size).div_ceil(reduced)),
        }
    }

    /// The value at a pixel of the tile: of one pixel, or the mean of those that it stands for.
    fn value(self, image: &ChannelImage, at: [u32; 2]) -> f64 {
        let [width, height] = image.size_px();
        let [left, top] = at.map(|place| place * self.reduced / self.enlarged);
        let [right, bottom] =
            [(left, width), (top, height)].map(|(start, size)| (start + self.reduced).min(size));
        let mut sum = 0.0;
        for row in top..bottom {
            let start = (row * width) as usize;
            let row = &image.values()[start + left as usize..start + right as usize];
            sum += row.iter().copied().map(f64::from).sum::<f64>();
        }
        sum / f64::from(((right - left) * (bottom - top)).max(1))
    }
}

fn corner(row: u32, column: u32, scale: Scale) -> [u32; 2] {
    let [width, height] = scale.tile_px;
    let left = MARGIN_PX + column * (column_px(scale) + MARGIN_PX);
    // A narrow picture stands in the middle of a column that has room for its heading.
    let left = left + (column_px(scale) - width) / 2;
    let row_px = HEADING_PX + height + LEGEND_PX;
    [left, MARGIN_PX + TITLE_PX + HEADING_PX + row * row_px]
}

fn column_px(scale: Scale) -> u32 {
    scale.tile_px[0].max(TILE_PX)
}

fn bar_corner(row: u32, scale: Scale) -> [u32; 2] {
    let [left, top] = corner(row, 0, scale);
    [left, top + scale.tile_px[1] + 10]
}

fn svg(rows: &[Row<'_>; 2], scale: Scale) -> String {
    let width = 3 * column_px(scale) + 4 * MARGIN_PX;
    let height = corner(2, 0, scale)[1] - HEADING_PX + MARGIN_PX;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         font-family=\"{FONT_FAMILY}\" fill=\"#111\">"
    );
    let mut text = |x: u32, y: u32, (size, anchor): (u32, &str), words: &str| {
        // Writing to a `String` cannot fail.
        _ = write!(
            svg,
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\">{words}</text>"
        );
    };
    let reduced = match scale.reduced {
        1 => String::new(),
        n => format!("; each dot is the mean of {n} x {n} pixels"),
    };
    let title = format!("Samples and depth of the tree, by channel{reduced}");
    text(MARGIN_PX, MARGIN_PX + 20, (22, "start"), &title);
    for (place, row) in (0..).zip(rows) {
        for (column, (channel, note)) in (0..).zip(Channel::ALL.into_iter().zip(&row.notes)) {
            let [left, top] = corner(place, column, scale);
            text(left, top - 24, (18, "start"), &channel.to_string());
            text(left, top - 7, (13, "start"), note);
        }
        let [left, top] = bar_corner(place, scale);
        let length = f64::from(scale.tile_px[0]);
        for (value, at) in row.ticks(28.0 / length) {
            let x = to_px(f64::from(left) + at * length);
            let anchor = match at {
                0.0 => "start",
                1.0 => "end",
                _ => "middle",
            };
            text(x, top + BAR_PX + 14, (12, anchor), &value.to_string());
        }
        let [beside, _] = corner(place, 1, scale);
        text(beside, top + BAR_PX - 2, (13, "start"), row.legend);
    }
    svg.push_str("</svg>");
    svg
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a place on the sheet"
)]
fn to_px(place: f64) -> u32 {
    place as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_the_scale_are_the_ends_of_viridis_and_steps_lie_between() {
        assert_eq!(viridis(0.0), VIRIDIS[0]);
        assert_eq!(viridis(1.0), VIRIDIS[8]);
        assert_eq!(viridis(0.5), VIRIDIS[4]);
        // Half way from (68, 1, 84) to (71, 45, 123), halves rounded up.
        assert_eq!(viridis(1.0 / 16.0), [70, 23, 104]);
    }

    #[test]
    fn a_large_picture_is_reduced_by_means_and_a_small_one_enlarged() {
        let values = (0..1600 * 2).map(|place| (place % 2) as f32).collect();
        let image = ChannelImage::new([1600, 2], values).unwrap();
        let scale = Scale::of([1600, 2]);
        assert_eq!(scale.tile_px, [800, 1]);
        assert_eq!(scale.value(&image, [7, 0]), 0.5);
        let small = ChannelImage::new([2, 1], vec![3.0, 5.0]).unwrap();
        let scale = Scale::of([2, 1]);
        assert_eq!(scale.tile_px, [400, 200]);
        assert_eq!(scale.value(&small, [199, 199]), 3.0);
        assert_eq!(scale.value(&small, [200, 0]), 5.0);
    }

    #[test]
    fn ticks_hold_the_ends_and_stand_apart() {
        let image = || ChannelImage::new([1, 1], vec![0.0]).unwrap();
        let images = PerChannel::from_fn(|_| image());
        let row = Row {
            images: &images,
            notes: [(); 3].map(|()| String::new()),
            legend: "",
            place: libm::log1p,
            least: 0.0,
            greatest: 31.0,
        };
        let ticks = row.ticks(0.1);
        assert_eq!(ticks.first(), Some(&(0.0, 0.0)));
        assert_eq!(ticks.last(), Some(&(31.0, 1.0)));
        assert!(ticks.windows(2).all(|pair| pair[1].1 - pair[0].1 >= 0.1));
        assert!(ticks.len() > 4);
    }
}
