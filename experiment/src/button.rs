//! What a subject can push.

/// A button on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// Begin, go on, close, enter the marks.
    Continue,
    /// Stop the session.
    Stop,
    /// One rating of the scale.
    Rating(i32),
    /// A place on a bar: which bar, and the rating there.
    Bar(usize, i32),
}

impl Button {
    /// Whether a press here and a release there push the same thing; on a bar the place may change.
    pub(crate) fn is_same(self, other: Self) -> bool {
        match (self, other) {
            (Self::Bar(one, _), Self::Bar(another, _)) => one == another,
            _ => self == other,
        }
    }
}

/// A key of the keyboard; repeats of a key that is held down are no events, but those of the arrows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// Enter or Return.
    Enter,
    /// Escape.
    Escape,
    /// Backspace.
    Backspace,
    /// The key that lets the session rest.
    Pause,
    /// To the next bar.
    Tab,
    /// A mark one step up.
    Up,
    /// A mark one step down.
    Down,
    /// A character, such as a digit or a space.
    Character(char),
}
