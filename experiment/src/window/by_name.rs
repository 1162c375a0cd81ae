//! For the tests of pages: widgets found by the names that a screen reader reads out.

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

/// A page that is used by the names of its widgets.
pub(super) trait ByName {
    /// Clicks the widget of this name, and lets the page follow.
    fn click_on(&mut self, name: &str);

    /// Whether a widget has these words in its name.
    fn has(&self, words: &str) -> bool;
}

impl ByName for Harness<'_> {
    fn click_on(&mut self, name: &str) {
        self.get_by_label(name).click();
        self.run_steps(3);
    }

    fn has(&self, words: &str) -> bool {
        self.query_all_by_label_contains(words).next().is_some()
    }
}
