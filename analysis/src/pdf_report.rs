//! A whole report as PDF: A4 pages with fonts embedded, tables that repeat their heads, figures as vectors.
//!
//! Nothing here reads a clock, so the same report is the same file. Not here: glyphs and words (`pdf_text`), paths (`pdf`).

use std::fmt::Write as _;

use crate::AnalysisError;
use crate::document::{Block, Document, Style, Table, joined};
use crate::figure::Palette;
use crate::pdf::{Canvas, file_of};
use crate::pdf_font::stream;
use crate::pdf_text::{Fonts, Word, lines, set, width};
use crate::picture::FigurePicture;
use crate::rich_text::plain;

/// A4 in points, and its margins.
const PAGE: [f32; 2] = [595.28, 841.89];
const MARGIN: f32 = 56.0;
const BOTTOM: f32 = 62.0;
const ROOM: f32 = PAGE[0] - 2.0 * MARGIN;
/// Sizes of text, and the distance of lines in sizes.
const TEXT: f32 = 9.6;
const NOTE: f32 = 8.4;
const CELL: f32 = 8.0;
const SMALLEST_CELL: f32 = 5.2;
const HEADING: f32 = 12.5;
const TITLE: f32 = 17.0;
const LEADING: f32 = 1.42;
/// The highest figure, and the share of its height to which it may shrink.
const TALLEST: f32 = 300.0;
const LEAST: f32 = 0.75;
/// A table with more rows may break over pages.
const LONG: usize = 16;
const INK: f32 = 0.0;
const SOFT: f32 = 0.3;

impl Document {
    /// The document as PDF.
    ///
    /// # Errors
    ///
    /// [`AnalysisError::Figure`] if a figure or a font cannot be read.
    pub(crate) fn to_pdf(&self) -> Result<Vec<u8>, AnalysisError> {
        let mut layout = Layout::new()?;
        layout.head(self);
        for section in &self.sections {
            if let Some(heading) = section.heading {
                layout.heading = Some(heading);
            }
            for block in &section.blocks {
                layout.block(block)?;
            }
        }
        Ok(layout.into_file(&plain(&self.study), &plain(&self.title)))
    }
}

/// Pages, filled from above.
struct Layout {
    fonts: Fonts,
    canvas: Canvas,
    /// The contents of the pages that are full.
    pages: Vec<String>,
    /// The height of what is set next.
    y: f32,
    /// A heading that waits for what stands below it, so that it is never the last on a page.
    heading: Option<&'static str>,
}

/// How a paragraph is set.
#[derive(Clone, Copy)]
struct Setting {
    size: f32,
    left: f32,
    grey: f32,
}

const PLAIN: Setting = Setting {
    size: TEXT,
    left: 0.0,
    grey: INK,
};

impl Layout {
    fn new() -> Result<Self, AnalysisError> {
        Ok(Self {
            fonts: Fonts::new()?,
            canvas: Canvas::default(),
            pages: Vec::new(),
            y: PAGE[1] - MARGIN,
            heading: None,
        })
    }

    fn break_page(&mut self) {
        self.pages.push(std::mem::take(&mut self.canvas.content));
        self.y = PAGE[1] - MARGIN;
    }

    /// Begins a page unless this much room is left.
    fn need(&mut self, height: f32) {
        if self.y - height < BOTTOM && self.y < PAGE[1] - MARGIN {
            self.break_page();
        }
    }

    fn skip(&mut self, height: f32) {
        if self.y < PAGE[1] - MARGIN {
            self.y -= height;
        }
    }

    /// A filled rectangle: a rule, or the ground of a banner.
    fn fill(&mut self, [x, y]: [f32; 2], [width, height]: [f32; 2], color: &str) {
        // Writing to a `String` cannot fail.
        _ = writeln!(
            self.canvas.content,
            "{color} rg {x:.2} {y:.2} {width:.2} {height:.2} re f"
        );
    }

    fn paragraph(&mut self, words: Vec<Word>, setting: Setting) {
        let Setting { size, left, grey } = setting;
        for line in lines(words, (ROOM - left) / size) {
            self.need(size * LEADING);
            self.y -= size * LEADING;
            let place = [MARGIN + left, self.y];
            set(&mut self.canvas.content, &line, size, place, grey);
        }
    }

