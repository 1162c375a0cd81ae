//! What a subject can push.

/// A button on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// Begin, go on, close.
    Continue,
    /// Stop the session.
    Stop,
    /// One rating of the scale.
    Rating(i32),
}

/// A key of the keyboard; repeats of a key that is held down are no events.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// Enter or Return.
    Enter,
    /// Escape.
    Escape,
    /// Backspace.
    Backspace,
    /// A character, such as a digit or a space.
    Character(char),
}
