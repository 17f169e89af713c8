//! Arrays in the NPY format of numpy, version 1.0.
//!
//! Ten bytes (magic, version, length of the header), a header that is the text of a Python dictionary filled with spaces so that the
//! data begin at a multiple of 64 bytes, and the numbers in little-endian order, row by row.
//!
//! Source: numpy, `numpy.lib.format`.

/// A number that an array can hold.
pub trait Number: Copy {
    /// Its name in the header.
    const DESCRIPTION: &'static str;

    /// Appends its bytes.
    fn write(self, bytes: &mut Vec<u8>);
}

impl Number for f64 {
    const DESCRIPTION: &'static str = "<f8";

    fn write(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }
}

impl Number for i16 {
    const DESCRIPTION: &'static str = "<i2";

    fn write(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }
}

/// An array of two dimensions that grows row by row.
///
/// ```
/// use hertzian::export::Npy;
///
/// let mut table = Npy::new(2);
/// table.row(&[1.0, 2.0]);
/// table.row(&[3.0, 4.0]);
/// let bytes = table.to_bytes();
/// assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
/// assert_eq!(bytes.len(), 128 + 4 * 8);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Npy<T> {
    columns: usize,
    values: Vec<T>,
}

impl<T: Number> Npy<T> {
    /// An array without rows.
    pub fn new(columns: usize) -> Self {
        Self {
            columns,
            values: Vec::new(),
        }
    }

    /// Adds a row. One that is too short is filled with the last of its values, of one that is too long the end is left out; without
    /// any value it is no row.
    pub fn row(&mut self, values: &[T]) {
        let Some(&last) = values.last() else {
            return;
        };
        let padding = std::iter::repeat(last);
        let values = values.iter().copied().chain(padding);
        self.values.extend(values.take(self.columns));
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.values.len().checked_div(self.columns).unwrap_or(0)
    }

    /// The bytes of the file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let header = format!(
            "{{'descr': '{}', 'fortran_order': False, 'shape': ({}, {}), }}",
            T::DESCRIPTION,
            self.rows(),
            self.columns
        );
        // Ten bytes come before the header, and a line break ends it.
        let length = (header.len() + 11).next_multiple_of(64) - 10;
        let mut bytes = Vec::with_capacity(length + 10 + size_of_val(&self.values[..]));
        bytes.extend(b"\x93NUMPY\x01\x00");
        bytes.extend((length as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.resize(length + 9, b' ');
        bytes.push(b'\n');
        for &value in &self.values {
            value.write(&mut bytes);
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bytes that numpy 2.4 writes with `numpy.save` for `numpy.array([[1, -2, 3]], dtype="<i2")`.
    #[test]
    fn it_is_what_numpy_writes() {
        let mut array = Npy::<i16>::new(3);
        array.row(&[1, -2, 3]);
        let mut expected = b"\x93NUMPY\x01\x00v\x00".to_vec();
        expected.extend(b"{'descr': '<i2', 'fortran_order': False, 'shape': (1, 3), }");
        expected.resize(127, b' ');
        expected.extend(b"\n\x01\x00\xfe\xff\x03\x00");
        assert_eq!(array.to_bytes(), expected);
    }

    #[test]
    fn an_array_without_rows_has_none() {
        let bytes = Npy::<f64>::new(4).to_bytes();
        assert_eq!(bytes.len(), 128);
        assert!(String::from_utf8_lossy(&bytes).contains("'shape': (0, 4)"));
        assert_eq!(Npy::<f64>::new(0).rows(), 0);
    }
}
