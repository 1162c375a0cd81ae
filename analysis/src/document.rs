//! A report as a document: sections of paragraphs, lists, tables and figures, which every format is written from.
//!
//! Text is *rich text*: HTML with no tags but `i`, `em`, `b`, `strong`, `sub`, `sup` and `code`, and with `&lt;`, `&gt;`,
//! `&amp;` and `&quot;`.
//!
//! Not here: the formats (`page` for HTML, `markdown`, `latex`).

/// A whole report.
#[derive(Clone, Debug)]
pub(crate) struct Document {
    /// The name of the study.
    pub(crate) study: String,
    /// The title.
    pub(crate) title: String,
    /// The lines below the title.
    pub(crate) bylines: Vec<String>,
    pub(crate) sections: Vec<Section>,
}

/// A part of a report; without a heading it belongs to what stands above.
#[derive(Clone, Debug)]
pub(crate) struct Section {
    pub(crate) heading: Option<&'static str>,
    pub(crate) blocks: Vec<Block>,
}

/// How a paragraph or list is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Style {
    /// As running text.
    Plain,
    /// As what the reader must not miss.
    Result,
    /// As a warning that stands apart.
    Banner,
    /// As a remark.
    Note,
}

/// One thing in a section.
#[derive(Clone, Debug)]
pub(crate) enum Block {
    Paragraph(Style, String),
    List(Style, Vec<String>),
    /// Terms and what they are.
    Terms(Vec<(&'static str, String)>),
    Table(Table),
    Figure {
        /// The figure in the colours of the page.
        svg: String,
        /// The file of the figure beside the page.
        file: String,
        caption: String,
    },
    /// Figures beside each other where there is room, else below each other.
    Beside(Vec<Self>),
}

impl Document {
    /// Puts a section before the last one, which says where all comes from.
    pub(crate) fn add_before_last(&mut self, section: Section) {
        let place = self.sections.len().saturating_sub(1);
        self.sections.insert(place, section);
    }
}

impl Section {
    pub(crate) const fn new(heading: &'static str) -> Self {
        Self {
            heading: Some(heading),
            blocks: Vec::new(),
        }
    }

    pub(crate) const fn without_heading() -> Self {
        Self {
            heading: None,
            blocks: Vec::new(),
        }
    }

    pub(crate) fn block(mut self, block: Block) -> Self {
        self.blocks.push(block);
        self
    }

    pub(crate) fn paragraph(self, text: impl Into<String>) -> Self {
        self.block(Block::Paragraph(Style::Plain, text.into()))
    }

    /// A paragraph for each text.
    pub(crate) fn paragraphs(mut self, style: Style, texts: Vec<String>) -> Self {
        let paragraphs = texts.into_iter().map(|text| Block::Paragraph(style, text));
        self.blocks.extend(paragraphs);
        self
    }

    pub(crate) fn note(self, text: impl Into<String>) -> Self {
        self.block(Block::Paragraph(Style::Note, text.into()))
    }

    /// A list; without items there is none.
    pub(crate) fn list(self, style: Style, items: Vec<String>) -> Self {
        if items.is_empty() {
            return self;
        }
        self.block(Block::List(style, items))
    }

    pub(crate) fn table(self, table: Table) -> Self {
        self.block(Block::Table(table))
    }
}

/// A table; its cells are rich text.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    pub(crate) caption: String,
    pub(crate) columns: Vec<String>,
    /// Headings above the columns, each with the number of columns that it spans; empty for none.
    pub(crate) groups: Vec<(String, usize)>,
    pub(crate) rows: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn new(caption: &str, columns: &[&str]) -> Self {
        Self {
            caption: caption.to_owned(),
            columns: columns.iter().map(|&column| column.to_owned()).collect(),
            groups: Vec::new(),
            rows: Vec::new(),
        }
    }

    /// Puts a line of group headings above the header: each with the number of columns that it spans.
    pub(crate) fn grouped(mut self, groups: &[(&str, usize)]) -> Self {
        self.groups = (groups.iter())
            .map(|&(text, span)| (text.to_owned(), span))
            .collect();
        self
    }

    pub(crate) fn row(&mut self, cells: &[String]) {
        self.rows.push(cells.to_vec());
    }
}

/// What `text_of` makes of each item, one after the other.
pub(crate) fn joined<T>(
    items: impl IntoIterator<Item = T>,
    text_of: impl Fn(T) -> String,
) -> String {
    let texts = items.into_iter().map(text_of);
    texts.fold(String::new(), |all, text| all + &text)
}
