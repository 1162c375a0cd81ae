//! The images of a set, small, side by side.

use eframe::egui::{
    Align, ColorImage, Image, Layout, RichText, TextStyle, TextureHandle, TextureOptions, Ui, vec2,
};
use experiment::{ScreenImage, StimulusSet};
use protocols::Study;

use super::fault::Fault;
use super::job::{Job, WhenDropped};
use super::look;
use super::study_state::StudyState;

/// The longer side of a small image, on the screen, at least.
const SIDE: f32 = 140.0;
/// Between two of them.
const GAP: f32 = 11.0;
/// Its pixels, enough for a screen of twice the usual density.
const SIDE_PX: usize = 300;

/// A name and its picture.
type Named<T> = Vec<(String, T)>;

/// The small images, once they are read.
#[derive(Default)]
pub(crate) struct Gallery {
    reading: Option<Job<Result<Named<ColorImage>, Fault>>>,
    shown: Option<Result<Named<TextureHandle>, Fault>>,
}

impl Gallery {
    /// The images in rows; they are read when they are first wanted.
    pub(crate) fn show(&mut self, ui: &mut Ui, state: &StudyState) {
        self.take(ui, state);
        look::card(ui, |ui| match &self.shown {
            None => {
                ui.horizontal(|ui| {
                    ui.spinner();
                    look::weak(ui, "Reading the images");
                });
            }
            Some(Err(fault)) => look::facts(ui, fault.rows()),
            Some(Ok(images)) => {
                let (columns, side) = columns(ui.available_width());
                ui.spacing_mut().item_spacing = vec2(GAP, 14.0);
                for images in images.chunks(columns) {
                    ui.horizontal_top(|ui| row(ui, images, side));
                }
            }
        });
    }

    fn take(&mut self, ui: &Ui, state: &StudyState) {
        if self.shown.is_some() {
            return;
        }
        let reading = self.reading.get_or_insert_with(|| {
            let (study, folder) = (state.study.clone(), state.folders.stimuli.clone());
            Job::start(ui.ctx(), WhenDropped::Leave, move |_| {
                let set = StimulusSet::read(&study, &folder).map_err(Fault::of)?;
                small_images(&study, &set).map_err(Fault::of)
            })
        });
        if let Some(read) = reading.poll() {
            let upload = |(name, image): (String, ColorImage)| {
                let texture = ui.ctx().load_texture(&name, image, TextureOptions::LINEAR);
                (name, texture)
            };
            let read = read.and_then(|images| images);
            self.shown = Some(read.map(|images| images.into_iter().map(upload).collect()));
            self.reading = None;
        }
    }
}

/// How many small images stand side by side in this width, and how large they then are.
fn columns(width: f32) -> (usize, f32) {
    let mut count = 1;
    let mut side = width;
    while side > SIDE {
        let next = (width - GAP * count as f32) / (count + 1) as f32;
        if next < SIDE {
            break;
        }
        (count, side) = (count + 1, next);
    }
    (count, side)
}

fn row(ui: &mut Ui, images: &[(String, TextureHandle)], side: f32) {
    for (name, texture) in images {
        captioned(ui, name, (texture, side));
    }
}

fn captioned(ui: &mut Ui, name: &str, (texture, side): (&TextureHandle, f32)) {
    let size = texture.size_vec2();
    let size = size * (side / size.max_elem());
    ui.allocate_ui_with_layout(
        vec2(side, size.y + 24.0),
        Layout::top_down(Align::Min),
        |ui| {
            ui.set_width(side);
            ui.spacing_mut().item_spacing.y = 4.0;
            ui.add(
                Image::from_texture(texture)
                    .fit_to_exact_size(size)
                    .corner_radius(4)
                    .alt_text(name),
            );
            ui.label(RichText::new(name).text_style(TextStyle::Small));
        },
    );
}

