//! The code by which a subject is known; never a name.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// A subject's code: 1 to 32 letters and digits, so that it can stand in a file name.
///
/// ```
/// use protocols::SubjectId;
/// assert!("01".parse::<SubjectId>().is_ok());
/// assert!("../01".parse::<SubjectId>().is_err());
/// ```
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct SubjectId(String);

impl SubjectId {
    /// The code.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The number at the end of the code, by which orders are balanced across subjects.
    ///
    /// ```
    /// let number = |code: &str| code.parse::<protocols::SubjectId>().unwrap().number();
    /// assert_eq!((number("07"), number("A12"), number("AB")), (Some(7), Some(12), None));
    /// ```
    pub fn number(&self) -> Option<u32> {
        let start = self
            .0
            .trim_end_matches(|digit: char| digit.is_ascii_digit());
        self.0[start.len()..].parse().ok()
    }
}

impl FromStr for SubjectId {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let is_plain = text.bytes().all(|byte| byte.is_ascii_alphanumeric());
        if is_plain && (1..=32).contains(&text.len()) {
            Ok(Self(text.to_owned()))
        } else {
            Err(format!(
                "found the subject id {text:?}, expected 1 to 32 letters A-Z, a-z and digits 0-9, and no name"
            ))
        }
    }
}

impl TryFrom<String> for SubjectId {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<SubjectId> for String {
    fn from(id: SubjectId) -> Self {
        id.0
    }
}

impl fmt::Display for SubjectId {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_that_could_leave_their_folder_or_break_a_column_are_refused() {
        let long = "a".repeat(33);
        for text in [
            "",
            "a b",
            "a/b",
            "a_b",
            "a-b",
            "a,b",
            "é",
            ".",
            long.as_str(),
        ] {
            assert!(text.parse::<SubjectId>().is_err(), "{text:?} was taken");
        }
        assert!("a".repeat(32).parse::<SubjectId>().is_ok());
    }
}
