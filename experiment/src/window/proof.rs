//! The proof before the first screen: what the screen really holds is compared with the bytes to be shown.
//!
//! Each picture of the first trial is drawn once and read back from the window, and then from the screen of the X
//! server, where that can be asked. One pixel that differs (a scaled, dithered or colour-managed window, a display of
//! 16 bits a pixel, another window in front) stops the session.

use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui::{ColorImage, Context, Rect, vec2};

use super::geometry::{Geometry, Slot};
use super::paint::Pictures;
use super::server_screen::ServerScreen;
use crate::{ExperimentError, Picture, ScreenImage, Session};
use protocols::StimulusId;

/// So many frames may pass until the server holds what was submitted: its desktop may compose it first.
const MOST_FRAMES: u32 = 120;

type Shot = Arc<Mutex<Option<Arc<ColorImage>>>>;

/// Where the comparison of one picture stands.
#[derive(Clone, Copy, Debug)]
enum Step {
    /// The window's own pixels are asked for.
    Window(Picture),
    /// They are equal; the server was found wanting in so many frames.
    Server(Picture, u32),
}

/// How far the comparison has come.
#[derive(Debug)]
pub(crate) struct Proof {
    test_image: Option<StimulusId>,
    waiting: Vec<Picture>,
    step: Option<Step>,
    shot: Shot,
    /// The X server, or why it is not asked.
    server: Result<Box<ServerScreen>, String>,
    compared_px: u64,
}

/// Where a picture stands, and what its images are.
struct Standing<'a> {
    images: Vec<(Slot, Rect)>,
    test_image: &'a StimulusId,
    pictures: &'a Pictures,
}

impl Proof {
    /// A comparison of the pictures of the trial that comes first.
    pub(crate) fn of(session: &Session) -> Self {
        let first = session.first_pictures();
        Self {
            test_image: first.as_ref().map(|(trial, _)| trial.stimulus_id.clone()),
            waiting: first.map(|(_, pictures)| pictures).unwrap_or_default(),
            step: None,
            shot: Shot::default(),
            server: ServerScreen::open().map(Box::new),
            compared_px: 0,
        }
    }

    /// What this frame must show: a picture with the test image of the trial.
    pub(crate) fn picture(&self) -> Option<(Picture, &StimulusId)> {
        let picture = match self.step {
            Some(Step::Window(picture) | Step::Server(picture, _)) => Some(picture),
            None => self.waiting.last().copied(),
        };
        picture.zip(self.test_image.as_ref())
    }

    /// How many pixels were compared.
    pub(crate) fn compared_px(&self) -> u64 {
        self.compared_px
    }

    /// What was compared with what.
    pub(crate) fn in_words(&self) -> String {
        let count = self.compared_px;
        match &self.server {
            Ok(_) => format!("{count} pixels equal in the window and on the X server's screen"),
            Err(reason) => {
                format!("{count} pixels equal in the window; the X server was not asked: {reason}")
            }
        }
    }

    /// Takes a screenshot that has come, or asks for the next; true when all is compared.
    ///
    /// # Errors
    ///
    /// A pixel of the window or of the screen is not that of the image.
    pub(crate) fn advance(
        &mut self,
        context: &Context,
        geometry: Geometry,
        pictures: &Pictures,
        gap_px: u32,
    ) -> Result<bool, ExperimentError> {
        if let (Some(step), Some(test_image)) = (self.step, &self.test_image) {
            let (Step::Window(picture) | Step::Server(picture, _)) = step;
            let size = pictures.image_px.map(|pixels| pixels as f32);
            let standing = Standing {
                images: geometry.images(picture, size.into(), gap_px as f32),
                test_image,
                pictures,
            };
            match step {
                Step::Window(_) => {
                    let mut shot = self.shot.lock().unwrap_or_else(PoisonError::into_inner);
                    if let Some(shot) = shot.take() {
                        self.compared_px += standing.in_window(&shot)?;
                        self.step = self.server.is_ok().then_some(Step::Server(picture, 0));
                    }
                }
                Step::Server(_, frames) => {
                    let compared = match &self.server {
                        Ok(server) => standing.on_screen(server, context, geometry),
                        Err(_) => Ok(()),
                    };
                    self.step = match compared {
                        Ok(()) => None,
                        Err(_) if frames < MOST_FRAMES => Some(Step::Server(picture, frames + 1)),
                        Err(error) => return Err(error),
                    };
                }
            }
        }
        if self.step.is_some() {
            return Ok(false);
        }
        let Some(next) = self.waiting.pop() else {
            return Ok(true);
        };
        self.step = Some(Step::Window(next));
        let shot = Arc::clone(&self.shot);
        let wake = context.clone();
        context.request_screenshot(move |image| {
            *shot.lock().unwrap_or_else(PoisonError::into_inner) = Some(image);
            wake.request_repaint();
        });
        Ok(false)
    }
}

impl Standing<'_> {
    /// Compares the images with a screenshot of the window; says how many pixels.
    fn in_window(&self, shot: &ColorImage) -> Result<u64, ExperimentError> {
        let mut compared = 0;
        for (slot, rect) in &self.images {
            if let Some(id) = self.pictures.id(*slot, self.test_image) {
                let corner = [rect.left(), rect.top()];
                compared += compare(shot, corner, ("window", id), self.pictures.image(id)?)?;
            }
        }
        Ok(compared)
    }

    /// Compares the images with what the server holds.
    fn on_screen(
        &self,
        server: &ServerScreen,
        context: &Context,
        geometry: Geometry,
    ) -> Result<(), ExperimentError> {
        let window = context.input(|input| input.viewport().inner_rect);
        let origin = window.map_or(vec2(0.0, 0.0), |window| {
            (window.min.to_vec2() * geometry.pixels_per_point).round()
        });
        for (slot, rect) in &self.images {
            let Some(id) = self.pictures.id(*slot, self.test_image) else {
                continue;
            };
            let image = self.pictures.image(id)?;
            let place = rect.min + origin;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "whole pixels of a screen, which X counts in 16 bits"
            )]
            let (corner, size) = (
                [place.x as i16, place.y as i16],
                [rect.width() as u16, rect.height() as u16],
            );
            let held = server.part(corner, size).unwrap_or_default();
            compare(&held, [0.0; 2], ("X server's screen", id), image)?;
        }
        Ok(())
    }
}

/// Compares an image with the part of a screenshot whose upper left corner is `corner`; says how many pixels.
fn compare(
    shot: &ColorImage,
    corner: [f32; 2],
    (holder, id): (&'static str, &StimulusId),
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
                holder,
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
        assert_eq!(
            compare(&shot, [4.0, 1.0], ("window", &id), &image).unwrap(),
            6
        );
        assert!(compare(&shot, [5.0, 1.0], ("window", &id), &image).is_err());
        assert!(
            compare(&shot, [7.0, 4.0], ("window", &id), &image).is_err(),
            "beyond the window"
        );
        shot.pixels[2 * 8 + 5] = Color32::from_rgb(22, 23, 25);
        let error = compare(&shot, [4.0, 1.0], ("window", &id), &image)
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
