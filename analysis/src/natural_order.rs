//! The order in which people write levels: 10K before 100K, b2 before b10.

use std::cmp::Ordering;

/// Compares two labels: as numbers where both are, else runs of digits by value and all else by character.
///
/// Labels that differ never compare equal.
///
/// ```
/// let mut rays = ["100K", "10K", "20K"];
/// rays.sort_by(|left, right| analysis::natural_order(left, right));
/// assert_eq!(rays, ["10K", "20K", "100K"]);
/// ```
pub fn natural_order(left: &str, right: &str) -> Ordering {
    let by_value = match (left.parse::<f64>(), right.parse::<f64>()) {
        (Ok(left), Ok(right)) => left.total_cmp(&right),
        _ => by_runs(left, right),
    };
    by_value.then_with(|| left.cmp(right))
}

fn by_runs(left: &str, right: &str) -> Ordering {
    let (mut left, mut right) = (left, right);
    loop {
        let (left_run, left_rest) = first_run(left);
        let (right_run, right_rest) = first_run(right);
        let order = match (is_number(left_run), is_number(right_run)) {
            (true, true) => by_digits(left_run, right_run),
            _ => left_run.cmp(right_run),
        };
        if order != Ordering::Equal || left_run.is_empty() {
            return order;
        }
        (left, right) = (left_rest, right_rest);
    }
}

/// The longest start of `text` that is all digits or has none.
fn first_run(text: &str) -> (&str, &str) {
    let starts_with_digit = is_number(text);
    let end = text
        .find(|letter: char| letter.is_ascii_digit() != starts_with_digit)
        .unwrap_or(text.len());
    text.split_at(end)
}

fn is_number(run: &str) -> bool {
    run.starts_with(|letter: char| letter.is_ascii_digit())
}

/// Digits of any length, by value.
fn by_digits(left: &str, right: &str) -> Ordering {
    let left = left.trim_start_matches('0');
    let right = right.trim_start_matches('0');
    left.len().cmp(&right.len()).then_with(|| left.cmp(right))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_stand_as_people_write_them() {
        let sorted = [
            "-1.5", "0", "0.5", "2", "10", "10K", "20K", "100K", "S1", "S2", "S10", "naïve",
        ];
        let mut labels = sorted.to_vec();
        labels.reverse();
        labels.sort_by(|left, right| natural_order(left, right));
        assert_eq!(labels, sorted);
    }

    #[test]
    fn labels_that_differ_never_compare_equal() {
        assert_ne!(natural_order("01", "1"), Ordering::Equal);
        assert_ne!(natural_order("a01", "a1"), Ordering::Equal);
        assert_eq!(natural_order("a1", "a1"), Ordering::Equal);
    }
}
