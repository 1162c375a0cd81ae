//! A vector picture as a PDF of one page, and the form of PDF files.
//!
//! Filled and stroked paths in plain colours, which is all that our figures are made of; words come as outlines. No
//! clipping, gradients, images or filters: a figure that had them would lose them.
//!
//! Source: ISO 32000-1 (PDF 1.7), sections 7.5, 8.4, 8.5.

use std::fmt::Write as _;

use crate::document::joined;
use resvg::tiny_skia::{PathSegment, Transform};
use resvg::usvg::{Fill, FillRule, LineCap, LineJoin, Node, Paint, Path, Stroke, Tree};

/// A unit of the picture is a hundredth of an inch, one of PDF a seventy-second.
const POINTS_PER_UNIT: f32 = 0.72;

/// The PDF of a picture.
pub(crate) fn pdf_of(tree: &Tree) -> Vec<u8> {
    let size = tree.size();
    let (width, height) = (
        size.width() * POINTS_PER_UNIT,
        size.height() * POINTS_PER_UNIT,
    );
    let mut canvas = Canvas::default();
    canvas.picture(tree, [0.0, height], POINTS_PER_UNIT);
    let objects = [
        "<< /Type /Catalog /Pages 2 0 R >>".to_owned(),
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>".to_owned(),
        format!(
            "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width} {height}] /Contents 4 0 R /Resources << /ExtGState << \
             {}>> >> >>",
            canvas.states()
        ),
        format!(
            "<< /Length {} >>\nstream\n{}endstream",
            canvas.content.len(),
            canvas.content
        ),
    ];
    file_of(&objects.map(String::into_bytes), "")
}

/// The objects, numbered from 1, with the table of their places; the first is the catalog. `trailer` is put into the trailer.
pub(crate) fn file_of(objects: &[Vec<u8>], trailer: &str) -> Vec<u8> {
    let mut file = b"%PDF-1.7\n".to_vec();
    let mut places = String::new();
    for (index, object) in objects.iter().enumerate() {
        // Writing to a `String` cannot fail.
        _ = writeln!(places, "{:010} 00000 n ", file.len());
        file.extend(format!("{} 0 obj\n", index + 1).into_bytes());
        file.extend(object);
        file.extend(b"\nendobj\n");
    }
    let (start, count) = (file.len(), objects.len() + 1);
    let end = format!(
        "xref\n0 {count}\n0000000000 65535 f \n{places}trailer\n<< /Size {count} /Root 1 0 R {trailer}>>\nstartxref\n{start}\n%%EOF\n"
    );
    file.extend(end.into_bytes());
    file
}

/// What is drawn on a page.
#[derive(Debug, Default)]
pub(crate) struct Canvas {
    pub(crate) content: String,
    /// Opacities of fill and stroke, by the number of their graphics state.
    opacities: Vec<[f32; 2]>,
}

impl Canvas {
    /// Draws a picture with its upper left corner at a place (y upwards), `scale` points for each of its units.
    pub(crate) fn picture(&mut self, tree: &Tree, [x, y]: [f32; 2], scale: f32) {
        // Writing to a `String` cannot fail, here and below.
        _ = writeln!(self.content, "q {scale} 0 0 -{scale} {x} {y} cm");
        self.nodes(tree.root().children(), 1.0);
        self.content.push_str("Q\n");
    }

    /// The graphics states so far, for a dictionary of resources.
    pub(crate) fn states(&self) -> String {
        joined(
            self.opacities.iter().enumerate(),
            |(index, [fill, stroke])| format!("/G{index} << /ca {fill} /CA {stroke} >> "),
        )
    }

    fn nodes(&mut self, nodes: &[Node], opacity: f32) {
        for node in nodes {
            match node {
                Node::Group(group) => self.nodes(group.children(), opacity * group.opacity().get()),
                Node::Text(text) => self.nodes(text.flattened().children(), opacity),
                Node::Path(path) => self.path(path, opacity),
                Node::Image(_) => {}
            }
        }
    }

    fn path(&mut self, path: &Path, opacity: f32) {
        if !path.is_visible() {
            return;
        }
        let of = |own: Option<f32>| own.map_or(1.0, |own| own * opacity);
        let fill = path.fill();
        let stroke = path.stroke();
        let state = self.state([
            of(fill.map(|fill| fill.opacity().get())),
            of(stroke.map(|stroke| stroke.opacity().get())),
        ]);
        let Transform {
            sx,
            kx,
            ky,
            sy,
            tx,
            ty,
        } = path.abs_transform();
        _ = writeln!(
            self.content,
            "q /G{state} gs {sx} {ky} {kx} {sy} {tx} {ty} cm"
        );
        if let Some(stroke) = stroke {
            self.stroke(stroke);
        }
        if let Some(fill) = fill {
            _ = writeln!(self.content, "{} rg", color(fill.paint()));
        }
        self.outline(path);
        _ = writeln!(self.content, "{} Q", painting(fill, stroke));
    }

    /// The number of the graphics state with these opacities.
    fn state(&mut self, opacities: [f32; 2]) -> usize {
        let known = self.opacities.iter().position(|known| *known == opacities);
        known.unwrap_or_else(|| {
            self.opacities.push(opacities);
            self.opacities.len() - 1
        })
    }

