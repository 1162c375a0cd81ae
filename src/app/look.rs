//! How the app looks: one accent colour, three sizes of text, and the few widgets that every page uses.
//!
//! Every colour of a text has a contrast of at least 4.5 to its ground, and no state is told by colour alone.

use eframe::egui::{
    self, Align, Button, Color32, Context, CornerRadius, FontFamily, FontId, Frame, Layout, Margin,
    Pos2, Rect, Response, RichText, Role, Sense, Stroke, StrokeKind, Style, TextStyle, Theme, Ui,
    Vec2, WidgetInfo, pos2, vec2,
};

use super::fault::Fault;
use super::study_state::Mark;

/// The width of the column that holds everything.
pub(crate) const COLUMN: f32 = 1120.0;
/// The height of a button and of a field.
const HEIGHT: f32 = 36.0;

/// The colours of a theme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Palette {
    pub(crate) ground: Color32,
    pub(crate) card: Color32,
    pub(crate) line: Color32,
    pub(crate) text: Color32,
    pub(crate) weak: Color32,
    pub(crate) accent: Color32,
    pub(crate) on_accent: Color32,
    pub(crate) accent_wash: Color32,
    pub(crate) done: Color32,
    pub(crate) due: Color32,
    pub(crate) wrong: Color32,
}

const LIGHT: Palette = Palette {
    ground: Color32::from_rgb(244, 245, 247),
    card: Color32::from_rgb(255, 255, 255),
    line: Color32::from_rgb(220, 224, 230),
    text: Color32::from_rgb(28, 33, 41),
    weak: Color32::from_rgb(86, 95, 109),
    accent: Color32::from_rgb(33, 94, 153),
    on_accent: Color32::from_rgb(255, 255, 255),
    accent_wash: Color32::from_rgb(229, 238, 247),
    done: Color32::from_rgb(32, 117, 74),
    due: Color32::from_rgb(143, 87, 0),
    wrong: Color32::from_rgb(172, 43, 36),
};

const DARK: Palette = Palette {
    ground: Color32::from_rgb(23, 26, 31),
    card: Color32::from_rgb(32, 36, 42),
    line: Color32::from_rgb(55, 61, 70),
    text: Color32::from_rgb(228, 231, 236),
    weak: Color32::from_rgb(161, 169, 181),
    accent: Color32::from_rgb(118, 176, 232),
    on_accent: Color32::from_rgb(15, 24, 34),
    accent_wash: Color32::from_rgb(38, 52, 67),
    done: Color32::from_rgb(112, 199, 148),
    due: Color32::from_rgb(230, 181, 84),
    wrong: Color32::from_rgb(243, 139, 129),
};

impl Palette {
    /// The colours of the theme that `ui` has now.
    pub(crate) fn of(ui: &Ui) -> Self {
        if ui.visuals().dark_mode { DARK } else { LIGHT }
    }

    pub(crate) const fn of_theme(theme: Theme) -> Self {
        match theme {
            Theme::Light => LIGHT,
            Theme::Dark => DARK,
        }
    }

    pub(crate) const fn of_mark(self, mark: Mark) -> Color32 {
        match mark {
            Mark::Done => self.done,
            Mark::Due => self.due,
            Mark::Wrong => self.wrong,
            Mark::Later => self.weak,
        }
    }
}

/// Gives the window its style, light and dark.
pub(crate) fn dress(context: &Context) {
    for theme in [Theme::Light, Theme::Dark] {
        context.set_style_of(theme, style(theme));
    }
}

fn style(theme: Theme) -> Style {
    let palette = Palette::of_theme(theme);
    let mut style = theme.default_style();
    let size = |points| FontId::new(points, FontFamily::Proportional);
    style.text_styles = [
        (TextStyle::Heading, size(24.0)),
        (TextStyle::Body, size(15.5)),
        (TextStyle::Button, size(15.5)),
        (TextStyle::Small, size(13.5)),
        (
            TextStyle::Monospace,
            FontId::new(14.0, FontFamily::Monospace),
        ),
    ]
    .into();
    let spacing = &mut style.spacing;
    spacing.item_spacing = vec2(10.0, 10.0);
    spacing.button_padding = vec2(16.0, 8.0);
    spacing.interact_size = vec2(HEIGHT, HEIGHT);
    spacing.scroll = egui::style::ScrollStyle {
        // What is below must not move when the bar comes.
        floating_allocated_width: 0.0,
        ..egui::style::ScrollStyle::thin()
    };
    style.interaction.selectable_labels = true;
    color(&mut style.visuals, palette);
    style
}

