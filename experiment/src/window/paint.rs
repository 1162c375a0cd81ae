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
use protocols::rating::Phase;
use protocols::{Layout, RatingTime, ResponseStyle, SessionPlan, Stimuli, StimulusId};

use super::geometry::{Geometry, Slot};
use super::set_text::SetText;
use crate::bidirectional::begins_right;
use crate::{Button, Picture, Response, Screen, Session, StimulusSet};

const INK: Color32 = Color32::from_gray(12);

/// Every image of the study on the graphics card, from the start, so that no exposure waits for one.
pub(crate) struct Pictures {
    textures: BTreeMap<StimulusId, TextureHandle>,
    set: StimulusSet,
    zero_anchor: Option<StimulusId>,
    /// What each image is shown with as the best quality.
    references: BTreeMap<StimulusId, StimulusId>,
    pub(crate) image_px: [u32; 2],
}

impl Pictures {
    pub(crate) fn upload(context: &Context, set: StimulusSet, stimuli: &Stimuli) -> Self {
        let upload = |(id, image): (&StimulusId, &crate::ScreenImage)| {
            let size = image.size_px.map(|pixels| pixels as usize);
            let image = ColorImage::from_rgb(size, &image.rgb);
            let texture = context.load_texture(id.as_str(), image, TextureOptions::NEAREST);
            (id.clone(), texture)
        };
        Self {
            textures: set.images().iter().map(upload).collect(),
            zero_anchor: stimuli.zero_anchor(),
            references: (set.images().keys())
                .filter_map(|id| Some((id.clone(), stimuli.reference_of(id)?)))
                .collect(),
            image_px: set.size_px(),
            set,
        }
    }

    /// Which image stands in a slot, if the study has one.
    pub(crate) fn id<'a>(
        &'a self,
        slot: Slot,
        test_image: &'a StimulusId,
    ) -> Option<&'a StimulusId> {
        match slot {
            Slot::ZeroAnchor => self.zero_anchor.as_ref(),
            Slot::Test => Some(test_image),
            Slot::TenAnchor => self.references.get(test_image),
        }
    }

    /// The bytes of an image.
    pub(crate) fn image(
        &self,
        id: &StimulusId,
    ) -> Result<&crate::ScreenImage, protocols::InputError> {
        self.set.image(id)
    }
}

/// What the screens are painted with.
pub(crate) struct Brush<'a> {
    pub(crate) painter: &'a Painter,
    pub(crate) geometry: Geometry,
    pub(crate) plan: &'a SessionPlan,
    /// The neutral grey of the screen.
    pub(crate) ground: Color32,
    /// Where the mouse is, in points.
    pub(crate) pointer: Option<Pos2>,
}

