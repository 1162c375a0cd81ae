//! The table of own pictures: one line for each, with the level of every factor (CSV).
//!
//! The column `image` names the file. `reference`, if there is such a column, names the undisturbed picture
//! that simulated observers compare it with. Every other column is a factor. A picture whose levels are all
//! empty is shown, as an anchor or a reference, but never rated.

use std::fs;
use std::path::{Path, PathBuf};

use crate::rating::columns;
use crate::{InputError, ReadError, Sha256Digest, StimulusId};

const IMAGE: &str = "image";
const REFERENCE: &str = "reference";
const KIND: &str = "a table of pictures (CSV) with a column `image` and a column for each factor";

/// What the table says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureTable {
    /// The file.
    pub path: PathBuf,
    /// Its digest.
    pub sha256: Sha256Digest,
    /// The factors, in the order of the columns.
    pub factors: Vec<String>,
    /// The pictures, in the order of the lines.
    pub pictures: Vec<Picture>,
}

/// One picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// The name of the file, in the folder of the pictures.
    pub file: String,
    /// The file's name without its ending.
    pub id: StimulusId,
    /// The level of each factor, in the order of the columns; all empty if it is not rated.
    pub levels: Vec<String>,
    /// The undisturbed picture.
    pub reference: Option<StimulusId>,
    /// Where it stands in the table.
    pub line: u64,
}

impl Picture {
    /// Whether it has levels, and so is rated.
    pub fn is_rated(&self) -> bool {
        self.levels.iter().any(|level| !level.is_empty())
    }
}

impl PictureTable {
    pub(crate) fn read(path: &Path) -> Result<Self, InputError> {
        let bytes =
            fs::read(path).map_err(|error| match ReadError::from_io(path, KIND, error) {
                ReadError::Input(error) => error,
                ReadError::Io { source, .. } => InputError::new(path, source.to_string(), KIND),
            })?;
        let text = std::str::from_utf8(&bytes).map_err(|error| {
            InputError::new(path, format!("bytes that are not UTF-8 ({error})"), KIND)
        })?;
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .from_reader(text.trim_start_matches('\u{feff}').as_bytes());
        let malformed = |error: csv::Error| InputError::new(path, error.to_string(), KIND);
        let header = Header::of(path, reader.headers().map_err(malformed)?)?;
        let mut pictures = Vec::new();
        for record in reader.records() {
            pictures.push(header.picture(path, &record.map_err(malformed)?)?);
        }
        let table = Self {
            path: path.to_owned(),
            sha256: Sha256Digest::of(&bytes),
            factors: header.factors.into_iter().map(|(_, name)| name).collect(),
            pictures,
        };
        match table.fault() {
            None => Ok(table),
            Some((line, found, expected)) => {
                let error = InputError::new(path, found, expected);
                Err(line.map_or(error.clone(), |line| error.at(format!("line {line}"))))
            }
        }
    }

    /// A contradiction between lines, as (line, found, expected).
    fn fault(&self) -> Option<(Option<u64>, String, &'static str)> {
        if !self.pictures.iter().any(Picture::is_rated) {
            let expected = "at least one picture with a level of every factor";
            return Some((None, "no picture to rate".to_owned(), expected));
        }
        for (place, picture) in self.pictures.iter().enumerate() {
            let mut before = self.pictures[..place].iter();
            if before.any(|other| other.id == picture.id) {
                let found = format!("the picture {:?} again", picture.file);
                return Some((Some(picture.line), found, "one line for each picture"));
            }
            if let Some(reference) = &picture.reference
                && self.pictures.iter().all(|other| other.id != *reference)
            {
                let found = format!("the reference \"{reference}\"");
                return Some((Some(picture.line), found, "an image of this table"));
            }
        }
        None
    }
}

/// Which column is what.
struct Header {
    image: usize,
    reference: Option<usize>,
    factors: Vec<(usize, String)>,
}

impl Header {
    fn of(path: &Path, names: &csv::StringRecord) -> Result<Self, InputError> {
        let wrong = |found: String, expected: &str| {
            Err(InputError::new(path, found, expected).at("line 1"))
        };
        let reserved = columns(&[]);
        let mut factors: Vec<(usize, String)> = Vec::new();
        for (place, name) in names.iter().enumerate() {
            if names.iter().filter(|other| *other == name).count() > 1 {
                return wrong(format!("the column {name:?} twice"), "each column once");
            }
            if name == IMAGE || name == REFERENCE {
                continue;
            }
            let is_word = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
            if name.is_empty() || !name.bytes().all(is_word) {
                let expected = "names of factors in letters, digits and '_'";
                return wrong(format!("the column {name:?}"), expected);
            }
            if reserved.iter().any(|column| column.name == name) {
                let expected = "names of factors that are no columns of the ratings";
                return wrong(format!("the column {name:?}"), expected);
            }
            factors.push((place, name.to_owned()));
        }
        let place = |wanted: &str| names.iter().position(|name| name == wanted);
        match place(IMAGE) {
            Some(image) if !factors.is_empty() => Ok(Self {
                image,
                reference: place(REFERENCE),
                factors,
            }),
            _ => {
                let names: Vec<&str> = names.iter().collect();
                wrong(format!("the columns {:?}", names.join(",")), KIND)
            }
        }
    }

    fn picture(&self, path: &Path, record: &csv::StringRecord) -> Result<Picture, InputError> {
        let line = record.position().map_or(0, csv::Position::line);
        let field = |place: usize| record.get(place).unwrap_or_default();
        let named = |column: &str, file: &str| {
            stimulus_id(file).map_err(|(found, expected)| {
                let place = format!("line {line}, column {column}");
                InputError::new(path, found, expected).at(place)
            })
        };
        let levels = self.factors.iter().map(|(place, _)| field(*place));
        let levels: Vec<String> = levels.map(str::to_owned).collect();
        let empty = levels.iter().position(String::is_empty);
        if let Some(empty) = empty
            && levels.iter().any(|level| !level.is_empty())
        {
            let expected = "a level of every factor, or of none for a picture that is not rated";
            let place = format!("line {line}, column {}", self.factors[empty].1);
            return Err(InputError::new(path, "an empty field", expected).at(place));
        }
        let file = field(self.image).to_owned();
        let reference = self.reference.map(field).filter(|file| !file.is_empty());
        Ok(Picture {
            id: named(IMAGE, &file)?,
            file,
            levels,
            reference: reference.map(|file| named(REFERENCE, file)).transpose()?,
            line,
        })
    }
}

/// The name of a picture: that of its file without `.png`.
fn stimulus_id(file: &str) -> Result<StimulusId, (String, &'static str)> {
    let expected = "a file name of 1 to 64 lower-case letters, digits, '-' and '_', and .png";
    let stem = file.strip_suffix(".png").map(str::to_owned);
    let id = stem.and_then(|stem| StimulusId::try_from(stem).ok());
    id.ok_or_else(|| (format!("{file:?}"), expected))
}
