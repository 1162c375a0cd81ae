//! Words as they are given to the text engine, whichever way they run.

use std::borrow::Cow;

use eframe::egui::{Color32, Context, FontId};

use crate::bidirectional::{has_leftward, visual_lines};

/// Words in the order in which they are drawn.
pub(super) struct SetText<'a> {
    pub(super) words: Cow<'a, str>,
    /// How wide the engine's lines may be, in points: lines that are broken already, it must not break again.
    pub(super) wrap: f32,
}

impl<'a> SetText<'a> {
    /// These words in lines of up to `wrap` points.
    pub(super) fn of(context: &Context, words: &'a str, font: &FontId, wrap: f32) -> Self {
        if !has_leftward(words) {
            return Self {
                words: words.into(),
                wrap,
            };
        }
        let measure = |piece: &str| {
            let piece = piece.to_owned();
            let black = Color32::BLACK;
            context.fonts_mut(|fonts| fonts.layout_no_wrap(piece, font.clone(), black).size().x)
        };
        Self {
            words: visual_lines(words, wrap, measure).join("\n").into(),
            wrap: f32::INFINITY,
        }
    }
}
