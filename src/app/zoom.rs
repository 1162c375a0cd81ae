//! The size of everything, by the size of the window: a large window without desktop scaling, as on a 4K screen,
//! shows larger letters, not more emptiness.

use eframe::egui::Context;

/// The size at which the column fills a window well.
const WIDTH: f32 = 1600.0;
const HEIGHT: f32 = 950.0;

/// Follows the window; what the user does with Ctrl and + or - comes on top and stays.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Zoom {
    given: Option<f32>,
}

impl Zoom {
    /// Zooms as the window's size asks for.
    pub(crate) fn follow(&mut self, context: &Context) {
        let now = context.zoom_factor();
        let size = context.content_rect().size() * now;
        let wanted = zoom_for([size.x, size.y]);
        if self.given == Some(wanted) {
            return;
        }
        let of_user = self.given.map_or(1.0, |given| now / given);
        self.given = Some(wanted);
        context.set_zoom_factor(wanted * of_user);
    }
}

/// The zoom for a window of this size, in points of the desktop: from 1 to 2.5 in quarters.
fn zoom_for([width, height]: [f32; 2]) -> f32 {
    let room = (width / WIDTH).min(height / HEIGHT);
    ((room * 4.0).floor() / 4.0).clamp(1.0, 2.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_grow_with_the_window_and_never_shrink() {
        for (size, zoom) in [
            ([800.0, 500.0], 1.0),
            ([1280.0, 800.0], 1.0),
            ([1920.0, 1080.0], 1.0),
            ([3840.0, 2160.0], 2.25),
            ([3840.0, 1000.0], 1.0),
            ([7680.0, 4320.0], 2.5),
        ] {
            assert_eq!(zoom_for(size), zoom, "{size:?}");
        }
    }
}
