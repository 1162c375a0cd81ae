//! Ratings that models of vision predicted, from the file that `acuity predict` writes, beside those that were given.

use std::collections::BTreeMap;
use std::path::Path;

use protocols::{InputError, ReadError, StimulusId};

use crate::AnalysisError;
use crate::interval::mean;
use crate::screening::correlation;

/// The models, and the columns of their predictions.
const MODELS: [(&str, &str); 2] = [
    ("ColorVideoVDP", "cvvdp_rating"),
    ("S-CIELAB", "scielab_rating"),
];

/// What the models predicted.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Predictions {
    /// The digest of the manifest of the images that were judged.
    pub(crate) manifest_sha256: String,
    pub(crate) models: Vec<ModelPrediction>,
}

/// What one model predicted.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ModelPrediction {
    pub(crate) model: &'static str,
    pub(crate) ratings: BTreeMap<StimulusId, f64>,
}

/// How well a model's predictions agree with the mean ratings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Agreement {
    /// How many images have both.
    pub(crate) n: usize,
    /// Pearson's correlation; `None` without variance.
    pub(crate) correlation: Option<f64>,
    /// The root mean square difference, in steps of the scale.
    pub(crate) rms: f64,
    /// The mean prediction less the mean rating.
    pub(crate) bias: f64,
}

impl Predictions {
    /// Reads the file of `acuity predict`.
    ///
    /// # Errors
    ///
    /// A file that is missing or malformed, a column that is not there, a prediction that is no number.
    pub(crate) fn read(path: &Path) -> Result<Self, AnalysisError> {
        let kind = "the predictions of `acuity predict` (CSV)";
        let bytes = std::fs::read(path).map_err(|error| ReadError::from_io(path, kind, error))?;
        let mut reader = csv::Reader::from_reader(bytes.as_slice());
        let malformed = |error: csv::Error| InputError::new(path, error.to_string(), kind);
        let header = reader.headers().map_err(malformed)?.clone();
        let place_of = |name: &str| {
            let place = header.iter().position(|column| column == name);
            place.ok_or_else(|| {
                let found = format!(
                    "the columns {}",
                    header.iter().collect::<Vec<_>>().join(", ")
                );
                InputError::new(path, found, format!("a column {name:?}")).at("line 1")
            })
        };
        let (image, manifest) = (place_of("stimulus_id")?, place_of("manifest_sha256")?);
        let places: Vec<usize> = (MODELS.iter())
            .map(|(_, column)| place_of(column))
            .collect::<Result<_, _>>()?;
        let mut predictions = Self {
            manifest_sha256: String::new(),
            models: MODELS
                .map(|(model, _)| ModelPrediction {
                    model,
                    ratings: BTreeMap::new(),
                })
                .into(),
        };
        for record in reader.records() {
            let record = record.map_err(malformed)?;
            let wrong = |column: &str, found: &str, expected: &str| {
                let line = record.position().map_or(0, csv::Position::line);
                InputError::new(path, format!("{found:?}"), expected)
                    .at(format!("line {line}, column {column}"))
            };
            let id = StimulusId::try_from(record[image].to_owned())
                .map_err(|fault| wrong("stimulus_id", &record[image], &fault))?;
            record[manifest].clone_into(&mut predictions.manifest_sha256);
            for ((model, place), (_, column)) in
                predictions.models.iter_mut().zip(&places).zip(MODELS)
            {
                let rating = record[*place]
                    .parse()
                    .ok()
                    .filter(|rating: &f64| rating.is_finite());
                let rating = rating.ok_or_else(|| wrong(column, &record[*place], "a number"))?;
                model.ratings.insert(id.clone(), rating);
            }
        }
        if predictions
            .models
            .iter()
            .all(|model| model.ratings.is_empty())
        {
            return Err(
                InputError::new(path, "no rows below the header", "a row for each image").into(),
            );
        }
        Ok(predictions)
    }
}

impl ModelPrediction {
    /// Beside the mean rating of each image; `None` where no image has both.
    pub(crate) fn agreement(&self, opinions: &BTreeMap<StimulusId, f64>) -> Option<Agreement> {
        let pairs: Vec<(f64, f64)> = (opinions.iter())
            .filter_map(|(id, &opinion)| Some((*self.ratings.get(id)?, opinion)))
            .collect();
        if pairs.is_empty() {
            return None;
        }
        let (predicted, given): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
        let differences: Vec<f64> = predicted.iter().zip(&given).map(|(p, g)| p - g).collect();
        let squares: Vec<f64> = differences
            .iter()
            .map(|difference| difference.powi(2))
            .collect();
        Some(Agreement {
            n: given.len(),
            correlation: correlation(&predicted, &given),
            rms: mean(&squares).sqrt(),
            bias: mean(&differences),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str =
        "stimulus_id,rays,cvvdp_jod,cvvdp_rating,scielab_delta_e,scielab_rating,manifest_sha256\n";

    fn read(text: &str) -> Result<Predictions, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("predictions.csv");
        std::fs::write(&path, text).unwrap();
        Predictions::read(&path).map_err(|error| {
            assert!(error.is_input(), "{error}");
            error.to_string()
        })
    }

    #[test]
    fn agreement_is_that_of_the_numbers() {
        let text = format!("{HEADER}a,1,9,2,1,3,abc\nb,2,9,4,1,5,abc\nc,3,9,6,1,7,abc\n");
        let predictions = read(&text).unwrap();
        let id = |name: &str| StimulusId::try_from(name.to_owned()).unwrap();
        let opinions = [("a", 1.0), ("b", 3.0), ("c", 8.0), ("d", 9.0)]
            .map(|(name, opinion)| (id(name), opinion));
        let found = predictions.models[0].agreement(&opinions.into()).unwrap();
        // Predicted 2, 4, 6 of 1, 3, 8: differences 1, 1, -2; r of deviations -2, 0, 2 and -3, -1, 4 is
        // 14 / sqrt(8 x 26).
        assert_eq!((found.n, found.bias), (3, 0.0));
        assert!((found.rms - 2.0_f64.sqrt()).abs() < 1e-12);
        assert!((found.correlation.unwrap() - 14.0 / 208.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(predictions.manifest_sha256, "abc");
    }

    #[test]
    fn what_cannot_be_used_is_named_with_its_place() {
        let cases = [
            (String::new(), "a column \"stimulus_id\""),
            (HEADER.to_owned(), "no rows"),
            (
                HEADER.replace("scielab_rating", "other"),
                "a column \"scielab_rating\"",
            ),
            (
                format!("{HEADER}a,1,9,two,1,3,abc\n"),
                "line 2, column cvvdp_rating",
            ),
            (
                format!("{HEADER}a,1,9,NaN,1,3,abc\n"),
                "line 2, column cvvdp_rating",
            ),
            (format!("{HEADER}a,1,9\n"), "found record with 3 fields"),
        ];
        for (text, expected) in cases {
            let message = read(&text).unwrap_err();
            assert!(message.contains(expected), "{expected}: {message}");
        }
        assert!(
            Predictions::read(Path::new("nowhere.csv"))
                .unwrap_err()
                .is_input()
        );
    }
}
