//! The curves of each observer over the mean of all: a small panel for each.
//!
//! The factor with the most levels runs along x; one more with up to three levels has a line each, the rest is averaged.

use std::fmt::Write as _;

use crate::CellMatrix;
use crate::axis::Axis;
use crate::figure::{Palette, WIDTH};
use crate::line_style::LineStyle;
use crate::page::escaped;

/// More observers have no figure: nobody reads so many panels.
const MOST_OBSERVERS: usize = 60;
const MOST_LINES: usize = 3;
const COLUMNS: usize = 4;
/// The first panel's left, the widths of a panel and of its plot.
const LEFT: f64 = 44.0;
const PANEL: f64 = (WIDTH - LEFT) / COLUMNS as f64;
const PLOT: [f64; 2] = [PANEL - 22.0, 78.0];
/// From one row of panels to the next, and the first's top.
const ROW: f64 = 112.0;
const TOP: f64 = 26.0;

/// Curves: for each line its ratings along x.
type Curves = Vec<Vec<f64>>;

/// What the figure shows.
#[derive(Debug)]
pub(crate) struct ObserverFigure<'a> {
    cells: &'a CellMatrix,
    axis: Axis,
    palette: Palette,
    /// The factor along x and the one that parts the lines, by their places.
    along_x: usize,
    by: Option<usize>,
}

impl<'a> ObserverFigure<'a> {
    /// The figure of within cells; `None` with too many observers or nothing along x.
    pub(crate) fn new(cells: &'a CellMatrix, axis: Option<Axis>, palette: Palette) -> Option<Self> {
        let levels = |place: usize| cells.within[place].levels.len();
        let places = 0..cells.within.len();
        let along_x = places.clone().max_by_key(|&place| levels(place))?;
        let by = places
            .filter(|&place| place != along_x && levels(place) <= MOST_LINES)
            .max_by_key(|&place| levels(place));
        let axis = axis.unwrap_or_else(|| Axis::around(cells.scores.iter().copied()));
        (cells.subjects.len() <= MOST_OBSERVERS).then_some(Self {
            cells,
            axis,
            palette,
            along_x,
            by,
        })
    }

    /// The factor along x.
    pub(crate) fn factor(&self) -> &str {
        &self.cells.within[self.along_x].name
    }

    /// What the lines are of; `None` for one line.
    pub(crate) fn by(&self) -> Option<&str> {
        self.by.map(|place| self.cells.within[place].name.as_str())
    }

