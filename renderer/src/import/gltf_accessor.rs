//! The numbers of a glTF: accessors into its buffers, each byte checked to be there.

use gltf::Accessor;
use gltf::accessor::{DataType, Dimensions};
use protocols::InputError;

use super::gltf_file::GltfFile;

impl GltfFile<'_> {
    /// The items of an accessor of `N` numbers each.
    ///
    /// # Errors
    ///
    /// If it has another shape, or its bytes are not there.
    pub(super) fn floats<const N: usize>(
        &self,
        accessor: &Accessor<'_>,
    ) -> Result<Vec<[f32; N]>, InputError> {
        let expected = [
            Dimensions::Scalar,
            Dimensions::Vec2,
            Dimensions::Vec3,
            Dimensions::Vec4,
        ];
        if N == 0 || N > 4 || accessor.dimensions() != expected[N - 1] {
            let found = format!("items of the shape {:?}", accessor.dimensions());
            return Err(self.wrong(accessor, found, format!("items of {N} numbers")));
        }
        let (bytes, stride) = self.bytes(accessor)?;
        let size = accessor.data_type().size();
        let item = |at: usize| {
            std::array::from_fn(|part| number(accessor, &bytes[at * stride + part * size..]))
        };
        Ok((0..accessor.count()).map(item).collect())
    }

    /// The whole numbers of an accessor.
    ///
    /// # Errors
    ///
    /// If it has other numbers, or its bytes are not there.
    pub(super) fn indices(&self, accessor: &Accessor<'_>) -> Result<Vec<u32>, InputError> {
        let read: fn(&[u8]) -> u32 = match (accessor.dimensions(), accessor.data_type()) {
            (Dimensions::Scalar, DataType::U8) => |bytes| u32::from(bytes[0]),
            (Dimensions::Scalar, DataType::U16) => {
                |bytes| u32::from(u16::from_le_bytes([bytes[0], bytes[1]]))
            }
            (Dimensions::Scalar, DataType::U32) => {
                |bytes| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
            }
            (shape, numbers) => {
                let found = format!("{numbers:?} in items of the shape {shape:?}");
                return Err(self.wrong(accessor, found, "unsigned whole numbers"));
            }
        };
        let (bytes, stride) = self.bytes(accessor)?;
        Ok((0..accessor.count())
            .map(|at| read(&bytes[at * stride..]))
            .collect())
    }

    /// The bytes from an accessor's first item to its last, and the distance between items.
    fn bytes(&self, accessor: &Accessor<'_>) -> Result<(&[u8], usize), InputError> {
        if accessor.sparse().is_some() {
            return Err(self.wrong(accessor, "sparse values", "values one after another"));
        }
        let Some(view) = accessor.view() else {
            return Err(self.wrong(accessor, "no buffer view", "a buffer view"));
        };
        let size = accessor.size();
        let stride = view.stride().unwrap_or(size);
        let length = |count: usize| (count - 1).checked_mul(stride)?.checked_add(size);
        let range = match accessor.count() {
            0 => Some(0..0),
            count => length(count).and_then(|length| {
                let within = accessor.offset()..accessor.offset().checked_add(length)?;
                let start = view.offset().checked_add(within.start)?;
                (within.end <= view.length()).then_some(start..start.checked_add(length)?)
            }),
        };
        let buffer = &self.buffers[view.buffer().index()];
        let bytes = range.and_then(|range| buffer.get(range));
        let bytes = bytes.ok_or_else(|| {
            let found = format!(
                "{} items of {size} bytes, {stride} apart, beyond the end of buffer view {}",
                accessor.count(),
                view.index()
            );
            self.wrong(accessor, found, "items within their buffer view and buffer")
        })?;
        Ok((bytes, stride))
    }

    fn wrong(
        &self,
        accessor: &Accessor<'_>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> InputError {
        let place = format!("accessor {}", accessor.index());
        self.source.error(found, expected).at(place)
    }
}

/// The number at the beginning of the bytes; a normalised whole number is from −1 or 0 to 1.
fn number(accessor: &Accessor<'_>, bytes: &[u8]) -> f32 {
    let (value, most) = match accessor.data_type() {
        DataType::I8 => (f32::from(i8::from_le_bytes([bytes[0]])), 127.0),
        DataType::U8 => (f32::from(bytes[0]), 255.0),
        DataType::I16 => (
            f32::from(i16::from_le_bytes([bytes[0], bytes[1]])),
            32_767.0,
        ),
        DataType::U16 => (
            f32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
            65_535.0,
        ),
        DataType::U32 => {
            let value = u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            (value as f32, u32::MAX as f32)
        }
        DataType::F32 => {
            return f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        }
    };
    if accessor.normalized() {
        (value / most).max(-1.0)
    } else {
        value
    }
}
