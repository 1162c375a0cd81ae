//! Which designs a printed F value allows: what its degrees of freedom say of subjects, levels and groups.
//!
//! With *p* contrasts of the within factors, *d* degrees of freedom of the groups' term, *n* subjects in *g*
//! groups: df = p d and p (n − g).

use std::fmt;
use std::fmt::Write as _;
use std::path::Path;
use std::str::FromStr;

use protocols::InputError;
use serde::Serialize;

/// An F value as it is printed: its degrees of freedom, and the value where one stands beside.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PrintedF {
    /// Degrees of freedom of the numerator.
    pub df_num: u32,
    /// Degrees of freedom of the denominator.
    pub df_den: u32,
    /// The F value.
    pub f: Option<f64>,
}

/// One design that gives these degrees of freedom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct AllowedDesign {
    /// Contrasts of the within factors that the effect holds; 1 with `holds_groups` may be an effect of groups
    /// alone.
    pub n_contrasts: u32,
    /// Degrees of freedom of the groups' term; 1 where the effect holds no between factor, or one of two levels.
    pub df_groups: u32,
    /// Whether the effect holds a between factor.
    pub holds_groups: bool,
    /// In how many groups the subjects are.
    pub n_groups: u32,
    /// How many subjects.
    pub n_subjects: u32,
}

/// More groups than this are not listed, unless the effect needs them.
const MOST_GROUPS: u32 = 4;

impl FromStr for PrintedF {
    type Err = InputError;

    /// Reads `F(12, 120)` or `F(12,120) = 51.44`.
    fn from_str(text: &str) -> Result<Self, InputError> {
        let parse = || -> Option<Self> {
            let rest = text
                .trim()
                .trim_start_matches(['F', 'f'])
                .trim()
                .strip_prefix('(')?;
            let (inside, after) = rest.split_once(')')?;
            let (num, den) = inside.split_once([',', ';'])?;
            let after = after.trim().trim_start_matches('=').trim();
            let whole = |text: &str| text.trim().parse().ok().filter(|&df: &u32| df > 0);
            Some(Self {
                df_num: whole(num)?,
                df_den: whole(den)?,
                f: match after {
                    "" => None,
                    value => Some(
                        value
                            .parse()
                            .ok()
                            .filter(|&f: &f64| f >= 0.0 && f.is_finite())?,
                    ),
                },
            })
        };
        parse().ok_or_else(|| {
            InputError::new(
                Path::new("--explain"),
                format!("{text:?}"),
                "whole degrees of freedom, such as \"F(12,120)\" or \"F(12,120)=51.44\"",
            )
            .remedy("corrected degrees of freedom are the whole ones times epsilon: give the whole ones")
        })
    }
}

impl PrintedF {
    /// Every design with up to four groups, or as many as the effect needs.
    pub fn designs(self) -> Vec<AllowedDesign> {
        let mut designs = Vec::new();
        let divides = |p: &u32| self.df_num.is_multiple_of(*p) && self.df_den.is_multiple_of(*p);
        for n_contrasts in (1..=self.df_num).rev().filter(divides) {
            let df_groups = self.df_num / n_contrasts;
            let df_error = self.df_den / n_contrasts;
            // An effect within subjects only: any number of groups. One of groups: as many as its levels, or a
            // multiple where another factor divides the subjects too.
            let is_within = df_groups == 1 && (n_contrasts > 1 || self.df_num == 1);
            let without = (1..=MOST_GROUPS).filter(|_| is_within);
            let with = (1..=MOST_GROUPS.max(df_groups + 1))
                .filter(|n_groups| n_groups.is_multiple_of(df_groups + 1));
            let all = without.map(|n_groups| (false, n_groups));
            for (holds_groups, n_groups) in all.chain(with.map(|n_groups| (true, n_groups))) {
                designs.push(AllowedDesign {
                    n_contrasts,
                    df_groups,
                    holds_groups,
                    n_groups,
                    n_subjects: df_error + n_groups,
                });
            }
        }
        designs
    }

    /// The designs as JSON, with a line end.
    pub fn to_json(self) -> String {
        // A list of numbers cannot fail to be written.
        let mut json = serde_json::to_string_pretty(&self.designs()).unwrap_or_default();
        json.push('\n');
        json
    }

