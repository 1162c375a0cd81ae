//! What it saves to refine no channel beyond what can be seen, and what is seen of it.

use std::fmt;

use renderer::RayAccount;

/// A piece of work and the CPU time that it took.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Timed<T> {
    pub(crate) outcome: T,
    pub(crate) cpu_s: f64,
}

impl<T> Timed<T> {
    pub(crate) fn map<U>(&self, part: impl FnOnce(&T) -> U) -> Timed<U> {
        Timed {
            outcome: part(&self.outcome),
            cpu_s: self.cpu_s,
        }
    }
}

/// One image with acuity control and without.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AcuityComparison {
    pub(crate) limited: Timed<RayAccount>,
    pub(crate) whole: Timed<RayAccount>,
    /// `ColorVideoVDP`: 10 for no visible difference.
    pub(crate) jod: f64,
    pub(crate) pixels_per_degree: f64,
}

impl fmt::Display for AcuityComparison {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (limited, whole) = (&self.limited.outcome, &self.whole.outcome);
        let counts = [
            ("rays", limited.intersections, whole.intersections),
            ("shadings of A", limited.shadings.a, whole.shadings.a),
            ("shadings of C1", limited.shadings.c1, whole.shadings.c1),
            ("shadings of C2", limited.shadings.c2, whole.shadings.c2),
            (
                "all shadings",
                limited.total_shadings(),
                whole.total_shadings(),
            ),
        ];
        writeln!(
            formatter,
            "\n{:<16}{:>14}{:>14}{:>9}",
            "", "with acuity", "without", "saved"
        )?;
        for (name, with, without) in counts {
            let saved = saved_percent(with as f64, without as f64);
            writeln!(formatter, "{name:<16}{with:>14}{without:>14}{saved:>8.1}%")?;
        }
        let (with, without) = (self.limited.cpu_s, self.whole.cpu_s);
        let saved = saved_percent(with, without);
        writeln!(
            formatter,
            "{:<16}{with:>14.2}{without:>14.2}{saved:>8.1}%",
            "CPU seconds"
        )?;
        write!(
            formatter,
            "\nquality beside the image without: {:.2} JOD of 10 (ColorVideoVDP, {:.1} pixels per degree)",
            self.jod, self.pixels_per_degree
        )
    }
}

fn saved_percent(with: f64, without: f64) -> f64 {
    100.0 * (1.0 - with / without)
}

#[cfg(test)]
mod tests {
    use protocols::PerChannel;

    use super::*;

    #[test]
    fn what_is_saved_stands_in_percent_of_the_whole() {
        let account = |intersections, a, c| RayAccount {
            intersections,
            shadings: PerChannel { a, c1: c, c2: c },
        };
        let timed = |outcome, cpu_s| Timed { outcome, cpu_s };
        let comparison = AcuityComparison {
            limited: timed(account(100, 100, 25), 3.0),
            whole: timed(account(200, 200, 200), 4.0),
            jod: 9.876,
            pixels_per_degree: 52.6,
        };
        let printed = comparison.to_string();
        let line = |name: &str| {
            let line = printed.lines().find(|line| line.starts_with(name)).unwrap();
            line.split_whitespace().last().unwrap().to_owned()
        };
        assert_eq!(line("rays"), "50.0%");
        assert_eq!(line("shadings of C2"), "87.5%");
        // 150 of 600.
        assert_eq!(line("all shadings"), "75.0%");
        assert_eq!(line("CPU seconds"), "25.0%");
        assert!(printed.contains("9.88 JOD"));
    }
}
