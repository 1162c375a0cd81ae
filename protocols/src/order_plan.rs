//! The part of a protocol that says which orders of trials are allowed.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

/// Which orders of the test trials are allowed, and what is balanced across subjects.
///
/// Without `[session.order]` every order is allowed in which no image comes twice running.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OrderPlan {
    /// How an order comes about.
    pub scheme: OrderScheme,
    /// At least so many other trials between two showings of one image.
    pub repeat_gap: u32,
    /// How often each anchor is rated besides, in each block; its showings are spread over the block.
    pub anchor_repeats: u32,
    /// Limits to runs of one level.
    pub most_in_a_row: Vec<RunLimit>,
    /// Images of one level together, and the order of the levels balanced across subjects.
    pub blocked_by: Option<LevelBlocks>,
}

/// How an order comes about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OrderScheme {
    /// Each allowed order is as likely, for each subject anew.
    #[default]
    Shuffled,
    /// The subject's number says which row of a balanced Latin square of the images is shown: over all
    /// rows each image stands in each place, and follows each other image, equally often.
    LatinSquare,
}

/// At most so many trials in a row with one level of a factor.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunLimit {
    /// The factor.
    pub factor: String,
    /// How many in a row at most.
    pub most: u32,
}

/// Images of one level are shown together; the subject's number says in which order the levels come.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelBlocks {
    /// The factor.
    pub factor: String,
    /// The levels. An image with another level falls into one of these blocks by lot.
    pub levels: Vec<String>,
}

impl Default for OrderPlan {
    fn default() -> Self {
        Self {
            scheme: OrderScheme::Shuffled,
            repeat_gap: 1,
            anchor_repeats: 0,
            most_in_a_row: Vec::new(),
            blocked_by: None,
        }
    }
}

impl OrderPlan {
    /// Whether the order depends on the number at the end of the subject's code.
    pub fn is_counterbalanced(&self) -> bool {
        self.scheme == OrderScheme::LatinSquare || self.blocked_by.is_some()
    }

    pub(crate) fn fault(&self) -> Option<(&'static str, String, &'static str)> {
        if self.anchor_repeats > 20 {
            let expected = "a number from 0 to 20";
            return Some((
                "session.order.anchor_repeats",
                self.anchor_repeats.to_string(),
                expected,
            ));
        }
        if let Some(limit) = self
            .most_in_a_row
            .iter()
            .find(|limit| !(1..=100).contains(&limit.most))
        {
            let expected = "at most 1 to 100 in a row";
            return Some((
                "session.order.most_in_a_row",
                format!("most = {}", limit.most),
                expected,
            ));
        }
        let has_other_wishes =
            !self.most_in_a_row.is_empty() || self.blocked_by.is_some() || self.anchor_repeats > 0;
        if self.scheme == OrderScheme::LatinSquare && has_other_wishes {
            let expected =
                "no most_in_a_row, blocked_by or anchor_repeats: the square fixes the order";
            return Some((
                "session.order.scheme",
                "\"latin-square\" beside other wishes".to_owned(),
                expected,
            ));
        }
        let levels = self.blocked_by.as_ref().map(|blocks| &blocks.levels)?;
        let distinct: BTreeSet<&String> = levels.iter().collect();
        (levels.len() < 2 || distinct.len() < levels.len()).then(|| {
            (
                "session.order.blocked_by.levels",
                format!("{levels:?}"),
                "two or more different levels",
            )
        })
    }
}