    fn stroke(&mut self, stroke: &Stroke) {
        let cap = match stroke.linecap() {
            LineCap::Butt => 0,
            LineCap::Round => 1,
            LineCap::Square => 2,
        };
        let join = match stroke.linejoin() {
            LineJoin::Miter | LineJoin::MiterClip => 0,
            LineJoin::Round => 1,
            LineJoin::Bevel => 2,
        };
        let dashes: Vec<String> = (stroke.dasharray().unwrap_or_default().iter())
            .map(f32::to_string)
            .collect();
        _ = writeln!(
            self.content,
            "{} RG {} w {cap} J {join} j [{}] {} d",
            color(stroke.paint()),
            stroke.width().get(),
            dashes.join(" "),
            stroke.dashoffset()
        );
    }

    fn outline(&mut self, path: &Path) {
        let mut last = (0.0, 0.0);
        for segment in path.data().segments() {
            _ = match segment {
                PathSegment::MoveTo(to) => {
                    last = (to.x, to.y);
                    writeln!(self.content, "{} m", numbers(&[to.x, to.y]))
                }
                PathSegment::LineTo(to) => {
                    last = (to.x, to.y);
                    writeln!(self.content, "{} l", numbers(&[to.x, to.y]))
                }
                PathSegment::QuadTo(by, to) => {
                    // The cubic curve that is the same: its inner points lie two thirds of the way to the quadratic's.
                    let third = |end: f32, middle: f32| (2.0 * middle + end) / 3.0;
                    let (x1, y1) = (third(last.0, by.x), third(last.1, by.y));
                    let (x2, y2) = (third(to.x, by.x), third(to.y, by.y));
                    last = (to.x, to.y);
                    writeln!(self.content, "{} c", numbers(&[x1, y1, x2, y2, to.x, to.y]))
                }
                PathSegment::CubicTo(first, second, to) => {
                    last = (to.x, to.y);
                    let [a, b] = [first, second];
                    writeln!(
                        self.content,
                        "{} c",
                        numbers(&[a.x, a.y, b.x, b.y, to.x, to.y])
                    )
                }
                PathSegment::Close => writeln!(self.content, "h"),
            };
        }
    }
}

/// Numbers to a thousandth of a unit.
fn numbers(values: &[f32]) -> String {
    let rounded = values
        .iter()
        .map(|value| ((value * 1000.0).round() / 1000.0).to_string());
    rounded.collect::<Vec<_>>().join(" ")
}

/// The operator that fills and strokes.
fn painting(fill: Option<&Fill>, stroke: Option<&Stroke>) -> &'static str {
    let is_even_odd = fill.is_some_and(|fill| fill.rule() == FillRule::EvenOdd);
    match (fill.is_some(), stroke.is_some(), is_even_odd) {
        (true, true, false) => "B",
        (true, true, true) => "B*",
        (true, false, false) => "f",
        (true, false, true) => "f*",
        (false, true, _) => "S",
        (false, false, _) => "n",
    }
}

fn color(paint: &Paint) -> String {
    let Paint::Color(color) = paint else {
        return "0 0 0".to_owned();
    };
    let parts = [color.red, color.green, color.blue].map(|part| f32::from(part) / 255.0);
    parts.map(|part| part.to_string()).join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SVG: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 200 100\">\
        <rect x=\"10\" y=\"20\" width=\"30\" height=\"40\" fill=\"#ff0000\"/>\
        <path d=\"M5,5h90\" fill=\"none\" stroke=\"#000000\" stroke-width=\"2\" stroke-dasharray=\"4 2\" stroke-opacity=\"0.5\"/></svg>";

    #[test]
    fn a_picture_keeps_its_size_its_colours_and_its_places() {
        let tree = Tree::from_str(SVG, &resvg::usvg::Options::default()).unwrap();
        let pdf = String::from_utf8(pdf_of(&tree)).unwrap();
        // 200 by 100 hundredths of an inch.
        assert!(pdf.contains("/MediaBox [0 0 144 72]"), "{pdf}");
        assert!(
            pdf.contains("1 0 0 rg\n10 20 m\n40 20 l\n40 60 l\n10 60 l\nh\nf Q"),
            "{pdf}"
        );
        assert!(
            pdf.contains("0 0 0 RG 2 w 0 J 0 j [4 2] 0 d\n5 5 m\n95 5 l\nS Q"),
            "{pdf}"
        );
        assert!(pdf.contains("/ca 1 /CA 0.5"), "{pdf}");
    }

    #[test]
    fn every_object_stands_where_the_table_says() {
        let tree = Tree::from_str(SVG, &resvg::usvg::Options::default()).unwrap();
        let pdf = String::from_utf8(pdf_of(&tree)).unwrap();
        let (_, rest) = pdf.split_once("startxref\n").unwrap();
        let start: usize = rest.lines().next().unwrap().parse().unwrap();
        let table: Vec<&str> = pdf[start..].lines().collect();
        assert_eq!(table[..2], ["xref", "0 5"]);
        for object in 1..5 {
            let line = table[2 + object];
            // Each line of the table has 20 bytes with its end.
            assert_eq!(line.len(), 19, "{line:?}");
            let place: usize = line[..10].parse().unwrap();
            assert!(pdf[place..].starts_with(&format!("{object} 0 obj\n")));
        }
        let (_, stream) = pdf.split_once("stream\n").unwrap();
        let length = stream.find("endstream").unwrap();
        assert!(pdf.contains(&format!("/Length {length} ")));
    }
}