    /// The figure as an SVG document.
    pub(crate) fn to_svg(&self) -> String {
        let all: Vec<Curves> = (0..self.cells.subjects.len())
            .map(|subject| self.curves(subject))
            .collect();
        let mean = mean_of(&all);
        let n_rows = all.len().div_ceil(COLUMNS);
        let legend = if self.by.is_some() { 26.0 } else { 0.0 };
        let height = ROW.mul_add(n_rows as f64, TOP + legend);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" role=\"img\" aria-label=\"The curves of each \
             observer\" font-family=\"Ubuntu, 'Helvetica Neue', Helvetica, Arial, sans-serif\" font-size=\"11\">\n\
             <rect width=\"{WIDTH}\" height=\"{height}\" style=\"fill:{}\"/>\n",
            self.palette.paper
        );
        for (subject, curves) in all.iter().enumerate() {
            let corner = [
                PANEL.mul_add((subject % COLUMNS) as f64, LEFT),
                ROW.mul_add((subject / COLUMNS) as f64, TOP),
            ];
            self.panel(&mut svg, subject, corner, [curves, &mean]);
        }
        if let Some(by) = self.by {
            let names = self.cells.within[by].levels.iter().enumerate();
            for (place, name) in names {
                let at = [PANEL.mul_add(place as f64, LEFT), height - 14.0];
                LineStyle::new(place, self.palette).key(&mut svg, at, name);
            }
        }
        svg.push_str("</svg>\n");
        svg
    }

    /// The ratings of a subject, averaged over the factors that are not shown.
    fn curves(&self, subject: usize) -> Curves {
        let factors = &self.cells.within;
        let n_lines = self.by.map_or(1, |place| factors[place].levels.len());
        let n_levels = factors[self.along_x].levels.len();
        let mut sums = vec![vec![(0.0, 0_u32); n_levels]; n_lines];
        for cell in 0..self.cells.scores.ncols() {
            let levels = self.cells.cell_levels(cell);
            let place_of = |factor: usize| {
                let known = factors[factor].levels.iter();
                known.clone().position(|level| level == levels[factor])
            };
            let line = self.by.and_then(place_of).unwrap_or(0);
            let (sum, count) = &mut sums[line][place_of(self.along_x).unwrap_or(0)];
            *sum += self.cells.scores[(subject, cell)];
            *count += 1;
        }
        let average = |(sum, count): (f64, u32)| sum / f64::from(count.max(1));
        (sums.into_iter())
            .map(|line| line.into_iter().map(average).collect())
            .collect()
    }

    fn panel(&self, svg: &mut String, subject: usize, corner: [f64; 2], curves: [&Curves; 2]) {
        let ([left, top], Palette { ink, faint, .. }) = (corner, self.palette);
        let bottom = top + PLOT[1];
        // Writing to a `String` cannot fail, here and below.
        _ = writeln!(
            svg,
            "<text x=\"{left:.2}\" y=\"{:.2}\" style=\"fill:{ink}\">{}</text>\
             <path d=\"M{left:.2},{top:.2}V{bottom:.2}h{:.2}\" fill=\"none\" style=\"stroke:{faint}\" stroke-width=\"1\"/>",
            top - 6.0,
            escaped(&self.cells.subjects[subject]),
            PLOT[0]
        );
        if subject.is_multiple_of(COLUMNS) {
            let numbers = self.axis.numbers();
            for (value, text) in numbers.first().into_iter().chain(numbers.last()) {
                _ = writeln!(
                    svg,
                    "<text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"end\" style=\"fill:{ink}\">{text}</text>",
                    left - 5.0,
                    self.y(top, *value) + 4.0
                );
            }
        }
        let levels = &self.cells.within[self.along_x].levels;
        for (x, anchor, level) in [
            (left, "start", levels.first()),
            (left + PLOT[0], "end", levels.last()),
        ] {
            _ = writeln!(
                svg,
                "<text x=\"{x:.2}\" y=\"{:.2}\" text-anchor=\"{anchor}\" font-size=\"9\" style=\"fill:{ink}\">{}</text>",
                bottom + 11.0,
                escaped(level.map_or("", String::as_str))
            );
        }
        let [own, mean] = curves;
        for line in mean {
            _ = writeln!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" style=\"stroke:{faint}\" stroke-width=\"4\"/>",
                joined_points(&self.points(corner, line))
            );
        }
        for (place, line) in own.iter().enumerate() {
            let style = LineStyle::new(place, self.palette);
            style.open(svg);
            style.path(svg, &self.points(corner, line));
            svg.push_str("</g>\n");
        }
    }

    fn y(&self, top: f64, value: f64) -> f64 {
        PLOT[1].mul_add(1.0 - self.axis.share(value), top)
    }

    fn points(&self, [left, top]: [f64; 2], line: &[f64]) -> Vec<[f64; 2]> {
        let step = PLOT[0] / (line.len().max(2) - 1) as f64;
        (line.iter().enumerate())
            .map(|(place, &value)| [step.mul_add(place as f64, left), self.y(top, value)])
            .collect()
    }
}

fn joined_points(points: &[[f64; 2]]) -> String {
    let points: Vec<String> = (points.iter())
        .map(|[x, y]| format!("{x:.2},{y:.2}"))
        .collect();
    points.join(" ")
}

/// The mean of each point over observers.
fn mean_of(all: &[Curves]) -> Curves {
    let Some(first) = all.first() else {
        return Vec::new();
    };
    let mean = |line: usize, place: usize| {
        let sum: f64 = all.iter().map(|curves| curves[line][place]).sum();
        sum / all.len() as f64
    };
    (first.iter().enumerate())
        .map(|(line, points)| (0..points.len()).map(|place| mean(line, place)).collect())
        .collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::Observations;

    #[test]
    fn each_observer_has_its_own_curves_over_the_mean() {
        let names = ["way", "size", "hour"].map(str::to_owned);
        let mut observations = Observations::new(Path::new("test"), &[], &names);
        for subject in 0..5 {
            for cell in 0..2 * 2 * 4 {
                let (way, size, hour) = (cell % 2, cell / 2 % 2, cell / 4);
                let rating = f64::from(hour + 10 * way + 100 * size + subject);
                let levels = [format!("w{way}"), format!("s{size}"), format!("h{hour}")];
                let levels = levels.iter().map(String::as_str);
                observations.push(&format!("<{subject}>"), levels, Some(rating));
            }
        }
        let cells = CellMatrix::new(&observations).unwrap();
        let figure = ObserverFigure::new(&cells, None, Palette::PRINT).unwrap();
        assert_eq!((figure.factor(), figure.by()), ("hour", Some("size")));
        // Averaged over the ways, 0 and 10: hours rise by 1, sizes differ by 100, subjects by 1.
        assert_eq!(figure.curves(0)[0], [5.0, 6.0, 7.0, 8.0]);
        assert_eq!(figure.curves(3)[1], [108.0, 109.0, 110.0, 111.0]);
        let all: Vec<Curves> = (0..5).map(|subject| figure.curves(subject)).collect();
        assert_eq!(mean_of(&all)[0], [7.0, 8.0, 9.0, 10.0]);
        let svg = figure.to_svg();
        assert!(svg.contains("&lt;4&gt;"));
        // Of 5 observers two lines and two mean lines each, and two of the legend.
        assert_eq!(svg.matches("<polyline").count(), 22);
    }
}