    fn head(&mut self, document: &Document) {
        let small = Setting {
            size: NOTE,
            grey: SOFT,
            ..PLAIN
        };
        let study = self
            .fonts
            .words(&format!("Report of the study <b>{}</b>", document.study));
        self.paragraph(study, small);
        let title = self.fonts.bold(&document.title);
        let size = TITLE;
        self.paragraph(title, Setting { size, ..PLAIN });
        self.y -= 4.0;
        for line in &document.bylines {
            let words = self.fonts.words(line);
            self.paragraph(words, small);
        }
        self.y -= 8.0;
        self.fill([MARGIN, self.y], [ROOM, 0.6], "0.7 0.7 0.7");
        self.y -= 4.0;
    }

    /// Room for a block that begins `gap` below the last and is so high, together with the heading that waits for it.
    fn begin(&mut self, gap: f32, height: f32) {
        let Some(heading) = self.heading.take() else {
            self.skip(gap);
            return self.need(height);
        };
        self.skip(14.0);
        self.need(HEADING.mul_add(LEADING, height + gap + 3.0));
        let words = self.fonts.bold(heading);
        let size = HEADING;
        self.paragraph(words, Setting { size, ..PLAIN });
        self.y -= gap.min(3.0);
    }

    fn block(&mut self, block: &Block) -> Result<(), AnalysisError> {
        match block {
            Block::Paragraph(Style::Banner, text) => self.banner(text),
            Block::Paragraph(style, text) => {
                let setting = setting(*style);
                self.begin(4.0, 2.0 * setting.size * LEADING);
                let words = self.fonts.words(text);
                self.paragraph(words, setting);
            }
            Block::List(style, items) => {
                for item in items {
                    self.item(item, setting(*style));
                }
            }
            Block::Terms(terms) => {
                for (term, text) in terms {
                    let text = format!("<b>{term}.</b> {text}");
                    self.item(&text, setting(Style::Note));
                }
            }
            Block::Table(table) => self.table(table),
            Block::Figure { svg, caption, .. } => self.figure(svg, caption)?,
            Block::Beside(blocks) => {
                for block in blocks {
                    self.block(block)?;
                }
            }
        }
        Ok(())
    }

    fn item(&mut self, text: &str, setting: Setting) {
        self.begin(3.0, setting.size * LEADING);
        let bullet = self.fonts.words("•");
        let place = [MARGIN + 2.0, self.y - setting.size * LEADING];
        set(
            &mut self.canvas.content,
            &bullet,
            setting.size,
            place,
            setting.grey,
        );
        let words = self.fonts.words(text);
        let left = 12.0;
        self.paragraph(words, Setting { left, ..setting });
    }

    fn banner(&mut self, text: &str) {
        let words = self.fonts.words(text);
        let left = 12.0;
        let n_lines = lines(words.clone(), (ROOM - 2.0 * left) / TEXT).len();
        let height = (n_lines as f32).mul_add(TEXT * LEADING, 10.0);
        self.begin(8.0, height);
        let corner = [MARGIN, self.y - height];
        self.fill(corner, [ROOM, height], "1 0.953 0.902");
        self.fill(corner, [2.5, height], "0.776 0.294 0");
        self.y -= 2.0;
        for line in lines(words, (ROOM - 2.0 * left) / TEXT) {
            self.y -= TEXT * LEADING;
            let place = [MARGIN + left, self.y];
            set(&mut self.canvas.content, &line, TEXT, place, INK);
        }
        self.y = corner[1] - 4.0;
    }

    fn figure(&mut self, svg: &str, caption: &str) -> Result<(), AnalysisError> {
        let picture = FigurePicture::new(&printed(svg))?;
        let tree = picture.tree();
        let size = tree.size();
        let widest = (ROOM / size.width()).min(TALLEST / size.height());
        let words = self.fonts.words(caption);
        let n_lines = lines(words.clone(), ROOM / NOTE).len();
        let below = (n_lines as f32).mul_add(NOTE * LEADING, 6.0);
        self.begin(8.0, LEAST * widest * size.height() + below);
        // Smaller, rather than on a page of its own.
        let scale = widest.min((self.y - BOTTOM - below) / size.height());
        let height = scale * size.height();
        let left = MARGIN + (ROOM - scale * size.width()) / 2.0;
        self.canvas.picture(tree, [left, self.y], scale);
        self.y -= height + 4.0;
        self.paragraph(words, setting(Style::Note));
        Ok(())
    }

