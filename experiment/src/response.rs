//! An answer in the making: what is typed, and the marks on the bars.

use protocols::{ResponseStyle, Scale};

/// Characters of a typed number; a scale has at most four digits and a sign.
const MOST_TYPED: usize = 5;

/// What the subject has typed and marked, before it is an answer. Nothing is preselected.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Response {
    typed: String,
    marks: [Option<i32>; 2],
    /// The bar that typed numbers and arrow keys go to.
    bar: usize,
}

impl Response {
    /// The number that is being typed.
    pub fn typed(&self) -> &str {
        &self.typed
    }

    /// The mark of each bar.
    pub fn marks(&self) -> [Option<i32>; 2] {
        self.marks
    }

    /// The bar that keys go to.
    pub fn bar(&self) -> usize {
        self.bar
    }

    /// Whether so many bars are marked.
    pub(crate) fn is_whole(&self, bars: usize) -> bool {
        self.marks[..bars].iter().all(Option::is_some)
    }

    pub(crate) fn mark(&mut self, bar: usize, value: i32, scale: Scale) {
        if scale.contains(value) && bar < self.marks.len() {
            self.marks[bar] = Some(value);
            self.bar = bar;
        }
    }

    /// Moves the mark of the present bar, if it has one.
    pub(crate) fn nudge(&mut self, steps: i32, scale: Scale) {
        if let Some(mark) = &mut self.marks[self.bar] {
            *mark = (*mark + steps).clamp(scale.lowest, scale.highest);
        }
    }

    pub(crate) fn next_bar(&mut self, bars: usize) {
        self.bar = (self.bar + 1) % bars;
    }

    pub(crate) fn backspace(&mut self) {
        self.typed.pop();
    }

    /// Adds a digit, or the sign of a scale that goes below zero. A number off the scale can be typed but
    /// not entered, so that a digit too many never turns it into another rating.
    pub(crate) fn type_character(&mut self, character: char, scale: Scale) {
        let is_sign = character == '-' && self.typed.is_empty() && scale.lowest < 0;
        if (character.is_ascii_digit() || is_sign) && self.typed.len() < MOST_TYPED {
            self.typed.push(character);
        }
    }

    /// Takes the typed number, if it is on the scale; what was typed goes away either way.
    pub(crate) fn enter(&mut self, scale: Scale) -> Option<i32> {
        let number = std::mem::take(&mut self.typed).parse().ok();
        number.filter(|&number| scale.contains(number))
    }

    /// Marks the present bar with a typed number and goes to the next one that has no mark.
    pub(crate) fn enter_mark(&mut self, scale: Scale, bars: usize) {
        if let Some(number) = self.enter(scale) {
            self.mark(self.bar, number, scale);
            let unmarked = (0..bars).find(|&bar| self.marks[bar].is_none());
            self.bar = unmarked.unwrap_or(self.bar);
        }
    }

    /// Whether the bars stand on the screen for this form of scale.
    pub(crate) fn has_bars(style: ResponseStyle) -> bool {
        style == ResponseStyle::Continuous
    }
}