/// Every image of the study, in its order.
fn small_images(
    study: &Study,
    set: &StimulusSet,
) -> Result<Named<ColorImage>, protocols::InputError> {
    let rendered = study.protocol.stimuli.rendered();
    let stimuli = rendered
        .map(protocols::StimulusPlan::stimuli)
        .unwrap_or_default();
    let images = study.protocol.stimuli.images();
    let named = images.into_iter().map(|image| {
        let rays = stimuli.iter().find(|stimulus| stimulus.id == image.id);
        let name = match rays {
            Some(rays) => format!("A {}, C {}", rays.rays_a, rays.rays_c1c2),
            None => image.id.to_string(),
        };
        Ok((name, small(set.image(&image.id)?, SIDE_PX)))
    });
    named.collect()
}

/// The image with its longer side at most `side` pixels: each pixel is the mean of those that it covers.
pub(crate) fn small(image: &ScreenImage, side: usize) -> ColorImage {
    let [width, height] = image.size_px.map(|pixels| pixels as usize);
    let longer = width.max(height).max(1);
    let scaled = |pixels: usize| (pixels * side.min(longer) / longer).max(1);
    let size = [scaled(width), scaled(height)];
    let span = |index: usize, of: usize, whole: usize| {
        let start = index * whole / of;
        start..((index + 1) * whole / of).max(start + 1)
    };
    let mut rgb = Vec::with_capacity(size[0] * size[1] * 3);
    for y in 0..size[1] {
        for x in 0..size[0] {
            let (columns, rows) = (span(x, size[0], width), span(y, size[1], height));
            let count = columns.len() * rows.len();
            let lines =
                rows.map(|row| 3 * (row * width + columns.start)..3 * (row * width + columns.end));
            let pixels = lines.flat_map(|line| image.rgb[line].chunks_exact(3));
            let sums = pixels.fold([0_usize; 3], |sums, pixel| {
                [0, 1, 2].map(|part| sums[part] + usize::from(pixel[part]))
            });
            let mean = |sum: usize| u8::try_from((sum + count / 2) / count).unwrap_or(u8::MAX);
            rgb.extend(sums.map(mean));
        }
    }
    ColorImage::from_rgb(size, &rgb)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 7 of 144.57 and 6 gaps of 11 are 1078; of 660, 4 of 156.75 and 3 gaps.
    #[test]
    fn a_row_fills_its_width() {
        for (width, count) in [(1078.0_f32, 7), (660.0, 4), (150.0, 1), (100.0, 1)] {
            let (found, side) = columns(width);
            assert_eq!(found, count, "{width}");
            let filled = side * count as f32 + GAP * (count - 1) as f32;
            assert!((filled - width).abs() < 0.01, "{width}: {filled}");
        }
    }

    #[test]
    fn a_small_image_holds_the_means_of_the_large_one() {
        // Two by two blocks of 10 and 20, 0 and 200: means by hand.
        let grey = [10, 20, 0, 200, 10, 20, 0, 200];
        let image = ScreenImage {
            size_px: [4, 2],
            rgb: grey.iter().flat_map(|&code| [code; 3]).collect(),
        };
        let small = small(&image, 2);
        assert_eq!(small.size, [2, 1]);
        let reds: Vec<u8> = small.pixels.iter().map(eframe::egui::Color32::r).collect();
        assert_eq!(reds, [15, 100]);
    }

    #[test]
    fn an_image_that_is_small_already_stays_as_it_is() {
        let rgb: Vec<u8> = (0..3 * 15).collect();
        let image = ScreenImage {
            size_px: [5, 3],
            rgb: rgb.clone(),
        };
        let same = small(&image, 100);
        assert_eq!(same.size, [5, 3]);
        let found: Vec<u8> = (same.pixels.iter())
            .flat_map(|pixel| [pixel.r(), pixel.g(), pixel.b()])
            .collect();
        assert_eq!(found, rgb);
    }
}