    fn table(&mut self, table: &Table) {
        let set_table = SetTable::new(&mut self.fonts, table);
        let caption = self.fonts.words(&table.caption);
        let n_lines = lines(caption.clone(), ROOM / NOTE).len();
        let head = (n_lines as f32).mul_add(NOTE * LEADING, set_table.head_height());
        let n_kept = if table.rows.len() > LONG {
            4
        } else {
            table.rows.len()
        };
        let height = (n_kept as f32).mul_add(set_table.line(), head + 12.0);
        self.begin(9.0, height);
        self.paragraph(caption, setting(Style::Note));
        self.y -= 4.0;
        self.table_head(&set_table);
        for row in &set_table.rows {
            if self.y - set_table.line() < BOTTOM {
                self.fill([MARGIN, self.y - 3.0], [set_table.total, 0.4], "0 0 0");
                self.break_page();
                self.table_head(&set_table);
            }
            self.row(&set_table, row);
        }
        self.fill([MARGIN, self.y - 4.0], [set_table.total, 0.9], "0 0 0");
        self.y -= 8.0;
    }

    fn table_head(&mut self, table: &SetTable) {
        self.fill([MARGIN, self.y], [table.total, 0.9], "0 0 0");
        self.y -= 2.0;
        if !table.groups.is_empty() {
            self.y -= table.line();
            let mut column = 0;
            for (words, span) in &table.groups {
                let first = table.left(column);
                let last = table.left(column + span - 1) + table.widths[column + span - 1];
                column += span;
                if words.is_empty() {
                    continue;
                }
                let middle = f32::midpoint(first, last) - table.size * width(words) / 2.0;
                let place = [MARGIN + middle, self.y];
                set(&mut self.canvas.content, words, table.size, place, INK);
                let rule = [MARGIN + first, self.y - 0.3 * table.size];
                self.fill(rule, [last - first, 0.4], "0.5 0.5 0.5");
            }
            self.y -= 1.0;
        }
        self.row(table, &table.columns);
        self.fill([MARGIN, self.y - 3.5], [table.total, 0.5], "0 0 0");
        self.y -= 4.0;
    }

    fn row(&mut self, table: &SetTable, cells: &[Vec<Word>]) {
        self.y -= table.line();
        for (column, words) in cells.iter().enumerate() {
            let left = table.left(column);
            let indent = if column == 0 {
                0.0
            } else {
                table.widths[column] - table.size * width(words)
            };
            let place = [MARGIN + left + indent, self.y];
            set(&mut self.canvas.content, words, table.size, place, INK);
        }
    }

    /// The file: its pages numbered, its fonts, its title.
    fn into_file(mut self, study: &str, title: &str) -> Vec<u8> {
        self.break_page();
        let n_pages = self.pages.len();
        let mut pages = std::mem::take(&mut self.pages);
        for (index, page) in pages.iter_mut().enumerate() {
            let text = format!("{study} · page {} of {n_pages}", index + 1);
            let words = self.fonts.words(&crate::page::escaped(&text));
            let left = (PAGE[0] - 7.5 * width(&words)) / 2.0;
            set(page, &words, 7.5, [left, 34.0], SOFT);
        }
        // Objects: catalog, pages, resources, information; then fonts; then a page and its content in turn.
        let (fonts, font_names) = self.fonts.objects(5);
        let first = 5 + fonts.len();
        let kids = joined(0..n_pages, |index| format!("{} 0 R ", first + 2 * index));
        let mut objects: Vec<Vec<u8>> = [
            "<< /Type /Catalog /Pages 2 0 R /Lang (en) /ViewerPreferences << /DisplayDocTitle true >> >>".to_owned(),
            format!("<< /Type /Pages /Kids [{kids}] /Count {n_pages} >>"),
            format!(
                "<< /Font << {font_names}>> /ExtGState << {}>> >>",
                self.canvas.states()
            ),
            format!(
                "<< /Title {} /Creator (Acuity {}) >>",
                utf16(title),
                env!("CARGO_PKG_VERSION")
            ),
        ]
        .map(String::into_bytes)
        .into();
        objects.extend(fonts);
        for (index, page) in pages.iter().enumerate() {
            let content = first + 2 * index + 1;
            let dictionary = format!(
                "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {} {}] /Resources 3 0 R /Contents {content} 0 R >>",
                PAGE[0], PAGE[1]
            );
            objects.push(dictionary.into_bytes());
            objects.push(stream(page.as_bytes(), ""));
        }
        file_of(&objects, "/Info 4 0 R ")
    }
}

