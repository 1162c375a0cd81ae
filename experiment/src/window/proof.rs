//! The proof before the first screen: what the window really holds is compared with the bytes to be shown.
//!
//! Each picture of the first trial is drawn once, read back from the window, and compared pixel by pixel with
//! the images of the set. One pixel that differs (a scaled, dithered or colour-managed window) stops the
//! session.

use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui::{ColorImage, Context};

use super::geometry::Geometry;
use super::paint::Pictures;
use crate::{ExperimentError, Picture, ScreenImage, Session};
use protocols::StimulusId;

type Shot = Arc<Mutex<Option<Arc<ColorImage>>>>;

/// How far the comparison has come.
#[derive(Debug)]
pub(crate) struct Proof {
    test_image: Option<StimulusId>,
    waiting: Vec<Picture>,
    asked: Option<Picture>,
    shot: Shot,
    compared_px: u64,
}

impl Proof {
    /// A comparison of the pictures of the trial that comes first.
    pub(crate) fn of(session: &Session) -> Self {
        let first = session.first_pictures();
        Self {
            test_image: first.as_ref().map(|(trial, _)| trial.stimulus_id.clone()),
            waiting: first.map(|(_, pictures)| pictures).unwrap_or_default(),
            asked: None,
            shot: Shot::default(),
            compared_px: 0,
        }
    }

    /// What this frame must show: a picture with the test image of the trial.
    pub(crate) fn picture(&self) -> Option<(Picture, &StimulusId)> {
        let picture = self.asked.or_else(|| self.waiting.last().copied());
        picture.zip(self.test_image.as_ref())
    }

    /// How many pixels were compared.
    pub(crate) fn compared_px(&self) -> u64 {
        self.compared_px
    }

    /// Takes a screenshot that has come, or asks for the next; true when all is compared.
    ///
    /// # Errors
    ///
    /// A pixel of the window is not that of the image.
    pub(crate) fn advance(
        &mut self,
        context: &Context,
        geometry: Geometry,
        pictures: &Pictures,
        gap_px: u32,
    ) -> Result<bool, ExperimentError> {
        let shot = self
            .shot
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .take();
        if let (Some(shot), Some(picture), Some(test_image)) = (shot, self.asked, &self.test_image)
        {
            self.asked = None;
            let size = pictures.image_px.map(|pixels| pixels as f32);
            for (slot, rect) in geometry.images(picture, size.into(), gap_px as f32) {
                let Some(id) = pictures.id(slot, test_image) else {
                    continue;
                };
                let corner = [rect.left(), rect.top()];
                self.compared_px += compare(&shot, corner, id, pictures.image(id)?)?;
            }
        }
        if self.asked.is_none() {
            let Some(next) = self.waiting.pop() else {
                return Ok(true);
            };
            self.asked = Some(next);
            let shot = Arc::clone(&self.shot);
            let wake = context.clone();
            context.request_screenshot(move |image| {
                *shot.lock().unwrap_or_else(PoisonError::into_inner) = Some(image);
                wake.request_repaint();
            });
        }
        Ok(false)
    }
}

/// Compares an image with the part of a screenshot whose upper left corner is `corner`; says how many pixels.
fn compare(
    shot: &ColorImage,
    corner: [f32; 2],
    id: &StimulusId,
    image: &ScreenImage,
) -> Result<u64, ExperimentError> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a corner on whole pixels of the screen"
    )]
    let [left, top] = corner.map(|pixels| pixels as usize);
    let [width, _] = image.size_px.map(|pixels| pixels as usize);
    let mut compared = 0;
    for (index, expected) in image.rgb.chunks_exact(3).enumerate() {
        let (x, y) = (left + index % width, top + index / width);
        let found = shot.pixels.get(y * shot.size[0] + x);
        let found = found
            .filter(|_| x < shot.size[0])
            .map(|color| [color.r(), color.g(), color.b()]);
        if found.is_none_or(|found| found != expected) {
            return Err(ExperimentError::Pixel {
                stimulus: id.to_string(),
                place_px: [index % width, index / width],
                found: found.map(|found| found.to_vec()),
                expected: expected.to_vec(),
            });
        }
        compared += 1;
    }
    Ok(compared)
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::Color32;

    #[test]
    fn one_pixel_that_differs_by_one_is_found_and_named() {
        let id: StimulusId = "a010k_c140k".to_owned().try_into().unwrap();
        let image = ScreenImage {
            size_px: [3, 2],
            rgb: (10..28).collect(),
        };
        let mut shot = ColorImage::filled([8, 5], Color32::from_gray(128));
        for (index, rgb) in image.rgb.chunks_exact(3).enumerate() {
            let place = (1 + index / 3) * 8 + 4 + index % 3;
            shot.pixels[place] = Color32::from_rgb(rgb[0], rgb[1], rgb[2]);
        }
        assert_eq!(compare(&shot, [4.0, 1.0], &id, &image).unwrap(), 6);
        assert!(compare(&shot, [5.0, 1.0], &id, &image).is_err());
        assert!(
            compare(&shot, [7.0, 4.0], &id, &image).is_err(),
            "beyond the window"
        );
        shot.pixels[2 * 8 + 5] = Color32::from_rgb(22, 23, 25);
        let error = compare(&shot, [4.0, 1.0], &id, &image)
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("a010k_c140k") && error.contains("pixel 1, 1"),
            "{error}"
        );
        assert!(
            error.contains("[22, 23, 25]") && error.contains("[22, 23, 24]"),
            "{error}"
        );
    }
}
