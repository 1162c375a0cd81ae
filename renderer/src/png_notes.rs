//! What a PNG file says of its colours, read from its chunks.
//!
//! Own pictures are shown as sRGB, whatever they say; so it must be said where they say something else.
//!
//! Source: PNG (third edition), W3C Recommendation 2025, sections 5.3 and 11.3.2.

/// The gamma of sRGB, 1/2.2, times 100 000.
const SRGB_GAMMA: u32 = 45_455;

/// What the file says of its colours, if that is not sRGB: `an ICC profile ("Display P3")`.
pub(crate) fn foreign_colours(png: &[u8]) -> Option<String> {
    let mut is_srgb = false;
    let mut foreign = None;
    for (name, data) in Chunks(png.get(8..).unwrap_or_default()) {
        match name {
            b"sRGB" => is_srgb = true,
            b"iCCP" => {
                let name = data.split(|&byte| byte == 0).next().unwrap_or_default();
                let name = String::from_utf8_lossy(name);
                foreign = Some(format!("an ICC profile ({name:?})"));
            }
            // Primaries and transfer of sRGB are 1 and 13 in ITU-T H.273.
            b"cICP" if !matches!(data, [1, 13, ..]) => {
                foreign = Some("coding-independent code points (cICP)".to_owned());
            }
            b"gAMA" if foreign.is_none() => {
                let gamma = data.first_chunk().map(|bytes| u32::from_be_bytes(*bytes));
                if let Some(gamma) = gamma.filter(|gamma| gamma.abs_diff(SRGB_GAMMA) > 5) {
                    foreign = Some(format!("a gamma of {}", f64::from(gamma) / 1e5));
                }
            }
            b"IDAT" => break,
            _ => {}
        }
    }
    foreign.filter(|_| !is_srgb)
}

/// The chunks of a file after its signature, as far as they are whole.
struct Chunks<'a>(&'a [u8]);

impl<'a> Iterator for Chunks<'a> {
    type Item = (&'a [u8; 4], &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        let (length, rest) = self.0.split_first_chunk::<4>()?;
        let length = usize::try_from(u32::from_be_bytes(*length)).ok()?;
        let (name, rest) = rest.split_first_chunk::<4>()?;
        let data = rest.get(..length)?;
        self.0 = rest.get(length + 4..)?;
        Some((name, data))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn png(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
        let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
        for (name, data) in chunks {
            file.extend(u32::try_from(data.len()).unwrap().to_be_bytes());
            file.extend(*name);
            file.extend(*data);
            file.extend([0; 4]);
        }
        file
    }

    #[test]
    fn what_is_not_srgb_is_named() {
        let gamma = |gamma: u32| gamma.to_be_bytes();
        for (chunks, expected) in [
            (&[(b"gAMA", &gamma(45_455)[..])][..], None),
            (&[(b"gAMA", &gamma(100_000)[..])], Some("a gamma of 1")),
            (&[(b"sRGB", &[0]), (b"gAMA", &gamma(50_000)[..])], None),
            (&[(b"iCCP", b"P3\0\0x")], Some("an ICC profile (\"P3\")")),
            (&[(b"cICP", &[1, 13, 0, 1])], None),
            (
                &[(b"cICP", &[9, 16, 0, 1])],
                Some("coding-independent code points (cICP)"),
            ),
            (&[(b"IDAT", b""), (b"gAMA", &gamma(1)[..])], None),
            (&[], None),
        ] {
            assert_eq!(foreign_colours(&png(chunks)).as_deref(), expected);
        }
    }

    #[test]
    fn a_torn_file_says_nothing_and_harms_nothing() {
        let whole = png(&[(b"iCCP", b"P3\0\0x"), (b"IDAT", b"")]);
        for end in 0..whole.len() {
            foreign_colours(&whole[..end]);
        }
        assert_eq!(foreign_colours(&[0xff; 64]), None);
    }
}
