//! The pages before the first trial: consent, form, plates and letters, drawn with widgets.
//!
//! Widgets have names for screen readers and can be reached by keyboard alone. Every page is a new set of
//! widgets, so a press on one page and a release on the next push nothing. Plates and letters stand on whole
//! pixels of the screen, untinted and unfiltered.

use eframe::egui::{
    self, Align, Button, Color32, ColorImage, CornerRadius, FontId, Key, Label, Layout, Margin,
    Rect, RichText, ScrollArea, Sense, Stroke, TextEdit, TextureHandle, TextureOptions, Ui,
    UiBuilder, Vec2, pos2, vec2,
};
use protocols::{FieldKind, FormField, ScreeningPlan, SessionPlan};

use super::geometry::Geometry;
use super::set_text::SetText;
use crate::bidirectional::begins_right;
use crate::{Display, Intake, Reply, Side, Step};

const INK: Color32 = Color32::from_gray(12);
const FACE: Color32 = Color32::from_gray(180);
const FIELD: Color32 = Color32::from_gray(222);

/// What the pages remember from one frame to the next.
#[derive(Default)]
pub(crate) struct IntakePage {
    /// The present plate on the graphics card, with its index.
    plate: Option<(usize, TextureHandle)>,
    /// Whether the subject is asked whether to stop.
    is_asking: bool,
}

/// What the pages are drawn with.
#[derive(Clone, Copy)]
pub(crate) struct Looks<'a> {
    pub(crate) plan: &'a SessionPlan,
    pub(crate) geometry: Geometry,
    pub(crate) display: &'a Display,
}

impl IntakePage {
    /// Asks the subject whether to stop.
    pub(crate) fn ask_to_stop(&mut self) {
        self.is_asking = true;
    }

    /// Whether the subject is asked whether to stop.
    pub(crate) fn is_asking(&self) -> bool {
        self.is_asking
    }

    /// Draws the present step; says what the subject did.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        page: &Looks<'_>,
        intake: &mut Intake,
    ) -> Option<Reply> {
        let step = intake.step();
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            self.is_asking = !self.is_asking;
        }
        ui.push_id((step_number(step), self.is_asking), |ui| {
            page.style(ui);
            if self.is_asking {
                return self.ask(page, ui);
            }
            match step {
                Step::Consent => page.consent(ui),
                Step::Form => page.form(ui, intake),
                Step::Plate(index) => self.plate(page, ui, intake, index),
                Step::Letter(index) => page.letter(ui, intake, index),
                Step::Done | Step::Left => None,
            }
        })
        .inner
    }

    /// Whether to stop.
    fn ask(&mut self, page: &Looks<'_>, ui: &mut Ui) -> Option<Reply> {
        let texts = &page.plan.texts;
        page.line(ui, &texts.stop_question, 40.0, 0.42);
        let pushed = page.row(ui, &[&texts.continue_button, &texts.stop_button], 0.56)?;
        self.is_asking = false;
        (pushed == 1).then_some(Reply::Leave)
    }

    fn plate(
        &mut self,
        page: &Looks<'_>,
        ui: &mut Ui,
        intake: &Intake,
        index: usize,
    ) -> Option<Reply> {
        let (plan, plate) = (page.plan.screening.as_ref()?, intake.plates().get(index)?);
        if self.plate.as_ref().is_none_or(|(held, _)| *held != index) {
            let image = plate.image();
            let side = image.size_px as usize;
            let rgb = image.on_grey(page.plan.background_srgb, page.display);
            let image = ColorImage::from_rgb([side, side], &rgb);
            let texture = ui
                .ctx()
                .load_texture("plate", image, TextureOptions::NEAREST);
            self.plate = Some((index, texture));
        }
        let (_, texture) = self.plate.as_ref()?;
        let side = texture.size_vec2();
        let corner = (page.geometry.size_px * vec2(0.5, 0.46) - side / 2.0).round();
        let rect_px = Rect::from_min_size(corner.to_pos2(), side);
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let rect = page.geometry.points(rect_px);
        ui.painter()
            .image(texture.id(), rect, whole, Color32::WHITE);
        page.line(ui, &plan.plate_question, 36.0, 0.1);
        page.digits(ui, plan)
    }
}

/// A number for each page, so that no two have a widget in common.
fn step_number(step: Step) -> usize {
    match step {
        Step::Consent => 0,
        Step::Form => 1,
        Step::Done | Step::Left => 2,
        Step::Plate(index) => 3 + 2 * index,
        Step::Letter(index) => 4 + 2 * index,
    }
}

