//! Page 3: the refresh of the display, measured over 300 frames.

use eframe::egui::{self, Ui, vec2};

use super::desk;
use crate::Refresh;
use crate::window::before::MEASURED_FRAMES;

/// Frames while they are timed, and what they were like.
#[derive(Clone, Debug, Default)]
pub(super) struct Timing {
    began: Vec<f64>,
    measured: Option<(Refresh, Vec<f64>)>,
}

impl Timing {
    pub(super) fn in_short(&self) -> String {
        match &self.measured {
            Some((refresh, _)) => format!("{:.2} ms a frame", refresh.median_ms),
            None => "not measured".to_owned(),
        }
    }

    /// Draws the page; gives the refresh once it is measured.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        nominal_hz: Option<f64>,
        now_s: f64,
    ) -> Option<Refresh> {
        desk::heading(
            ui,
            "Does the window keep to the display's refresh?",
            "The time from frame to frame over 300 frames. It is kept with the station; every session measures it again and writes it into its data.",
        );
        if self.measured.is_none() {
            self.time(nominal_hz, now_s);
            ui.ctx().request_repaint();
            let part = self.began.len() as f32 / MEASURED_FRAMES as f32;
            ui.add(
                egui::ProgressBar::new(part)
                    .desired_width(420.0)
                    .text("timing frames"),
            );
            return None;
        }
        let (refresh, intervals_s) = self.measured.as_ref()?;
        let refresh = *refresh;
        facts(ui, &refresh);
        ui.add_space(10.0);
        plot(ui, intervals_s);
        ui.add_space(10.0);
        if ui.button("Measure again").clicked() {
            *self = Self::default();
        }
        Some(refresh)
    }

    /// Takes the beginning of a frame.
    fn time(&mut self, nominal_hz: Option<f64>, now_s: f64) {
        self.began.push(now_s);
        if self.began.len() > MEASURED_FRAMES {
            let intervals: Vec<f64> = self
                .began
                .windows(2)
                .map(|pair| pair[1] - pair[0])
                .collect();
            self.measured = Some((Refresh::of(&intervals, nominal_hz), intervals));
            self.began.clear();
        }
    }
}

fn facts(ui: &mut Ui, refresh: &Refresh) {
    let hertz = |ms: f64| if ms > 0.0 { 1e3 / ms } else { 0.0 };
    desk::facts(ui, "refresh", |ui| {
        let nominal = refresh.nominal_hz.map_or_else(
            || "named by no one (a virtual display?)".to_owned(),
            |hz| format!("{hz:.2} Hz, {:.3} ms", 1e3 / hz),
        );
        desk::fact(ui, "the monitor's own", nominal);
        let (median, mean) = (refresh.median_ms, refresh.mean_ms);
        desk::fact(
            ui,
            "median",
            format!("{median:.3} ms ({:.2} Hz)", hertz(median)),
        );
        desk::fact(ui, "mean", format!("{mean:.3} ms ({:.2} Hz)", hertz(mean)));
        desk::fact(ui, "standard deviation", format!("{:.3} ms", refresh.sd_ms));
    });
    ui.add_space(6.0);
    match refresh.is_locked {
        Some(true) => desk::good(ui, "Locked to the display's refresh."),
        Some(false) => desk::bad(
            ui,
            "NOT locked to the display's refresh: the data of every session will say so. Switch compositing effects off and check the monitor's rate.",
        ),
        None => desk::bad(
            ui,
            "Not known to be locked: the display names no refresh rate.",
        ),
    }
}

/// Every interval as a dot, on a scale from 0 to twice the median.
fn plot(ui: &mut Ui, intervals_s: &[f64]) {
    let size = vec2(ui.available_width().min(900.0), 160.0);
    let (space, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    let tints = desk::Tints::of(ui);
    let painter = ui.painter_at(space);
    painter.rect_filled(space, 6, ui.visuals().extreme_bg_color);
    let mut sorted = intervals_s.to_vec();
    sorted.sort_by(f64::total_cmp);
    let median = sorted
        .get(sorted.len() / 2)
        .copied()
        .unwrap_or(1.0)
        .max(1e-6);
    let line = egui::Stroke::new(1.0, tints.accent.gamma_multiply(0.5));
    painter.hline(space.x_range(), space.center().y, line);
    for (index, interval) in intervals_s.iter().enumerate() {
        let x = (index as f32 + 0.5) / intervals_s.len() as f32;
        let y = 1.0 - desk::length((interval / median / 2.0).clamp(0.0, 1.0));
        let place = space.min + vec2(8.0, 8.0) + vec2(x, y) * (space.size() - vec2(16.0, 16.0));
        painter.circle_filled(place, 2.0, tints.accent);
    }
    desk::remark(
        ui,
        "Each frame's interval; the line is the median, the upper edge twice the median.",
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_hundred_intervals_make_a_measurement() {
        let mut timing = Timing::default();
        for frame in 0..=300 {
            assert!(timing.measured.is_none(), "{frame}");
            timing.time(Some(60.0), f64::from(frame) / 60.0);
        }
        let (refresh, intervals) = timing.measured.unwrap();
        assert_eq!((intervals.len(), refresh.is_locked), (300, Some(true)));
        assert!((refresh.median_ms - 16.667).abs() < 1e-3);
    }
}
