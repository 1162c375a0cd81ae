//! Figures 3 and 4: the sensitivities of the cones and of the opponent channels, with the paper's dashes.

use kuva::plot::{LinePlot, LineStyle};
use kuva::prelude::{Layout, LegendPosition, Plot};

use super::rasterizer::FONT_FAMILY;
use crate::spectra::sensitivities;
use crate::spectra::sensitivity::Sensitivity;

/// What the paper draws: the light that an eye sees.
const SHOWN_NM: std::ops::RangeInclusive<f64> = 380.0..=750.0;

type Curve = (
    &'static str,
    LineStyle,
    &'static str,
    fn(&Sensitivity) -> f64,
);

/// The names of the figures and their SVG.
pub(super) fn figures_3_and_4() -> [(&'static str, String); 2] {
    let cones: [Curve; 3] = [
        ("S", LineStyle::Dashed, "#2b5fb3", |at| at.sml[0]),
        ("M", LineStyle::Solid, "#2e8b57", |at| at.sml[1]),
        ("L", LineStyle::DashDot, "#c0392b", |at| at.sml[2]),
    ];
    let opponents: [Curve; 3] = [
        ("A", LineStyle::Solid, "#222222", |at| at.ac1c2.a),
        ("C1", LineStyle::DashDot, "#c0392b", |at| at.ac1c2.c1),
        ("C2", LineStyle::Dashed, "#2b5fb3", |at| at.ac1c2.c2),
    ];
    [
        (
            "figure-3",
            svg(
                "Figure 3: sensitivities of the cones S, M and L",
                0.0,
                cones,
            ),
        ),
        (
            "figure-4",
            svg(
                "Figure 4: sensitivities of the channels A, C1 and C2",
                -1.0,
                opponents,
            ),
        ),
    ]
}

fn svg(title: &str, lowest: f64, curves: [Curve; 3]) -> String {
    let plots: Vec<Plot> = curves
        .into_iter()
        .map(|(name, style, color, value)| {
            let shown = sensitivities()
                .iter()
                .filter(|at| SHOWN_NM.contains(&at.wavelength_nm));
            let points: Vec<(f64, f64)> = shown.map(|at| (at.wavelength_nm, value(at))).collect();
            let line = LinePlot::new().with_data(points).with_line_style(style);
            line.with_color(color)
                .with_stroke_width(2.0)
                .with_legend(name)
                .into()
        })
        .collect();
    let layout = Layout::auto_from_plots(&plots)
        .with_width(640.0)
        .with_height(420.0)
        .with_title(title)
        .with_x_label("wavelength (nm)")
        .with_y_label("relative sensitivity")
        .with_font_family(FONT_FAMILY)
        .with_legend_position(LegendPosition::InsideTopRight)
        .with_x_axis_min(*SHOWN_NM.start())
        .with_x_axis_max(*SHOWN_NM.end())
        .with_y_axis_min(lowest)
        .with_y_axis_max(1.2);
    with_fixed_id(&kuva::render_to_svg(plots, layout))
}

/// kuva numbers the clip path of each plot that a process draws; a figure has one, and always the same.
fn with_fixed_id(svg: &str) -> String {
    let mut parts = svg.split("kuva-clip-");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |fixed, part| {
        fixed + "plot-area" + part.trim_start_matches(|c: char| c.is_ascii_digit())
    })
}