/// Gives everything its colours.
fn color(visuals: &mut egui::Visuals, palette: Palette) {
    visuals.panel_fill = palette.ground;
    visuals.window_fill = palette.card;
    visuals.extreme_bg_color = palette.card;
    visuals.faint_bg_color = palette.ground;
    visuals.weak_text_color = Some(palette.weak);
    visuals.warn_fg_color = palette.due;
    visuals.error_fg_color = palette.wrong;
    visuals.hyperlink_color = palette.accent;
    visuals.selection.bg_fill = palette.accent_wash;
    visuals.selection.stroke = Stroke::new(2.0, palette.accent);
    visuals.disabled_alpha = 0.55;
    let widgets = &mut visuals.widgets;
    for (widget, fill, edge, text) in [
        (
            &mut widgets.noninteractive,
            palette.card,
            palette.line,
            palette.text,
        ),
        (
            &mut widgets.inactive,
            palette.card,
            palette.line,
            palette.text,
        ),
        (
            &mut widgets.hovered,
            palette.accent_wash,
            palette.accent,
            palette.text,
        ),
        (
            &mut widgets.active,
            palette.accent_wash,
            palette.accent,
            palette.text,
        ),
        (&mut widgets.open, palette.card, palette.line, palette.text),
    ] {
        widget.bg_fill = fill;
        widget.weak_bg_fill = fill;
        widget.bg_stroke = Stroke::new(1.0, edge);
        widget.fg_stroke = Stroke::new(1.0, text);
        widget.corner_radius = CornerRadius::same(7);
        widget.expansion = 0.0;
    }
}

/// A raised area with room around what it holds.
pub(crate) fn card<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    let palette = Palette::of(ui);
    let frame = Frame::new()
        .fill(palette.card)
        .stroke(Stroke::new(1.0, palette.line))
        .corner_radius(10)
        .inner_margin(Margin::same(20));
    let inner = frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        add(ui)
    });
    inner.inner
}

/// The one action that a page leads to.
pub(crate) fn primary(ui: &mut Ui, is_enabled: Enabled, words: &str) -> Response {
    let palette = Palette::of(ui);
    let text = RichText::new(words).color(palette.on_accent);
    let button = Button::new(text).fill(palette.accent).stroke(Stroke::NONE);
    let button = button.min_size(vec2(0.0, HEIGHT));
    ringed(ui, is_enabled, button)
}

/// Any other action.
pub(crate) fn secondary(ui: &mut Ui, is_enabled: Enabled, words: &str) -> Response {
    let button = Button::new(words).min_size(vec2(0.0, HEIGHT));
    ringed(ui, is_enabled, button)
}

/// Whether a button may be pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Enabled {
    Yes,
    No,
}

impl From<bool> for Enabled {
    fn from(is_enabled: bool) -> Self {
        if is_enabled { Self::Yes } else { Self::No }
    }
}

fn ringed(ui: &mut Ui, is_enabled: Enabled, button: Button<'_>) -> Response {
    let response = ui.add_enabled(is_enabled == Enabled::Yes, button);
    focus_ring(ui, &response);
    response
}

/// Shows where the keyboard is.
pub(crate) fn focus_ring(ui: &Ui, response: &Response) {
    if response.has_focus() {
        let stroke = Stroke::new(2.0, Palette::of(ui).accent);
        let ring = response.rect.expand(3.0);
        ui.painter()
            .rect_stroke(ring, 10, stroke, StrokeKind::Outside);
    }
}

/// The title of a page.
pub(crate) fn heading(ui: &mut Ui, words: &str) {
    let text = RichText::new(words).text_style(TextStyle::Heading);
    ui.label(text);
}

/// The title of a page and a line about it.
pub(crate) fn page_head(ui: &mut Ui, title: &str, words: &str) {
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 4.0;
        heading(ui, title);
        weak(ui, words);
    });
    ui.add_space(4.0);
}

/// The title of a card.
pub(crate) fn title(ui: &mut Ui, words: &str) {
    ui.label(RichText::new(words).size(18.0));
    ui.add_space(2.0);
}

/// Words beside the matter.
pub(crate) fn weak(ui: &mut Ui, words: &str) {
    let color = Palette::of(ui).weak;
    ui.label(RichText::new(words).color(color));
}

/// Label and value, a line each.
pub(crate) fn facts(ui: &mut Ui, rows: &[(&str, String)]) {
    const LABELS: f32 = 150.0;
    let weak = Palette::of(ui).weak;
    for (label, value) in rows {
        ui.horizontal_top(|ui| {
            let size = vec2(LABELS, 20.0);
            let layout = Layout::left_to_right(Align::Min);
            ui.allocate_ui_with_layout(size, layout, |ui| {
                ui.set_width(LABELS);
                ui.label(RichText::new(*label).color(weak));
            });
            ui.add(egui::Label::new(value).wrap());
        });
    }
}

/// What went wrong and what to do.
pub(crate) fn fault(ui: &mut Ui, fault: &Fault) {
    let palette = Palette::of(ui);
    let frame = Frame::new()
        .fill(palette.card)
        .stroke(Stroke::new(1.5, palette.wrong))
        .corner_radius(10)
        .inner_margin(Margin::same(20));
    frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        facts(ui, fault.rows());
    });
}

