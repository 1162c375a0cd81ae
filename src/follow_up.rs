//! Follow-ups as words of the command line: `rays@channel`, `rays=130K`, `rays:3`, `rays:10K=-1,130K=1`.

use protocols::FollowUpPlan;

pub(crate) fn simple(text: &str) -> Result<FollowUpPlan, String> {
    match place(text) {
        (factor, Some(at)) => Ok(FollowUpPlan::SimpleEffects { factor, at }),
        (_, None) => Err(expected(text, "FACTOR@FACTOR, such as channel@rays")),
    }
}

pub(crate) fn pairwise(text: &str) -> Result<FollowUpPlan, String> {
    match place(text) {
        (factor, at) if !factor.is_empty() => Ok(FollowUpPlan::Pairwise { factor, at }),
        _ => Err(expected(
            text,
            "FACTOR or FACTOR@FACTOR, such as rays@channel",
        )),
    }
}

pub(crate) fn control(text: &str) -> Result<FollowUpPlan, String> {
    let (factor, control) = text
        .split_once('=')
        .ok_or_else(|| expected(text, "FACTOR=LEVEL, such as rays=130K"))?;
    Ok(FollowUpPlan::AgainstControl {
        factor: factor.to_owned(),
        control: control.to_owned(),
        at: None,
    })
}

pub(crate) fn trends(text: &str) -> Result<FollowUpPlan, String> {
    let (factor, degrees) = match text.rsplit_once(':') {
        None => (text, None),
        Some((factor, degrees)) => {
            let degrees = degrees.parse().ok();
            let degrees = degrees.ok_or_else(|| expected(text, "FACTOR:DEGREE, such as rays:2"))?;
            (factor, Some(degrees))
        }
    };
    Ok(FollowUpPlan::Trends {
        factor: factor.to_owned(),
        degrees,
    })
}

pub(crate) fn contrast(text: &str) -> Result<FollowUpPlan, String> {
    let parse = || {
        let (factor, list) = text.split_once(':')?;
        let weights = list.split(',').map(|part| {
            let (level, weight) = part.split_once('=')?;
            Some((level.trim().to_owned(), weight.trim().parse().ok()?))
        });
        Some(FollowUpPlan::Contrast {
            name: list.to_owned(),
            factor: factor.to_owned(),
            weights: weights.collect::<Option<_>>()?,
            at: None,
        })
    };
    parse().ok_or_else(|| expected(text, "FACTOR:LEVEL=WEIGHT,..., such as rays:10K=-1,130K=1"))
}

/// `FACTOR` or `FACTOR@FACTOR`.
pub(crate) fn place(text: &str) -> (String, Option<String>) {
    match text.split_once('@') {
        Some((factor, at)) => (factor.to_owned(), Some(at.to_owned())),
        None => (text.to_owned(), None),
    }
}

fn expected(found: &str, expected: &str) -> String {
    format!("found {found:?}, expected {expected}")
}
