//! Figures 3 and 4: the sensitivities of the cones and of the opponent channels, with the paper's dashes.

use std::fmt::Write as _;

use super::rasterizer::FONT_FAMILY;
use crate::spectra::sensitivities;
use crate::spectra::sensitivity::Sensitivity;

/// What the paper draws: the light that an eye sees.
const SHOWN_NM: std::ops::RangeInclusive<f64> = 380.0..=750.0;

/// The plot's frame in the picture, in units of the SVG.
const LEFT: f64 = 72.0;
const RIGHT: f64 = 616.0;
const TOP: f64 = 56.0;
const BOTTOM: f64 = 352.0;
/// The largest value that the frame has room for.
const HIGHEST: f64 = 1.15;

/// A curve with the paper's dashes and its name beside it.
struct Curve {
    name: &'static str,
    dashes: &'static str,
    color: &'static str,
    /// The middle of the name: wavelength in nm and value.
    name_at: (f64, f64),
    value: fn(&Sensitivity) -> f64,
}

const SOLID: &str = "none";
const DASHED: &str = "8 5";
const DOT_DASHED: &str = "9 4 2 4";

const CONES: [Curve; 3] = [
    Curve {
        name: "S",
        dashes: DASHED,
        color: "#2b5fb3",
        name_at: (446.0, 1.05),
        value: |at| at.sml[0],
    },
    Curve {
        name: "M",
        dashes: SOLID,
        color: "#2e8b57",
        name_at: (534.0, 1.05),
        value: |at| at.sml[1],
    },
    Curve {
        name: "L",
        dashes: DOT_DASHED,
        color: "#c0392b",
        name_at: (571.0, 1.05),
        value: |at| at.sml[2],
    },
];

const OPPONENTS: [Curve; 3] = [
    Curve {
        name: "A",
        dashes: SOLID,
        color: "#222222",
        name_at: (554.0, 1.06),
        value: |at| at.ac1c2.a,
    },
    Curve {
        name: "C1",
        dashes: DOT_DASHED,
        color: "#c0392b",
        name_at: (660.0, -0.6),
        value: |at| at.ac1c2.c1,
    },
    Curve {
        name: "C2",
        dashes: DASHED,
        color: "#2b5fb3",
        name_at: (445.0, 1.06),
        value: |at| at.ac1c2.c2,
    },
];

/// The names of the figures and their SVG.
pub(super) fn figures_3_and_4() -> [(&'static str, String); 2] {
    let cones = "Figure 3: sensitivities of the cones S, M and L";
    let channels = "Figure 4: sensitivities of the channels A, C1 and C2";
    [
        ("figure-3", svg(cones, 0.0, &CONES)),
        ("figure-4", svg(channels, -1.0, &OPPONENTS)),
    ]
}

fn svg(title: &str, lowest: f64, curves: &[Curve; 3]) -> String {
    let frame = Frame { lowest };
    let marks = [
        frame.axes(),
        curves.iter().map(|curve| frame.curve(curve)).collect(),
    ];
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"640\" height=\"420\" viewBox=\"0 0 640 420\" \
         font-family=\"{FONT_FAMILY}\" font-size=\"14\" fill=\"#222222\">\n\
         <rect width=\"640\" height=\"420\" fill=\"#ffffff\"/>\n\
         <text x=\"{LEFT}\" y=\"32\" font-size=\"17\">{title}</text>\n{}</svg>\n",
        marks.concat()
    )
}

/// From wavelengths and values to places in the picture.
struct Frame {
    lowest: f64,
}

impl Frame {
    fn x(wavelength_nm: f64) -> f64 {
        let share = (wavelength_nm - SHOWN_NM.start()) / (SHOWN_NM.end() - SHOWN_NM.start());
        LEFT + share * (RIGHT - LEFT)
    }

    fn y(&self, value: f64) -> f64 {
        BOTTOM - (value - self.lowest) / (HIGHEST - self.lowest) * (BOTTOM - TOP)
    }

    fn axes(&self) -> String {
        let mut svg = String::new();
        let halves = [-1.0, -0.5, 0.0, 0.5, 1.0];
        for value in halves.into_iter().filter(|value| *value >= self.lowest) {
            let (y, color) = (
                self.y(value),
                if value == 0.0 { "#222222" } else { "#dddddd" },
            );
            let label = format!("{value}").replace('-', "\u{2212}");
            // Writing to a `String` cannot fail.
            _ = writeln!(
                svg,
                "<line x1=\"{LEFT}\" x2=\"{RIGHT}\" y1=\"{y:.2}\" y2=\"{y:.2}\" stroke=\"{color}\"/>\
                 <text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"end\">{label}</text>",
                LEFT - 9.0,
                y + 5.0
            );
        }
        for hundreds in 4..=7 {
            let wavelength_nm = f64::from(100 * hundreds);
            let x = Self::x(wavelength_nm);
            _ = writeln!(
                svg,
                "<line x1=\"{x:.2}\" x2=\"{x:.2}\" y1=\"{BOTTOM}\" y2=\"{:.2}\" stroke=\"#222222\"/>\
                 <text x=\"{x:.2}\" y=\"{:.2}\" text-anchor=\"middle\">{wavelength_nm}</text>",
                BOTTOM + 6.0,
                BOTTOM + 22.0
            );
        }
        let (middle_x, middle_y) = (0.5 * (LEFT + RIGHT), 0.5 * (TOP + BOTTOM));
        svg + &format!(
            "<text x=\"{middle_x}\" y=\"404\" text-anchor=\"middle\">wavelength (nm)</text>\n\
             <text transform=\"translate(22 {middle_y}) rotate(-90)\" text-anchor=\"middle\">relative sensitivity</text>\n"
        )
    }

    fn curve(&self, curve: &Curve) -> String {
        let shown = sensitivities()
            .iter()
            .filter(|at| SHOWN_NM.contains(&at.wavelength_nm));
        let points: Vec<String> = shown
            .map(|at| {
                format!(
                    "{:.2},{:.2}",
                    Self::x(at.wavelength_nm),
                    self.y((curve.value)(at))
                )
            })
            .collect();
        let Curve {
            name,
            dashes,
            color,
            name_at: (wavelength_nm, value),
            ..
        } = *curve;
        format!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\" stroke-dasharray=\"{dashes}\"/>\n\
             <text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"middle\" font-size=\"16\" fill=\"{color}\">{name}</text>\n",
            points.join(" "),
            Self::x(wavelength_nm),
            self.y(value)
        )
    }
}