impl Brush<'_> {
    pub(crate) fn background(&self) {
        self.fill(self.geometry.screen_px(), self.ground);
    }

    pub(crate) fn screen(&self, session: &Session, pictures: &Pictures) {
        let texts = &self.plan.texts;
        let screen = session.screen();
        match screen {
            Screen::Instructions => self.page(&texts.instructions, 0.43),
            Screen::Resumed => self.page(&texts.resumed, 0.43),
            Screen::TooSlow => self.page(&texts.too_slow, 0.43),
            Screen::Paused => self.page(&texts.paused, 0.43),
            Screen::PracticeOver => self.page(&texts.practice_over, 0.43),
            Screen::Thanks => self.page(&texts.thanks, 0.5),
            Screen::ConfirmStop => self.line(&texts.stop_question, 40.0, 0.42),
            Screen::Exposure(trial, picture) | Screen::RatedExposure(trial, picture) => {
                let test_image = &session.trials()[trial].stimulus_id;
                for rect in self.picture(picture, test_image, pictures) {
                    self.pair_name(session.part(), rect);
                }
            }
            Screen::Page(page) => self.instruction_page(page, pictures),
            Screen::Break { left_s, .. } => self.rest(left_s),
            Screen::Rating | Screen::Blank => {}
        }
        if self.plan.progress && matches!(screen, Screen::Rating | Screen::Break { .. }) {
            self.progress(session);
        }
        if screen.has_scale() {
            self.scale(screen, session.response());
        }
        for (button, rect) in self.geometry.buttons(screen, self.plan) {
            self.button(button, rect, session.pressed());
        }
    }

    /// A page with pictures below its words, which stand above the middle of what is left.
    fn instruction_page(&self, index: usize, pictures: &Pictures) {
        let Some(page) = self.plan.pages.get(index) else {
            return;
        };
        if page.pictures.is_empty() {
            return self.page(&page.text, 0.43);
        }
        let [width, height] = pictures.image_px.map(|pixels| pixels as f32);
        let gap_px = self.plan.gap_px as f32;
        let count = page.pictures.len();
        let places = self
            .geometry
            .page_pictures(count, vec2(width, height), gap_px);
        let top = places.first().map_or(0.0, Rect::top);
        self.page(
            &page.text,
            f32::midpoint(0.05, top / self.geometry.size_px.y),
        );
        for (index, (id, place)) in page.pictures.iter().zip(places).enumerate() {
            self.texture(pictures.textures.get(id), place);
            if let Some(caption) = page.captions.get(index) {
                let below = place.center_bottom() + vec2(0.0, 30.0 * self.geometry.unit());
                self.centred(self.galley(caption, 26.0, width, Align::Center), below);
            }
        }
    }

    /// A break: its words, and the minutes and seconds that are left.
    fn rest(&self, left_s: u32) {
        if let Some(plan) = &self.plan.breaks {
            self.page(&plan.text, 0.36);
        }
        let left = format!("{}:{:02}", left_s / 60, left_s % 60);
        self.line(&left, 72.0, 0.55);
    }

    /// How many of the test trials are rated.
    fn progress(&self, session: &Session) {
        let is_test = |trial: &&crate::Trial| trial.phase == Phase::Test;
        let count =
            |trials: &[crate::Trial]| u16::try_from(trials.iter().filter(is_test).count()).ok();
        let whole = count(session.trials()).unwrap_or(u16::MAX);
        let done = count(&session.trials()[..session.rated()]).unwrap_or(whole);
        let bar = self.geometry.progress();
        self.fill(bar, Color32::from_gray(165));
        let part = f32::from(done) / f32::from(whole.max(1));
        let length = vec2(bar.width() * part, bar.height());
        self.fill(Rect::from_min_size(bar.min, length), INK);
        let words = format!("{done} / {whole}");
        let below = bar.center_bottom() + vec2(0.0, 24.0 * self.geometry.unit());
        self.centred(
            self.galley(&words, 24.0, f32::INFINITY, Align::Center),
            below,
        );
    }

    /// The corner for a photodiode: white while the test image stands.
    pub(crate) fn photodiode(&self, screen: Screen) {
        if self.plan.photodiode {
            let has_test_image = screen
                .picture()
                .is_some_and(|(_, shown)| shown.has_test_image());
            let grey = if has_test_image { 255 } else { 0 };
            self.fill(self.geometry.photodiode(), Color32::from_gray(grey));
        }
    }

    /// The images of a picture; says where they stand.
    pub(crate) fn picture(
        &self,
        picture: Picture,
        test_image: &StimulusId,
        pictures: &Pictures,
    ) -> Vec<Rect> {
        let [width, height] = pictures.image_px.map(|pixels| pixels as f32);
        let gap_px = self.plan.gap_px as f32;
        let images = self.geometry.images(picture, vec2(width, height), gap_px);
        for (slot, rect) in &images {
            self.image(*slot, *rect, test_image, pictures);
        }
        images.into_iter().map(|(_, rect)| rect).collect()
    }

    /// The name of a member of a pair, above it.
    fn pair_name(&self, part: usize, image_px: Rect) {
        if self.plan.layout == Layout::Dscqs {
            let above = image_px.center_top() - vec2(0.0, 40.0 * self.geometry.unit());
            let name = &self.plan.texts.pair[part % 2];
            self.centred(self.galley(name, 40.0, f32::INFINITY, Align::Center), above);
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
        let id = pictures.id(slot, test_image);
        self.texture(id.and_then(|id| pictures.textures.get(id)), rect_px);
    }

    /// A whole texture, pixel for pixel.
    fn texture(&self, texture: Option<&TextureHandle>, rect_px: Rect) {
        if let Some(texture) = texture {
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
        let wrap = wrap_px / self.geometry.pixels_per_point;
        let set = SetText::of(self.painter.ctx(), words, &font, wrap);
        let mut job = LayoutJob::default();
        job.wrap.max_width = set.wrap;
        job.halign = halign;
        let format = TextFormat {
            line_height: Some(size * 1.4 * points_per_unit),
            ..TextFormat::simple(font, INK)
        };
        job.append(&set.words, 0.0, format);
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

    /// Paragraphs, aligned where they begin, in a block in the middle of the screen.
    fn page(&self, words: &str, y: f32) {
        let width = (0.62 * self.geometry.size_px.x).min(1150.0 * self.geometry.unit());
        let words = words.trim();
        let halign = if begins_right(words) {
            Align::RIGHT
        } else {
            Align::LEFT
        };
        let galley = self.galley(words, 34.0, width, halign);
        self.centred(galley, self.place(0.5, y));
    }

    fn line(&self, words: &str, size: f32, y: f32) {
        let width = 0.9 * self.geometry.size_px.x;
        let galley = self.galley(words, size, width, Align::Center);
        self.centred(galley, self.place(0.5, y));
    }

    fn scale(&self, screen: Screen, response: &Response) {
        let texts = &self.plan.texts;
        let [question_y, row_y] = Geometry::scale_heights(self.plan);
        let width = 0.64 * self.geometry.size_px.x;
        let question = self.galley(&texts.question, 40.0, width, Align::Center);
        self.centred(question, self.place(0.5, question_y));
        let mut field_place = self.place(0.5, row_y + 0.18);
        if self.plan.response == ResponseStyle::Continuous {
            self.bars(response);
            field_place = self.place(0.83, 0.5);
        } else if self.plan.response == ResponseStyle::Buttons {
            self.ends(screen);
        }
        if self.plan.rating == RatingTime::DuringExposure {
            field_place = self.place(0.9, question_y - 0.08);
        }
        if !response.typed().is_empty() {
            self.typed(response.typed(), field_place);
        }
    }

    /// The words below both ends of a row of numbers.
    fn ends(&self, screen: Screen) {
        let texts = &self.plan.texts;
        let buttons = self.geometry.buttons(screen, self.plan);
        if let [(_, first), .., (_, last)] = buttons.as_slice() {
            let width = (last.right() - first.left()) * 0.4;
            let below = Vec2::new(0.0, 16.0 * self.geometry.unit());
            let words = self.galley(&texts.lowest, 26.0, width, Align::LEFT);
            self.at(words, first.left_bottom() + below);
            let words = self.galley(&texts.highest, 26.0, width, Align::RIGHT);
            self.at(words, last.right_bottom() + below);
        }
    }

    /// The number that is being typed.
    fn typed(&self, typed: &str, centre: Pos2) {
        let size_px = vec2(150.0, 84.0) * self.geometry.unit();
        let field = Rect::from_center_size(centre, size_px);
        self.framed(field, Color32::from_gray(235));
        let number = self.galley(typed, 46.0, f32::INFINITY, Align::Center);
        self.centred(number, field.center());
        let hint = centre + vec2(0.0, 72.0 * self.geometry.unit());
        self.centred(
            self.galley(
                &self.plan.texts.enter_key,
                24.0,
                f32::INFINITY,
                Align::Center,
            ),
            hint,
        );
    }

    /// The bars of a continuous scale with their marks, and the words to their left.
    fn bars(&self, response: &Response) {
        let bars = self.geometry.bars(self.plan);
        let unit = self.geometry.unit();
        for (index, (&bar, mark)) in bars.iter().zip(response.marks()).enumerate() {
            self.framed(bar, Color32::from_gray(180));
            if self.plan.layout == Layout::Dscqs {
                let name = self.galley(
                    &self.plan.texts.pair[index],
                    40.0,
                    f32::INFINITY,
                    Align::Center,
                );
                self.centred(name, bar.center_top() - vec2(0.0, 36.0 * unit));
            }
            if let Some(mark) = mark {
                let y = Geometry::mark_y(bar, self.plan, mark);
                let size = vec2(bar.width() + 28.0 * unit, 10.0 * unit);
                self.fill(Rect::from_center_size(pos2(bar.center().x, y), size), INK);
                let number = self.galley(&mark.to_string(), 30.0, f32::INFINITY, Align::LEFT);
                self.centred(number, pos2(bar.right() + 48.0 * unit, y));
            }
            if bars.len() > 1 && index == response.bar() && !response.typed().is_empty() {
                self.fill(
                    Rect::from_center_size(
                        bar.center_bottom() + vec2(0.0, 18.0 * unit),
                        vec2(bar.width(), 6.0 * unit),
                    ),
                    INK,
                );
            }
        }
        if let Some(bar) = bars.first() {
            self.grades(*bar);
        }
    }

    /// The words of the scale beside a bar: each in the middle of its stretch, or one at each end.
    fn grades(&self, bar: Rect) {
        let texts = &self.plan.texts;
        let count = texts.labels.len() as f32;
        let stretch = |(index, words): (usize, &String)| {
            let part = (index as f32 + 0.5) / count;
            (words.clone(), bar.bottom() - part * bar.height())
        };
        let mut grades: Vec<(String, f32)> = texts.labels.iter().enumerate().map(stretch).collect();
        if grades.is_empty() {
            grades = vec![
                (texts.lowest.clone(), bar.bottom()),
                (texts.highest.clone(), bar.top()),
            ];
        }
        let unit = self.geometry.unit();
        let room = bar.left() - 40.0 * unit;
        for (words, y) in grades {
            let galley = self.galley(&words, 28.0, room * 0.9, Align::RIGHT);
            let half = galley.rect.height() * self.geometry.pixels_per_point / 2.0;
            self.at(galley, pos2(room, y - half));
        }
        for line in 1..texts.labels.len() {
            let y = bar.bottom() - line as f32 / count * bar.height();
            let tick = Rect::from_center_size(pos2(bar.left(), y), vec2(24.0, 3.0) * unit);
            self.fill(tick, INK);
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
            Button::Rating(rating) if self.plan.response == ResponseStyle::Labelled => {
                (self.label(rating), 25.0)
            }
            Button::Rating(rating) => (rating.to_string(), 40.0),
            Button::Bar(..) => return,
        };
        let room = 0.9 * rect_px.width();
        self.centred(
            self.galley(&words, size, room, Align::Center),
            rect_px.center(),
        );
    }

    /// The word for a rating of a labelled scale.
    fn label(&self, rating: i32) -> String {
        let labels = self.plan.scale.ratings().zip(&self.plan.texts.labels);
        let mut own = labels.filter(|(labelled, _)| *labelled == rating);
        own.next()
            .map(|(_, words)| words.clone())
            .unwrap_or_default()
    }
}
