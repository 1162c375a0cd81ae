//! Nothing that ends in a picture may depend on the machine: the sources are searched for what would.
//!
//! The standard library's `sin`, `exp`, `powf` ... call the platform's C library, whose last bits differ;
//! `libm` and the exact `sqrt`, `floor`, `abs` ... do not. A fused `mul_add` is fused on some machines only
//! by a library call, and the order of a hash map changes from run to run. Tests may use all of them.

use std::fs;
use std::path::{Path, PathBuf};

/// Functions of `f32` and `f64` whose bits the standard library does not promise.
const INEXACT: [&str; 27] = [
    "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sin_cos", "sinh", "cosh", "tanh",
    "asinh", "acosh", "atanh", "exp", "exp2", "exp_m1", "ln", "ln_1p", "log", "log2", "log10",
    "powf", "powi", "cbrt", "hypot", "mul_add",
];

/// Files whose numbers end in no stimulus, with the reason.
const EXEMPT: [(&str, &str); 4] = [
    ("spectra/colour_difference.rs", "only tests use it"),
    ("geometry/mesh/tests.rs", "tests"),
    (
        "channel_image.rs",
        "the rms difference is for people and benchmarks",
    ),
    (
        "estimate.rs",
        "means and variances of nodes are for people; squares",
    ),
];

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The lines of a source before its module of tests, without comments.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let opens_tests = |(start, mark): &(usize, &str)| {
        let next = text[start + mark.len()..]
            .lines()
            .next()
            .unwrap_or_default();
        next.contains("mod ") && next.ends_with('{')
    };
    let tests = text.match_indices("#[cfg(test)]\n").find(opens_tests);
    let before_tests = &text[..tests.map_or(text.len(), |(start, _)| start)];
    let lines = (1..).zip(before_tests.lines());
    lines.map(|(number, line)| (number, line.split("//").next().unwrap()))
}

/// What in a line would make a picture depend on the machine.
fn fault(line: &str) -> Option<String> {
    let is_call = |name: &&&str| {
        [
            format!(".{name}("),
            format!("f64::{name}"),
            format!("f32::{name}"),
        ]
        .iter()
        .any(|call| {
            line.match_indices(call.as_str()).any(|(start, _)| {
                let after = line[start + call.len()..].chars().next();
                call.ends_with('(') || !after.is_some_and(|c| c.is_alphanumeric() || c == '_')
            })
        })
    };
    let function = INEXACT
        .iter()
        .find(is_call)
        .map(|name| format!("{name} of the platform"));
    let hashed = ["HashMap", "HashSet"]
        .iter()
        .find(|kind| line.contains(**kind));
    function.or(hashed.map(|kind| format!("{kind}, whose order changes")))
}

#[test]
fn no_picture_depends_on_the_platforms_mathematics_or_on_hash_order() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut faults = Vec::new();
    for folder in [root.join("src"), root.join("../protocols/src")] {
        for path in sources(&folder) {
            let name = path.strip_prefix(&folder).unwrap().to_str().unwrap();
            if EXEMPT.iter().any(|(exempt, _)| *exempt == name) || name.starts_with("figures/") {
                continue;
            }
            let text = fs::read_to_string(&path).unwrap();
            for (number, line) in lines(&text) {
                if let Some(fault) = fault(line) {
                    faults.push(format!(
                        "{}:{number}: {fault}: {}",
                        path.display(),
                        line.trim()
                    ));
                }
            }
        }
    }
    assert!(faults.is_empty(), "use libm:\n{}", faults.join("\n"));
}

#[test]
fn the_search_finds_what_it_should() {
    for line in [
        "let y = x.sin();",
        "f64::hypot(a, b)",
        "values.map(f64::exp)",
        "HashMap<u32, f64>",
    ] {
        assert!(fault(line).is_some(), "{line}");
    }
    for line in ["libm::sin(x)", "x.sqrt()", "f64::exponent(x)", "a.powers()"] {
        assert!(fault(line).is_none(), "{line}");
    }
}