const fn setting(style: Style) -> Setting {
    match style {
        Style::Plain | Style::Banner => PLAIN,
        Style::Result => Setting {
            size: 10.4,
            ..PLAIN
        },
        Style::Note => Setting {
            size: NOTE,
            grey: SOFT,
            ..PLAIN
        },
    }
}

/// A figure of the page in the colours of paper.
fn printed(svg: &str) -> String {
    let (page, print) = (Palette::PAGE, Palette::PRINT);
    svg.replace(page.ink, print.ink)
        .replace(page.faint, print.faint)
        .replace(page.paper, print.paper)
        .replace(page.chromatic, print.chromatic)
        .replace(page.blue, print.blue)
}

/// Text outside of pages: UTF-16 with its mark, in hexadecimal.
fn utf16(text: &str) -> String {
    format!(
        "<FEFF{}>",
        joined(text.encode_utf16(), |unit| format!("{unit:04X}"))
    )
}

/// A table with the widths of its columns, set as large as it fits.
struct SetTable {
    columns: Vec<Vec<Word>>,
    groups: Vec<(Vec<Word>, usize)>,
    rows: Vec<Vec<Vec<Word>>>,
    widths: Vec<f32>,
    gap: f32,
    size: f32,
    total: f32,
}

impl SetTable {
    fn new(fonts: &mut Fonts, table: &Table) -> Self {
        let columns: Vec<Vec<Word>> = table.columns.iter().map(|text| fonts.bold(text)).collect();
        let groups: Vec<(Vec<Word>, usize)> = (table.groups.iter())
            .map(|(text, span)| (fonts.words(text), *span))
            .collect();
        let rows: Vec<Vec<Vec<Word>>> = (table.rows.iter())
            .map(|row| row.iter().map(|cell| fonts.words(cell)).collect())
            .collect();
        let mut widths = vec![0.0_f32; columns.len()];
        for row in rows.iter().chain(std::iter::once(&columns)) {
            for (widest, words) in widths.iter_mut().zip(row) {
                *widest = widest.max(width(words));
            }
        }
        let gap = 1.2;
        let gaps = gap * widths.len().saturating_sub(1) as f32;
        let natural = widths.iter().sum::<f32>() + gaps;
        let size = CELL.min(ROOM / natural).max(SMALLEST_CELL);
        // What is left over goes between the columns, as far as it looks like one table.
        let n_gaps = widths.len().saturating_sub(1).max(1) as f32;
        let spare = ((ROOM - size * natural) / n_gaps).clamp(0.0, 2.6 * size);
        let gap = size.mul_add(gap, spare);
        let widths: Vec<f32> = widths.into_iter().map(|width| size * width).collect();
        Self {
            total: widths.iter().sum::<f32>() + gap * (widths.len().saturating_sub(1)) as f32,
            columns,
            groups,
            rows,
            widths,
            gap,
            size,
        }
    }

    fn left(&self, column: usize) -> f32 {
        let before: f32 = self.widths[..column].iter().sum();
        self.gap.mul_add(column as f32, before)
    }

    fn line(&self) -> f32 {
        1.45 * self.size
    }