/// A mark with its shape: a tick, a dot, an exclamation mark, a ring.
pub(crate) fn mark(ui: &Ui, centre: Pos2, mark: Mark) {
    const RADIUS: f32 = 8.0;
    let palette = Palette::of(ui);
    let color = palette.of_mark(mark);
    let painter = ui.painter();
    let sign = Stroke::new(2.0, palette.card);
    match mark {
        Mark::Done => {
            painter.circle_filled(centre, RADIUS, color);
            let corner = centre + vec2(-1.0, 3.0);
            painter.line_segment([centre + vec2(-4.0, 0.0), corner], sign);
            painter.line_segment([corner, centre + vec2(4.0, -3.0)], sign);
        }
        Mark::Wrong => {
            painter.circle_filled(centre, RADIUS, color);
            painter.line_segment([centre - vec2(0.0, 4.5), centre + vec2(0.0, 1.0)], sign);
            painter.circle_filled(centre + vec2(0.0, 4.0), 1.3, palette.card);
        }
        Mark::Due => {
            painter.circle_stroke(centre, RADIUS - 1.0, Stroke::new(2.0, color));
            painter.circle_filled(centre, 3.5, color);
        }
        Mark::Later => {
            painter.circle_stroke(centre, RADIUS - 1.0, Stroke::new(1.5, color));
        }
    }
}

/// A mark in the line of the text, and words beside it.
pub(crate) fn marked(ui: &mut Ui, kind: Mark, words: &str) {
    let (rect, _) = ui.allocate_exact_size(vec2(18.0, 20.0), Sense::hover());
    mark(ui, rect.center(), kind);
    let color = Palette::of(ui).of_mark(kind);
    ui.label(RichText::new(words).color(color));
}

/// The state of a step, as the first line of its card.
pub(crate) fn state(ui: &mut Ui, kind: Mark, words: &str) {
    ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = 20.0;
        ui.horizontal_wrapped(|ui| marked(ui, kind, words));
    });
}

/// A box that is ticked or not.
pub(crate) fn tick(ui: &mut Ui, is_ticked: &mut bool, words: &str) -> Response {
    let weak = Palette::of(ui).weak;
    let response = ui.scope(|ui| {
        // Its edge must be seen beside the card.
        ui.visuals_mut().widgets.inactive.bg_stroke = Stroke::new(1.0, weak);
        ui.visuals_mut().widgets.inactive.corner_radius = CornerRadius::same(4);
        ui.checkbox(is_ticked, words)
    });
    focus_ring(ui, &response.inner);
    response.inner
}

/// How far something has come, with its number in words for a screen reader.
pub(crate) fn bar(ui: &mut Ui, size: Vec2, part: f32, name: &str) {
    let palette = Palette::of(ui);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let radius = CornerRadius::same(3);
    ui.painter().rect_filled(rect, radius, palette.line);
    let width = rect.width() * part.clamp(0.0, 1.0);
    let done = Rect::from_min_size(rect.min, vec2(width, rect.height()));
    ui.painter().rect_filled(done, radius, palette.accent);
    let percent = f64::from(part.clamp(0.0, 1.0)) * 100.0;
    response.widget_info(|| WidgetInfo {
        value: Some(percent.round()),
        ..WidgetInfo::labeled(Role::ProgressIndicator, true, name)
    });
}

/// A field with its label in front; the label names it for a screen reader too.
pub(crate) fn field(ui: &mut Ui, label: &str, text: &mut String, width: f32) -> Response {
    let name = ui.label(label);
    let field = egui::TextEdit::singleline(text)
        .desired_width(width)
        .margin(Margin::symmetric(10, 8));
    ui.add(field).labelled_by(name.id)
}

/// A field with its label in front, in a column of labels of this width.
pub(crate) fn field_in_column(
    ui: &mut Ui,
    label: &str,
    text: &mut String,
    [label_width, width]: [f32; 2],
) -> Response {
    let size = vec2(label_width, HEIGHT);
    let layout = Layout::left_to_right(Align::Center);
    let name = ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_width(label_width);
        ui.label(label)
    });
    let field = egui::TextEdit::singleline(text)
        .desired_width(width)
        .margin(Margin::symmetric(10, 8));
    ui.add(field).labelled_by(name.inner.id)
}

/// A line across.
pub(crate) fn rule(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 1.0), Sense::hover());
    let line = Stroke::new(1.0, Palette::of(ui).line);
    ui.painter().hline(rect.x_range(), rect.center().y, line);
}

/// An arrow to the right, from one step to the next.
pub(crate) fn arrow(ui: &Ui, centre: Pos2) {
    let stroke = Stroke::new(1.5, Palette::of(ui).weak);
    let tip = centre + vec2(3.0, 0.0);
    for y in [-6.0, 6.0] {
        ui.painter()
            .line_segment([pos2(centre.x - 3.0, centre.y + y), tip], stroke);
    }
}
