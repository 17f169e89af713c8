//! Arrays in the NPY format of numpy, version 1.0.
//!
//! Ten bytes (magic, version, length of the header), a header that is the text of a Python dictionary filled with spaces so that the
//! data begin at a multiple of 64 bytes, and the numbers in little-endian order, row by row.
//!
//! Source: numpy, `numpy.lib.format`.

use crate::error::Error;
use crate::model::request::RequestError;

/// The bytes of a file of numpy's with an array of two dimensions: of so many columns, its values row by row.
///
/// ```
/// use hertzian::export;
///
/// let bytes = export::npy(2, &[1.0, 2.0, 3.0, 4.0])?;
/// assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
/// assert_eq!(bytes.len(), 128 + 4 * 8);
/// assert!(export::npy(3, &[1.0, 2.0, 3.0, 4.0]).is_err());
/// # Ok::<(), hertzian::Error>(())
/// ```
///
/// # Errors
/// If the last row is not whole.
pub fn npy(columns: usize, values: &[f64]) -> Result<Vec<u8>, Error> {
    file("<f8", columns, values, f64::to_le_bytes)
}

/// As [`npy`], of small whole numbers: [labels of fates](crate::attractors::basin::Fate::label).
///
/// # Errors
/// As of [`npy`].
pub fn npy_of_labels(columns: usize, values: &[i16]) -> Result<Vec<u8>, Error> {
    file("<i2", columns, values, i16::to_le_bytes)
}

fn file<T: Copy, const BYTES: usize>(
    description: &str,
    columns: usize,
    values: &[T],
    bytes_of: impl Fn(T) -> [u8; BYTES],
) -> Result<Vec<u8>, Error> {
    let rows = values.len().checked_div(columns).unwrap_or(0);
    if rows * columns != values.len() {
        return Err(RequestError::Option {
            name: "columns",
            value: columns as f64,
            must: "must divide the number of values, so that every row is whole",
        }
        .into());
    }
    let header = format!(
        "{{'descr': '{description}', 'fortran_order': False, 'shape': ({rows}, {columns}), }}"
    );
    // Ten bytes come before the header, and a line break ends it.
    let length = (header.len() + 11).next_multiple_of(64) - 10;
    let mut bytes = Vec::with_capacity(length + 10 + BYTES * values.len());
    bytes.extend(b"\x93NUMPY\x01\x00");
    bytes.extend((length as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.resize(length + 9, b' ');
    bytes.push(b'\n');
    for &value in values {
        bytes.extend(bytes_of(value));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bytes that numpy 2.4 writes with `numpy.save` for `numpy.array([[1, -2, 3]], dtype="<i2")`.
    #[test]
    fn it_is_what_numpy_writes() {
        let mut expected = b"\x93NUMPY\x01\x00v\x00".to_vec();
        expected.extend(b"{'descr': '<i2', 'fortran_order': False, 'shape': (1, 3), }");
        expected.resize(127, b' ');
        expected.extend(b"\n\x01\x00\xfe\xff\x03\x00");
        assert_eq!(npy_of_labels(3, &[1, -2, 3]), Ok(expected));
    }

    /// Nothing is left out.
    #[test]
    fn a_row_that_is_not_whole_is_refused() {
        for (columns, values) in [(3, 4), (5, 4), (0, 1)] {
            let error = npy_of_labels(columns, &vec![1; values]).expect_err("a part of a row");
            assert_eq!(error.value("value"), Some(columns as f64));
            assert!(npy(columns, &vec![1.0; values]).is_err());
        }
    }

    #[test]
    fn an_array_without_rows_has_none() {
        let bytes = npy(4, &[]).expect("no rows");
        assert_eq!(bytes.len(), 128);
        assert!(String::from_utf8_lossy(&bytes).contains("'shape': (0, 4)"));
        assert_eq!(npy(0, &[]).expect("no columns").len(), 128);
    }
}
