//! The screens of a session, painted.
//!
//! Images are opaque, untinted, unfiltered and on whole pixels, so the screen holds the very bytes of the
//! PNG. Everything else is the protocol's neutral grey with dark words.

use std::collections::BTreeMap;
use std::sync::Arc;

use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{
    Align, Color32, ColorImage, Context, CornerRadius, FontId, Galley, Painter, Pos2, Rect, Stroke,
    StrokeKind, TextureHandle, TextureOptions, Vec2, pos2, vec2,
};
use protocols::{SessionPlan, StimulusId, StimulusPlan};

use super::geometry::{Geometry, Slot};
use crate::{Button, Screen, Session, StimulusSet};

const INK: Color32 = Color32::from_gray(12);

/// Every image of the study on the graphics card, from the start, so that no exposure waits for one.
pub(crate) struct Pictures {
    textures: BTreeMap<StimulusId, TextureHandle>,
    zero_anchor: StimulusId,
    ten_anchor: StimulusId,
    pub(crate) image_px: [u32; 2],
}

impl Pictures {
    pub(crate) fn upload(context: &Context, set: &StimulusSet, plan: &StimulusPlan) -> Self {
        let upload = |(id, image): (&StimulusId, &crate::ScreenImage)| {
            let size = image.size_px.map(|pixels| pixels as usize);
            let image = ColorImage::from_rgb(size, &image.rgb);
            let texture = context.load_texture(id.as_str(), image, TextureOptions::NEAREST);
            (id.clone(), texture)
        };
        Self {
            textures: set.images().iter().map(upload).collect(),
            zero_anchor: plan.zero_anchor(),
            ten_anchor: plan.ten_anchor(),
            image_px: plan.size_px,
        }
    }
}

/// What the screens are painted with.
pub(crate) struct Brush<'a> {
    pub(crate) painter: &'a Painter,
    pub(crate) geometry: Geometry,
    pub(crate) plan: &'a SessionPlan,
    /// Where the mouse is, in points.
    pub(crate) pointer: Option<Pos2>,
}

