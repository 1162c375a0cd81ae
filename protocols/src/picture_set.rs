//! Own pictures instead of a scene: which files they are, and what a table says of them.
//!
//! Not here: how the table is read (`picture_table`), and what is in the pictures.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::picture_table::PictureTable;
use crate::{InputError, StimulusId};

/// The part of a protocol that names own pictures.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PicturePlan {
    /// The name of the set, and of its folder below `stimuli/`.
    pub set: String,
    /// Which files, relative to the folder of the protocol: `*` in the name stands for any letters.
    pub images: String,
    /// The table of their factors (CSV), relative to the folder of the protocol.
    pub factors: String,
    /// The two pictures that stay beside the test image, if the layout shows any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub anchors: Option<PictureAnchors>,
}

/// The pictures that stay beside the test image, by their file names.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PictureAnchors {
    /// The picture of the lowest quality, shown on the left or first.
    pub zero: String,
    /// The picture of the highest quality, shown on the right or last.
    pub ten: String,
}

/// Own pictures with their factors.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureSet {
    /// What the protocol says.
    pub plan: PicturePlan,
    /// What the table says.
    pub table: PictureTable,
    /// The zero and the ten anchor.
    pub anchors: Option<[StimulusId; 2]>,
    /// The folder of the pictures.
    pub folder: PathBuf,
}

impl PictureSet {
    /// Reads the table of a plan that stands in the file `protocol`.
    ///
    /// # Errors
    ///
    /// The table is missing or cannot be used, the plan contradicts itself or the table.
    pub(crate) fn read(plan: PicturePlan, protocol: &Path) -> Result<Self, InputError> {
        if let Some((field, found, expected)) = plan.fault() {
            return Err(InputError::new(protocol, found, expected).at(format!("field {field}")));
        }
        let beside = protocol.parent().unwrap_or_else(|| Path::new(""));
        let table = PictureTable::read(&beside.join(&plan.factors))?;
        let folder = beside.join(plan.images_folder());
        let anchor = |field: &str, file: &String| {
            let found = table.pictures.iter().find(|picture| picture.file == *file);
            found.map(|picture| picture.id.clone()).ok_or_else(|| {
                let expected = format!("an image of the table \"{}\"", plan.factors);
                InputError::new(protocol, format!("{file:?}"), expected)
                    .at(format!("field stimuli.anchors.{field}"))
            })
        };
        let anchors = match &plan.anchors {
            None => None,
            Some(PictureAnchors { zero, ten }) => {
                Some([anchor("zero", zero)?, anchor("ten", ten)?])
            }
        };
        Ok(Self {
            plan,
            table,
            anchors,
            folder,
        })
    }

    /// Checks that the files of the plan and the images of the table are the same.
    ///
    /// # Errors
    ///
    /// The folder cannot be read, a file is not in the table or an image of the table is no such file.
    pub fn check_files(&self) -> Result<(), InputError> {
        let kind = "the folder of the pictures";
        let unreadable = |error: std::io::Error| {
            InputError::new(&self.folder, error.to_string(), kind)
                .remedy("mend `images` in [stimuli]")
        };
        let mut names = Vec::new();
        for entry in fs::read_dir(self.folder_or_here()).map_err(unreadable)? {
            let name = entry.map_err(unreadable)?.file_name();
            let name = name.to_string_lossy().into_owned();
            if self.plan.matches(&name) {
                names.push(name);
            }
        }
        names.sort_unstable();
        let listed = |name: &&String| self.table.pictures.iter().any(|p| p.file == **name);
        if let Some(unlisted) = names.iter().find(|name| !listed(name)) {
            let expected = "a line for each picture that `images` names";
            let table = &self.table.path;
            return Err(
                InputError::new(table, format!("no line for {unlisted:?}"), expected)
                    .remedy("add its line, or make `images` in [stimuli] narrower"),
            );
        }
        match self
            .table
            .pictures
            .iter()
            .find(|p| !names.contains(&p.file))
        {
            None => Ok(()),
            Some(missing) => {
                let found = format!("{:?}, which is not there", missing.file);
                let expected = format!("a file that {:?} names", self.plan.images);
                Err(InputError::new(&self.table.path, found, expected)
                    .at(format!("line {}, column image", missing.line)))
            }
        }
    }

    fn folder_or_here(&self) -> &Path {
        if self.folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            &self.folder
        }
    }
}

impl PicturePlan {
    fn fault(&self) -> Option<(&'static str, String, &'static str)> {
        let is_plain =
            |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'-';
        if self.set.is_empty() || !self.set.bytes().all(is_plain) {
            let expected = "lower-case letters, digits and '-' (it names a folder)";
            return Some(("stimuli.set", format!("{:?}", self.set), expected));
        }
        let is_png = Path::new(&self.images).extension() == Some("png".as_ref());
        if !is_png || self.images_folder().contains('*') {
            let expected = "PNG files of one folder, such as \"pictures/*.png\"";
            return Some(("stimuli.images", format!("{:?}", self.images), expected));
        }
        None
    }

    /// What stands before the last `/`.
    fn images_folder(&self) -> &str {
        self.images
            .rsplit_once('/')
            .map_or("", |(folder, _)| folder)
    }

    /// Whether `images` names a file of this name: `*` stands for any letters, also none.
    fn matches(&self, name: &str) -> bool {
        let pattern = self.images.rsplit('/').next().unwrap_or_default();
        let mut parts = pattern.split('*');
        let first = parts.next().unwrap_or_default();
        let Some(mut rest) = name.strip_prefix(first) else {
            return false;
        };
        let mut parts = parts.peekable();
        if parts.peek().is_none() {
            return rest.is_empty();
        }
        while let Some(part) = parts.next() {
            if parts.peek().is_none() {
                return rest.ends_with(part);
            }
            match rest.find(part) {
                Some(place) => rest = &rest[place + part.len()..],
                None => return false,
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_stands_for_any_letters() {
        let plan = |images: &str| PicturePlan {
            set: "s".to_owned(),
            images: images.to_owned(),
            factors: "f.csv".to_owned(),
            anchors: None,
        };
        for (images, name, is_match) in [
            ("p/*.png", "a.png", true),
            ("*.png", ".png", true),
            ("*.png", "a.png.txt", false),
            ("a.png", "a.png", true),
            ("a.png", "aa.png", false),
            ("p/x-*-q*.png", "x-jpeg-q10.png", true),
            ("p/x-*-q*.png", "x-q10.png", false),
            ("p/x*x.png", "x.png", false),
        ] {
            assert_eq!(plan(images).matches(name), is_match, "{images} {name}");
        }
    }
}
