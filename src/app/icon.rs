//! The window's icon: an aperture of rings, coarse outside and fine inside.

use eframe::egui::IconData;

const SIDE: u32 = 64;

/// The icon.
pub(crate) fn icon() -> IconData {
    let middle = (SIDE as f32 - 1.0) / 2.0;
    let pixel = |x: u32, y: u32| -> [u8; 4] {
        let (dx, dy) = (x as f32 - middle, y as f32 - middle);
        let radius = dx.hypot(dy) / middle;
        match radius {
            0.0..0.22 => [33, 94, 153, 255],
            0.36..0.56 => [118, 176, 232, 255],
            0.72..0.98 => [33, 94, 153, 255],
            _ => [0, 0, 0, 0],
        }
    };
    let pixels = (0..SIDE).flat_map(|y| (0..SIDE).flat_map(move |x| pixel(x, y)));
    IconData {
        rgba: pixels.collect(),
        width: SIDE,
        height: SIDE,
    }
}
