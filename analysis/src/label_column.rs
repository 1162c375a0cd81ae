//! One column of labels: each distinct label once, and a code for each row.

use std::collections::HashMap;

use crate::natural_order;

/// A column of labels, coded.
#[derive(Clone, Debug, Default)]
pub(crate) struct LabelColumn {
    /// What the column is called.
    pub(crate) name: String,
    labels: Vec<String>,
    code_of_label: HashMap<String, usize>,
    codes: Vec<usize>,
}

impl LabelColumn {
    pub(crate) fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            ..Self::default()
        }
    }

    pub(crate) fn push(&mut self, label: &str) {
        let code = self.code_of_label.get(label).copied().unwrap_or_else(|| {
            let code = self.labels.len();
            self.labels.push(label.to_owned());
            self.code_of_label.insert(label.to_owned(), code);
            code
        });
        self.codes.push(code);
    }

    /// The distinct labels in natural order, and for each row the place of its label among them.
    pub(crate) fn ordered(&self) -> (Vec<String>, Vec<usize>) {
        let mut order: Vec<usize> = (0..self.labels.len()).collect();
        order.sort_by(|&left, &right| natural_order(&self.labels[left], &self.labels[right]));
        let mut place = vec![0; order.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old] = new;
        }
        let labels = order.iter().map(|&old| self.labels[old].clone()).collect();
        (labels, self.codes.iter().map(|&old| place[old]).collect())
    }
}
