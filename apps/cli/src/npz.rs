//! Arrays, as archives for `numpy.load` and as JSON.

use std::{
    borrow::Cow,
    io::{Cursor, Write},
};

use crane_model::nalgebra::DMatrix;
use serde_json::Value;
use zip::{CompressionMethod, ZipWriter, result::ZipError, write::SimpleFileOptions};

/// A named array, row by row.
#[derive(Clone, Debug)]
pub struct Array {
    /// Name.
    pub name: Cow<'static, str>,
    /// Lengths of its axes.
    pub shape: Vec<usize>,
    /// Elements, the last axis running fastest.
    pub data: Vec<f64>,
}

impl Array {
    /// A matrix, row by row.
    pub fn of_matrix(name: &'static str, matrix: &DMatrix<f64>) -> Self {
        let shape = vec![matrix.nrows(), matrix.ncols()];
        Self { name: name.into(), shape, data: matrix.transpose().as_slice().to_vec() }
    }

    /// Nested JSON arrays.
    pub fn json(&self) -> Value {
        fn nest(shape: &[usize], data: &[f64]) -> Value {
            match shape {
                [] => data.first().copied().unwrap_or(f64::NAN).into(),
                [count, inner @ ..] => {
                    let size: usize = inner.iter().product();
                    (0..*count).map(|index| nest(inner, &data[index * size..][..size])).collect()
                }
            }
        }
        nest(&self.shape, &self.data)
    }

    /// NPY format 1.0, little-endian f64, C order.
    fn npy(&self) -> Vec<u8> {
        /// Magic, version and length of the header.
        const PREAMBLE: usize = 10;
        /// The data begin at a multiple of this.
        const ALIGNMENT: usize = 64;
        let shape: Vec<String> = self.shape.iter().map(|length| format!("{length},")).collect();
        let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}), }}", shape.join(" "));
        let end = (PREAMBLE + header.len() + 1).next_multiple_of(ALIGNMENT);
        header.extend(std::iter::repeat_n(' ', end - PREAMBLE - header.len() - 1));
        header.push('\n');
        let length = u16::try_from(header.len()).unwrap_or(u16::MAX);
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend(length.to_le_bytes());
        bytes.extend(header.bytes());
        bytes.extend(self.data.iter().flat_map(|value| value.to_le_bytes()));
        bytes
    }
}

/// An archive that `numpy.load` reads: stored, not compressed.
pub fn npz(arrays: &[Array]) -> Result<Vec<u8>, ZipError> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for array in arrays {
        archive.start_file(format!("{}.npy", array.name), options)?;
        archive.write_all(&array.npy())?;
    }
    Ok(archive.finish()?.into_inner())
}