    /// What it allows, as text for a terminal.
    pub fn explained(self) -> String {
        let mut text = format!("{self} allows:\n");
        for design in self.designs() {
            // Writing to a `String` cannot fail, here and below.
            _ = writeln!(text, "- {design}");
        }
        if let Some(f) = self.f {
            let (num, den) = (f64::from(self.df_num), f64::from(self.df_den));
            let pes = f * num / (f * num + den);
            _ = writeln!(
                text,
                "Uncorrected: p = {:.3e}, partial eta squared {pes:.3}. At the lower bound of epsilon, 1/{}: p = {:.3e}.",
                crate::f_tail(f, num, den),
                self.df_num,
                crate::f_tail(f, 1.0, den / num)
            );
        }
        text
    }
}

impl fmt::Display for PrintedF {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "F({}, {})", self.df_num, self.df_den)?;
        self.f.map_or(Ok(()), |f| write!(formatter, " = {f}"))
    }
}

impl AllowedDesign {
    /// The within factors of the effect: `13 levels`, or as an interaction `3 x 7 levels`.
    fn levels(&self) -> String {
        let p = self.n_contrasts;
        let pairs: Vec<String> = (2..=p)
            .filter(|a| p.is_multiple_of(*a) && a * a <= p)
            .map(|a| format!("{} x {}", a + 1, p / a + 1))
            .collect();
        let with_two = format!("2 x {}", p + 1);
        let interactions = std::iter::once(with_two).chain(pairs);
        let interactions: Vec<String> = interactions.collect();
        format!(
            "a within factor of {} levels (or an interaction of {})",
            p + 1,
            interactions.join(", ")
        )
    }
}

impl fmt::Display for AllowedDesign {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let groups = match self.n_groups {
            1 => "in one group".to_owned(),
            n => format!("in {n} groups"),
        };
        let group_levels = self.df_groups + 1;
        let effect = match (self.holds_groups, self.n_contrasts) {
            (false, _) => self.levels(),
            (true, 1) => {
                format!("a between factor of {group_levels} levels (or with a within factor of 2)")
            }
            (true, _) => format!(
                "{} with a between factor of {group_levels} levels",
                self.levels()
            ),
        };
        write!(formatter, "{} subjects {groups}: {effect}", self.n_subjects)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn designs(text: &str) -> Vec<(u32, u32, bool)> {
        let printed: PrintedF = text.parse().unwrap();
        (printed.designs().iter())
            .map(|design| (design.n_subjects, design.n_groups, design.holds_groups))
            .collect()
    }

    #[test]
    fn the_papers_degrees_of_freedom_are_eleven_subjects_or_twelve_in_two_groups() {
        // Meyer & Liu (1992), section 3.4, and the reading of the reference set paper_reported.json.
        for text in ["F(12,120)=51.44", "F(1, 10) = 24.03"] {
            let found = designs(text);
            assert!(found.contains(&(11, 1, false)), "{text}: {found:?}");
            assert!(found.contains(&(12, 2, false)), "{text}: {found:?}");
            assert!(found.contains(&(12, 2, true)), "{text}: {found:?}");
        }
    }

    #[test]
    fn every_design_gives_back_its_degrees_of_freedom() {
        for (df_num, df_den) in [(12, 120), (1, 10), (2, 34), (6, 66), (3, 441), (7, 13)] {
            let printed = PrintedF {
                df_num,
                df_den,
                f: None,
            };
            let all = printed.designs();
            assert!(!all.is_empty());
            for one in all {
                assert_eq!(one.n_contrasts * one.df_groups, df_num);
                assert_eq!(one.n_contrasts * (one.n_subjects - one.n_groups), df_den);
            }
        }
    }

    #[test]
    fn what_is_no_f_value_is_refused() {
        for text in [
            "",
            "F",
            "F(12)",
            "F(3.1,31.4)",
            "F(0,3)",
            "F(1,2)=x",
            "t(10)=3",
        ] {
            let error = text.parse::<PrintedF>().unwrap_err().to_string();
            assert!(error.contains("F(12,120)"), "{error}");
        }
    }
}
