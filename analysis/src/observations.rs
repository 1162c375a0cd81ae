//! Observations in long format: who, under which levels, gave which rating.
//!
//! Not here: whether they make a design (`cell_matrix`).

use std::path::{Path, PathBuf};

use crate::label_column::LabelColumn;

/// Ratings with their subject and the level of each factor, one after another.
#[derive(Clone, Debug)]
pub struct Observations {
    source: PathBuf,
    pub(crate) subjects: LabelColumn,
    pub(crate) between: Vec<LabelColumn>,
    pub(crate) within: Vec<LabelColumn>,
    pub(crate) ratings: Vec<Option<f64>>,
    /// How many rows of the source are no ratings, by the filters.
    pub(crate) n_filtered: usize,
    /// Whether a row says that a simulated observer gave it, as our own files do.
    pub(crate) has_simulated: bool,
}

impl Observations {
    /// No observations yet; `source` is the file or folder that errors name.
    pub fn new(source: &Path, between: &[String], within: &[String]) -> Self {
        let columns = |names: &[String]| names.iter().map(|name| LabelColumn::new(name)).collect();
        Self {
            source: source.to_owned(),
            subjects: LabelColumn::new("subject"),
            between: columns(between),
            within: columns(within),
            ratings: Vec::new(),
            n_filtered: 0,
            has_simulated: false,
        }
    }

    /// Adds one rating, or a missing one. `levels` are those of the between factors, then of the within
    /// factors.
    ///
    /// # Panics
    ///
    /// If there are more or fewer levels than factors.
    pub fn push<'a>(
        &mut self,
        subject: &str,
        levels: impl IntoIterator<Item = &'a str>,
        rating: Option<f64>,
    ) {
        self.subjects.push(subject);
        let mut levels = levels.into_iter();
        for column in self.between.iter_mut().chain(&mut self.within) {
            let level = levels.next();
            assert!(level.is_some(), "a level for each factor");
            column.push(level.unwrap_or_default());
        }
        assert!(levels.next().is_none(), "a factor for each level");
        self.ratings.push(rating);
    }

    /// The file or folder that they come from.
    pub fn source(&self) -> &Path {
        &self.source
    }

    /// How many there are, missing ones included.
    pub fn len(&self) -> usize {
        self.ratings.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ratings.is_empty()
    }
}