impl Looks<'_> {
    /// A length of the design in points.
    fn points(&self, units: f32) -> f32 {
        units * self.geometry.unit() / self.geometry.pixels_per_point
    }

    /// A part of the screen, in points.
    fn part(&self, [left, top]: [f32; 2], [right, bottom]: [f32; 2]) -> Rect {
        let size = self.geometry.size_px;
        let pixels = Rect::from_min_max(
            (size * vec2(left, top)).to_pos2(),
            (size * vec2(right, bottom)).to_pos2(),
        );
        self.geometry.points(pixels)
    }

    /// The looks of every subject's screen, whatever the theme of the desktop.
    fn style(&self, ui: &mut Ui) {
        let style = ui.style_mut();
        let visuals = &mut style.visuals;
        *visuals = egui::Visuals::light();
        visuals.override_text_color = Some(INK);
        visuals.extreme_bg_color = FIELD;
        visuals.text_edit_bg_color = Some(FIELD);
        visuals.selection.bg_fill = Color32::from_gray(150);
        let widgets = &mut visuals.widgets;
        let states = [
            (&mut widgets.inactive, FACE),
            (&mut widgets.hovered, Color32::from_gray(215)),
            (&mut widgets.active, Color32::from_gray(245)),
            (&mut widgets.open, Color32::from_gray(215)),
            (&mut widgets.noninteractive, FACE),
        ];
        let ink = Stroke::new(self.points(2.0), INK);
        for (state, face) in states {
            state.bg_fill = face;
            state.weak_bg_fill = face;
            state.bg_stroke = ink;
            state.fg_stroke = ink;
            state.corner_radius = CornerRadius::same(6);
            state.expansion = 0.0;
        }
        // What has the keyboard is active, or in a field of text selected.
        widgets.active.bg_stroke = Stroke::new(self.points(4.0), INK);
        visuals.selection.stroke = Stroke::new(self.points(4.0), INK);
        style.spacing.item_spacing = Vec2::splat(self.points(14.0));
        style.spacing.button_padding = vec2(self.points(18.0), self.points(10.0));
        style.spacing.interact_size.y = self.points(52.0);
        style.spacing.combo_width = self.points(420.0);
        style.spacing.icon_width = self.points(30.0);
        style.spacing.icon_width_inner = self.points(24.0);
        style.spacing.icon_spacing = self.points(10.0);
        let font = FontId::proportional(self.points(28.0));
        for text in style.text_styles.values_mut() {
            *text = font.clone();
        }
    }

    /// Words on one line.
    fn words(&self, ui: &Ui, words: &str, size: f32) -> RichText {
        let font = FontId::proportional(self.points(size));
        let set = SetText::of(ui.ctx(), words, &font, f32::INFINITY);
        RichText::new(set.words).font(font).color(INK)
    }

    /// A paragraph as wide as there is room, aligned where it begins.
    fn paragraph(&self, ui: &mut Ui, words: &str, size: f32) -> egui::Response {
        self.paragraph_as(ui, words, size, |text| text)
    }

    fn paragraph_as(
        &self,
        ui: &mut Ui,
        words: &str,
        size: f32,
        look: impl FnOnce(RichText) -> RichText,
    ) -> egui::Response {
        let font = FontId::proportional(self.points(size));
        let set = SetText::of(ui.ctx(), words, &font, ui.available_width());
        let text = look(RichText::new(set.words).font(font).color(INK));
        let align = side_of(words);
        ui.with_layout(Layout::top_down(align), |ui| {
            let label = Label::new(text);
            ui.add(if set.wrap.is_finite() {
                label
            } else {
                label.extend()
            })
        })
        .inner
    }

    /// A line in the middle of the screen's width.
    fn line(&self, ui: &mut Ui, words: &str, size: f32, y: f32) {
        let rect = self.part([0.05, y - 0.06], [0.95, y + 0.06]);
        let layout = Layout::centered_and_justified(egui::Direction::LeftToRight);
        ui.scope_builder(UiBuilder::new().max_rect(rect).layout(layout), |ui| {
            ui.label(self.words(ui, words, size));
        });
    }

    /// Wide buttons side by side; says which one was pushed.
    fn row(&self, ui: &mut Ui, words: &[&str], y: f32) -> Option<usize> {
        let wide = self.points(340.0);
        let step = wide + self.points(40.0);
        let middle = self.part([0.5, y], [0.5, y]).min;
        let first = middle.x - step * (words.len() as f32 - 1.0) / 2.0;
        let mut pushed = None;
        for (index, words) in words.iter().enumerate() {
            let centre = pos2(first + step * index as f32, middle.y);
            let rect = Rect::from_center_size(centre, vec2(wide, self.points(76.0)));
            let button = Button::new(self.words(ui, words, 30.0)).truncate();
            if ui.put(rect, button).clicked() {
                pushed = Some(index);
            }
        }
        pushed
    }

    /// The block of text in the middle of the screen, as wide as a page of a session.
    fn column(&self, top: f32, bottom: f32) -> Rect {
        let half = (0.31 * self.geometry.size_px.x).min(575.0 * self.geometry.unit());
        let part = half / self.geometry.size_px.x;
        self.part([0.5 - part, top], [0.5 + part, bottom])
    }

    fn consent(&self, ui: &mut Ui) -> Option<Reply> {
        let consent = self.plan.consent.as_ref()?;
        let rect = self.column(0.09, 0.8);
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            ScrollArea::vertical()
                .auto_shrink([false, true])
                .show(ui, |ui| {
                    self.paragraph(ui, consent.text.trim(), 28.0);
                });
        });
        match self.row(ui, &[&consent.agree, &consent.decline], 0.88)? {
            0 => Some(Reply::Agree),
            _ => Some(Reply::Leave),
        }
    }

    fn form(&self, ui: &mut Ui, intake: &mut Intake) -> Option<Reply> {
        let rect = self.column(0.08, 0.8);
        let fields = intake.form().0.to_vec();
        let questions = |ui: &mut Ui| {
            self.paragraph(ui, &self.plan.texts.form, 34.0);
            for (index, field) in fields.iter().enumerate() {
                self.question(ui, field, intake, index);
            }
        };
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            ScrollArea::vertical()
                .auto_shrink([false, true])
                .show(ui, questions);
        });
        let pushed = self.row(ui, &[&self.plan.texts.continue_button], 0.88);
        pushed.map(|_| Reply::HandIn)
    }

    fn question(&self, ui: &mut Ui, field: &FormField, intake: &mut Intake, index: usize) {
        ui.add_space(self.points(14.0));
        let label = self.paragraph(ui, &field.label, 28.0);
        if let Some(answer) = intake.answer_mut(index) {
            self.field(ui, field, answer, label.id);
        }
        if intake.is_at_fault(index) {
            let words = &self.plan.texts.form_fault;
            self.paragraph_as(ui, words, 24.0, |words| words.strong().underline());
        }
    }

    fn field(&self, ui: &mut Ui, field: &FormField, answer: &mut String, label: egui::Id) {
        let width = match field.kind {
            FieldKind::Number => self.points(220.0),
            FieldKind::Choice | FieldKind::Text => self.points(700.0),
        };
        if field.kind == FieldKind::Choice {
            beside(ui, &field.label, |ui| {
                ui.spacing_mut().item_spacing.x = self.points(36.0);
                // What has the keyboard has a thicker ring; a bright face would look chosen.
                ui.visuals_mut().widgets.active.bg_fill = FACE;
                for choice in &field.choices {
                    let words = self.words(ui, choice, 28.0);
                    ui.radio_value(answer, choice.clone(), words);
                }
            });
            return;
        }
        beside(ui, &field.label, |ui| {
            let edit = TextEdit::singleline(answer)
                .desired_width(width)
                .text_color(INK)
                .margin(Margin::same(10))
                .font(FontId::proportional(self.points(28.0)));
            ui.add(edit).labelled_by(label);
            if let Some(unit) = &field.unit {
                ui.label(self.words(ui, unit, 28.0));
            }
        });
    }

    /// The ten digits and the button for none; the digit keys push them too.
    fn digits(&self, ui: &mut Ui, plan: &ScreeningPlan) -> Option<Reply> {
        let mut reply = None;
        let (side, step) = (self.points(76.0), self.points(92.0));
        let middle = self.part([0.5, 0.805], [0.5, 0.805]).min;
        for digit in 0..10_u8 {
            let centre = pos2(middle.x + step * (f32::from(digit) - 4.5), middle.y);
            let rect = Rect::from_center_size(centre, Vec2::splat(side));
            let button = Button::new(self.words(ui, &digit.to_string(), 36.0));
            if ui.put(rect, button).clicked() {
                reply = Some(Reply::Digit(Some(digit)));
            }
        }
        if self.row(ui, &[&plan.no_digit], 0.885).is_some() {
            reply = Some(Reply::Digit(None));
        }
        let typed = ui.input(|input| {
            let mut digits = input.events.iter().filter_map(|event| match event {
                egui::Event::Text(text) => text.parse::<u8>().ok(),
                _ => None,
            });
            digits.next_back()
        });
        let typed = typed.filter(|digit| *digit < 10);
        reply.or_else(|| typed.map(|digit| Reply::Digit(Some(digit))))
    }

    /// An E on whole pixels, with a button on each of its sides; the arrow keys push them too.
    fn letter(&self, ui: &mut Ui, intake: &Intake, index: usize) -> Option<Reply> {
        let (plan, letter) = (self.plan.screening.as_ref()?, intake.letters().get(index)?);
        let stroke = letter.stroke_px as f32;
        let middle = (self.geometry.size_px * vec2(0.5, 0.46)).round();
        let corner = middle - Vec2::splat((2.5 * stroke).floor());
        for bar in letter.bars() {
            let [left, top, width, height] = bar.map(|strokes| strokes as f32 * stroke);
            let bar =
                Rect::from_min_size((corner + vec2(left, top)).to_pos2(), vec2(width, height));
            ui.painter().rect_filled(
                self.geometry.points(bar),
                CornerRadius::ZERO,
                Color32::BLACK,
            );
        }
        self.line(ui, &plan.letter_question, 36.0, 0.1);
        let mut reply = None;
        let away = self.points(300.0);
        let centre = self
            .geometry
            .points(Rect::from_min_size(middle.to_pos2(), Vec2::ZERO))
            .min;
        for (side, key, [x, y]) in [
            (Side::Right, Key::ArrowRight, [1.0, 0.0]),
            (Side::Down, Key::ArrowDown, [0.0, 1.0]),
            (Side::Left, Key::ArrowLeft, [-1.0, 0.0]),
            (Side::Up, Key::ArrowUp, [0.0, -1.0]),
        ] {
            let place = centre + away * vec2(x, y);
            let is_pushed = self.side(ui, side, place);
            if is_pushed || ui.input(|input| input.key_pressed(key)) {
                reply = Some(Reply::Side(Some(side)));
            }
        }
        if self.row(ui, &[&plan.no_direction], 0.885).is_some() {
            reply = Some(Reply::Side(None));
        }
        reply
    }

    /// A button with an arrow to a side.
    fn side(&self, ui: &mut Ui, side: Side, centre: egui::Pos2) -> bool {
        let rect = Rect::from_center_size(centre, Vec2::splat(self.points(84.0)));
        let response = ui.interact(rect, ui.scope_id().with(side.as_str()), Sense::click());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, side.as_str()));
        let look = ui.style().interact(&response);
        let (face, ink) = (look.weak_bg_fill, look.fg_stroke);
        let thicker = if response.has_focus() { 2.0 } else { 1.0 };
        let ink = Stroke::new(thicker * ink.width, ink.color);
        let stroke = egui::StrokeKind::Inside;
        ui.painter()
            .rect(rect, look.corner_radius, face, ink, stroke);
        let half = self.points(17.0);
        let (ahead, across) = match side {
            Side::Right => (vec2(half, 0.0), vec2(0.0, half)),
            Side::Down => (vec2(0.0, half), vec2(half, 0.0)),
            Side::Left => (vec2(-half, 0.0), vec2(0.0, half)),
            Side::Up => (vec2(0.0, -half), vec2(half, 0.0)),
        };
        let corners = vec![
            centre + ahead,
            centre - ahead + across,
            centre - ahead - across,
        ];
        let arrow = egui::Shape::convex_polygon(corners, INK, Stroke::NONE);
        ui.painter().add(arrow);
        response.clicked()
    }
}

/// Things side by side, from the side where these words begin.
fn beside<R>(ui: &mut Ui, words: &str, add: impl FnOnce(&mut Ui) -> R) -> R {
    let room = vec2(ui.available_width(), ui.spacing().interact_size.y);
    let layout = match side_of(words) {
        Align::Max => Layout::right_to_left(Align::Center),
        _ => Layout::left_to_right(Align::Center),
    };
    ui.allocate_ui_with_layout(room, layout.with_main_wrap(true), add)
        .inner
}

/// The side where words begin.
fn side_of(words: &str) -> Align {
    if begins_right(words) {
        Align::Max
    } else {
        Align::Min
    }
}

#[cfg(test)]
mod tests;