impl Brush<'_> {
    pub(crate) fn background(&self) {
        let grey = Color32::from_gray(self.plan.background_srgb);
        self.fill(self.geometry.screen_px(), grey);
    }

    pub(crate) fn screen(&self, session: &Session, pictures: &Pictures) {
        let texts = &self.plan.texts;
        let screen = session.screen();
        match screen {
            Screen::Instructions => self.page(&texts.instructions, 0.43),
            Screen::PracticeOver => self.page(&texts.practice_over, 0.43),
            Screen::Thanks => self.page(&texts.thanks, 0.5),
            Screen::ConfirmStop => self.line(&texts.stop_question, 40.0, 0.42),
            Screen::Rating => self.scale(session.typed()),
            Screen::Exposure(trial, picture) => {
                let [width, height] = pictures.image_px.map(|pixels| pixels as f32);
                let gap_px = self.plan.gap_px as f32;
                let images = self.geometry.images(picture, vec2(width, height), gap_px);
                let test_image = &session.trials()[trial].stimulus_id;
                for (slot, rect) in images {
                    self.image(slot, rect, test_image, pictures);
                }
            }
            Screen::Blank => {}
        }
        for (button, rect) in self.geometry.buttons(screen, self.plan.scale) {
            self.button(button, rect, session.pressed());
        }
    }

    pub(crate) fn pilot(&self, speed: f64) {
        let words =
            format!("PILOT     times {speed}\u{d7} shorter     not a real session     PILOT");
        for band in self.geometry.pilot_bands() {
            self.fill(band, Color32::from_rgb(240, 190, 60));
            let galley = self.galley(&words, 28.0, f32::INFINITY, Align::Center);
            self.centred(galley, band.center());
        }
    }

    fn fill(&self, rect_px: Rect, color: Color32) {
        let rect = self.geometry.points(rect_px);
        self.painter.rect_filled(rect, CornerRadius::ZERO, color);
    }

    fn image(&self, slot: Slot, rect_px: Rect, test_image: &StimulusId, pictures: &Pictures) {
        let id = match slot {
            Slot::ZeroAnchor => &pictures.zero_anchor,
            Slot::Test => test_image,
            Slot::TenAnchor => &pictures.ten_anchor,
        };
        if let Some(texture) = pictures.textures.get(id) {
            let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
            let rect = self.geometry.points(rect_px);
            self.painter
                .image(texture.id(), rect, whole, Color32::WHITE);
        }
    }

    /// Words laid out; sizes in units of the design.
    fn galley(&self, words: &str, size: f32, wrap_px: f32, halign: Align) -> Arc<Galley> {
        let points_per_unit = self.geometry.unit() / self.geometry.pixels_per_point;
        let font = FontId::proportional(size * points_per_unit);
        let mut job = LayoutJob::default();
        job.wrap.max_width = wrap_px / self.geometry.pixels_per_point;
        job.halign = halign;
        let format = TextFormat {
            line_height: Some(size * 1.4 * points_per_unit),
            ..TextFormat::simple(font, INK)
        };
        job.append(words, 0.0, format);
        self.painter.layout_job(job)
    }

    /// Puts a galley so that its middle lies at a place in pixels.
    fn centred(&self, galley: Arc<Galley>, centre_px: Pos2) {
        let centre = (centre_px.to_vec2() / self.geometry.pixels_per_point).to_pos2();
        let corner = centre - galley.rect.center().to_vec2();
        self.painter.galley(corner, galley, INK);
    }

    fn place(&self, x: f32, y: f32) -> Pos2 {
        (self.geometry.size_px * vec2(x, y)).to_pos2()
    }

    /// Paragraphs, left-aligned in a block in the middle of the screen.
    fn page(&self, words: &str, y: f32) {
        let width = (0.62 * self.geometry.size_px.x).min(1150.0 * self.geometry.unit());
        let galley = self.galley(words.trim(), 34.0, width, Align::LEFT);
        self.centred(galley, self.place(0.5, y));
    }

    fn line(&self, words: &str, size: f32, y: f32) {
        let width = 0.9 * self.geometry.size_px.x;
        let galley = self.galley(words, size, width, Align::Center);
        self.centred(galley, self.place(0.5, y));
    }

    fn scale(&self, typed: &str) {
        let texts = &self.plan.texts;
        self.line(&texts.question, 40.0, 0.38);
        let buttons = self.geometry.buttons(Screen::Rating, self.plan.scale);
        if let [(_, first), .., (_, last)] = buttons.as_slice() {
            let width = (last.right() - first.left()) * 0.4;
            let below = Vec2::new(0.0, 16.0 * self.geometry.unit());
            let words = self.galley(&texts.lowest, 26.0, width, Align::LEFT);
            self.at(words, first.left_bottom() + below);
            let words = self.galley(&texts.highest, 26.0, width, Align::RIGHT);
            self.at(words, last.right_bottom() + below);
        }
        if !typed.is_empty() {
            let size_px = vec2(150.0, 84.0) * self.geometry.unit();
            let field = Rect::from_center_size(self.place(0.5, 0.68), size_px);
            self.framed(field, Color32::from_gray(235));
            self.centred(
                self.galley(typed, 46.0, f32::INFINITY, Align::Center),
                field.center(),
            );
            let hint = self.place(0.5, 0.68) + vec2(0.0, 72.0 * self.geometry.unit());
            self.centred(
                self.galley("Enter", 24.0, f32::INFINITY, Align::Center),
                hint,
            );
        }
    }

    fn at(&self, galley: Arc<Galley>, corner_px: Pos2) {
        let corner = (corner_px.to_vec2() / self.geometry.pixels_per_point).to_pos2();
        self.painter.galley(corner, galley, INK);
    }

    fn framed(&self, rect_px: Rect, color: Color32) {
        let rect = self.geometry.points(rect_px);
        let points_per_unit = self.geometry.unit() / self.geometry.pixels_per_point;
        let stroke = Stroke::new(2.0 * points_per_unit, INK);
        self.painter.rect(
            rect,
            CornerRadius::same(6),
            color,
            stroke,
            StrokeKind::Inside,
        );
    }

    fn button(&self, button: Button, rect_px: Rect, pressed: Option<Button>) {
        let rect = self.geometry.points(rect_px);
        let is_hovered = self.pointer.is_some_and(|pointer| rect.contains(pointer));
        let grey = match (pressed == Some(button), is_hovered) {
            (true, _) => 245,
            (false, true) => 215,
            (false, false) => 180,
        };
        self.framed(rect_px, Color32::from_gray(grey));
        let texts = &self.plan.texts;
        let (words, size) = match button {
            Button::Continue => (texts.continue_button.clone(), 32.0),
            Button::Stop => (texts.stop_button.clone(), 32.0),
            Button::Rating(rating) => (rating.to_string(), 40.0),
        };
        self.centred(
            self.galley(&words, size, f32::INFINITY, Align::Center),
            rect_px.center(),
        );
    }
}