    fn head_height(&self) -> f32 {
        let lines = if self.groups.is_empty() { 1.0 } else { 2.0 };
        self.line().mul_add(lines, 10.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Section;

    const SVG: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 760 400\">\
        <rect x=\"10\" y=\"20\" width=\"30\" height=\"40\" style=\"fill:var(--chromatic)\"/></svg>";

    fn document(n_rows: usize) -> Document {
        let mut table = Table::new("A <i>table</i>", &["level", "η²<sub>p</sub>"]);
        for row in 0..n_rows {
            table.row(&[format!("row {row}"), ".93".to_owned()]);
        }
        let figure = Block::Figure {
            svg: SVG.to_owned(),
            file: "figure".to_owned(),
            caption: "A caption".to_owned(),
        };
        Document {
            study: "s".to_owned(),
            title: "T &amp; ü".to_owned(),
            bylines: vec!["1 &lt; 2".to_owned()],
            sections: vec![
                Section::new("One")
                    .paragraph("word ".repeat(300))
                    .table(table),
                Section::new("Two").block(figure),
            ],
        }
    }

    /// Every object of the file by its number, its stream unpacked.
    fn objects(pdf: &[u8]) -> Vec<String> {
        use std::io::Read as _;

        let text = String::from_utf8_lossy(pdf);
        let start = text.trim_end().lines().rev().nth(1).unwrap();
        let start: usize = start.parse().unwrap();
        let table = String::from_utf8_lossy(&pdf[start..]).into_owned();
        let places = table
            .lines()
            .skip(3)
            .take_while(|line| line.ends_with(" n "));
        let places: Vec<usize> = places.map(|line| line[..10].parse().unwrap()).collect();
        let object = |(index, &place): (usize, &usize)| {
            let end = places.get(index + 1).copied().unwrap_or(start);
            let bytes = &pdf[place..end];
            let number = format!("{} 0 obj\n", index + 1);
            assert!(bytes.starts_with(number.as_bytes()), "{number}");
            let mark = b"/FlateDecode ";
            if !bytes.windows(mark.len()).any(|part| part == mark) {
                return String::from_utf8(bytes.to_vec()).unwrap();
            }
            let mark = b">>\nstream\n";
            let from = bytes.windows(mark.len()).position(|part| part == mark);
            let mut unpacked = Vec::new();
            let stream = &bytes[from.unwrap() + mark.len()..];
            flate2::read::ZlibDecoder::new(stream)
                .read_to_end(&mut unpacked)
                .unwrap();
            String::from_utf8_lossy(&unpacked).into_owned()
        };
        places.iter().enumerate().map(object).collect()
    }

    #[test]
    fn every_row_is_on_a_page_and_the_head_on_each() {
        let pdf = document(150).to_pdf().unwrap();
        let objects = objects(&pdf);
        let pages: Vec<&String> = objects.iter().filter(|text| text.contains("BT ")).collect();
        // 150 rows of 1.45 times 8 points are 1740 points, and a page has 724.
        assert!((3..=5).contains(&pages.len()), "{}", pages.len());
        let count = format!("/Count {}", pages.len());
        assert!(objects[1].contains(&count), "{}", objects[1]);
        // Every cell is one piece of text: the widths of the used glyphs and their letters stand in the file.
        let unicode = objects.iter().find(|text| text.contains("beginbfchar"));
        for sign in ["<0077>", "<03B7>", "<0026>", "<00FC>"] {
            assert!(unicode.unwrap().contains(sign), "{sign}");
        }
        // The figure's colour is that of paper: #c64b00.
        let orange = format!("{} {} 0 rg", 198.0_f32 / 255.0, 75.0_f32 / 255.0);
        assert!(pages.iter().any(|page| page.contains(&orange)));
        // The title as UTF-16.
        assert!(objects[3].contains("<FEFF0054002000260020 00FC>".replace(' ', "").as_str()));
        assert_eq!(document(150).to_pdf().unwrap(), pdf);
    }

    #[test]
    fn nothing_is_set_below_the_margin() {
        let pdf = document(150).to_pdf().unwrap();
        let mut n_texts = 0;
        for page in objects(&pdf).iter().filter(|text| text.contains("BT ")) {
            for line in page.lines().filter(|line| line.ends_with(" Tj")) {
                let fields: Vec<&str> = line.split(' ').collect();
                let place = fields.iter().position(|&field| field == "Tm").unwrap();
                let [x, y] = [2, 1].map(|back| fields[place - back].parse::<f32>().unwrap());
                let is_footer = (y - 34.0).abs() < 3.0;
                assert!(is_footer || y > BOTTOM - 5.0, "{line}");
                assert!((MARGIN - 1.0..PAGE[0] - MARGIN).contains(&x), "{line}");
                n_texts += 1;
            }
        }
        // 300 words, 150 rows of at least two cells.
        assert!(n_texts > 600, "{n_texts}");
    }
}
