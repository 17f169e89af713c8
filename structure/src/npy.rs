//! Arrays of numpy: directions and weights, and small matrices.
//!
//! Source: NEP 1, A Simple File Format for `NumPy` Arrays; numpy.lib.format, versions 1.0 to 3.0.

use std::io::{self, Read};

/// What a header may take, in bytes.
const LONGEST_HEADER: usize = 1 << 16;
/// More numbers than this are no direction, and no small matrix.
const MOST_NUMBERS: usize = 100_000_000;

/// What is wrong with a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NpyError {
    /// It cannot be read.
    #[error("{0}")]
    Read(#[from] io::Error),
    /// It does not begin as such a file does.
    #[error("it is no NPY file: it does not begin with `\\x93NUMPY`")]
    Magic,
    /// Its header cannot be understood.
    #[error("its header `{header}` is not understood: {what}")]
    Header {
        /// The header, or its beginning.
        header: String,
        /// Why.
        what: &'static str,
    },
    /// It ends before the array does.
    #[error("it ends after {found} of {expected} numbers")]
    Short {
        /// Numbers that there are.
        found: usize,
        /// Numbers that its shape asks for.
        expected: usize,
    },
    /// A number is infinite or not a number.
    #[error("number {place}, counted from zero, is {value}")]
    NotFinite {
        /// Its place.
        place: usize,
        /// The number.
        value: f64,
    },
}

/// An array of one or two dimensions, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Array {
    /// Its shape: one or two numbers.
    pub shape: Vec<usize>,
    /// Its numbers, row by row.
    pub values: Vec<f64>,
}

/// Reads an array of whole or real numbers of one or two dimensions.
///
/// # Errors
/// What is wrong with the file.
pub fn read(mut reader: impl Read) -> Result<Array, NpyError> {
    let mut magic = [0; 8];
    reader.read_exact(&mut magic).map_err(|_| NpyError::Magic)?;
    if magic[..6] != *b"\x93NUMPY" {
        return Err(NpyError::Magic);
    }
    let mut length = [0; 4];
    let bytes = if magic[6] == 1 { 2 } else { 4 };
    reader.read_exact(&mut length[..bytes])?;
    let length = u32::from_le_bytes(length) as usize;
    let mut header = Vec::new();
    let limit = length.min(LONGEST_HEADER) as u64;
    (&mut reader).take(limit).read_to_end(&mut header)?;
    let header = String::from_utf8_lossy(&header).into_owned();
    let fault = |what| NpyError::Header {
        header: header.trim().chars().take(80).collect(),
        what,
    };
    if header.len() < length {
        return Err(fault("it is cut short, or too long"));
    }
    let kind = after(&header, "'descr':").ok_or_else(|| fault("it has no `descr`"))?;
    let kind = kind.trim_start().trim_start_matches('\'');
    let kind = kind.split('\'').next().unwrap_or_default();
    let number = number_of(kind).ok_or_else(|| {
        fault("numbers must be `<f8`, `<f4`, `<i8` or `<i4`: save them as float64")
    })?;
    let columns_first = after(&header, "'fortran_order':")
        .is_some_and(|text| text.trim_start().starts_with("True"));
    let shape = shape(&header).ok_or_else(|| fault("its shape is not of one or two dimensions"))?;
    let expected = shape
        .iter()
        .try_fold(1_usize, |product, &count| product.checked_mul(count));
    let expected = expected
        .filter(|count| *count <= MOST_NUMBERS)
        .ok_or_else(|| fault("its shape has too many numbers"))?;
    let mut values = numbers(reader, expected, number)?;
    if columns_first && shape.len() == 2 {
        let (rows, columns) = (shape[0], shape[1]);
        let by_row = (0..expected).map(|k| values[(k % columns) * rows + k / columns]);
        values = by_row.collect();
    }
    Ok(Array { shape, values })
}

/// How many bytes a number has, and what they mean.
type Number = (usize, fn(&[u8]) -> f64);

fn number_of(kind: &str) -> Option<Number> {
    fn of<const N: usize>(bytes: &[u8]) -> [u8; N] {
        std::array::from_fn(|i| bytes[i])
    }
    match kind {
        "<f8" => Some((8, |bytes| f64::from_le_bytes(of(bytes)))),
        "<f4" => Some((4, |bytes| f64::from(f32::from_le_bytes(of(bytes))))),
        "<i8" => Some((8, |bytes| i64::from_le_bytes(of(bytes)) as f64)),
        "<i4" => Some((4, |bytes| f64::from(i32::from_le_bytes(of(bytes))))),
        _ => None,
    }
}

fn numbers(mut reader: impl Read, expected: usize, kind: Number) -> Result<Vec<f64>, NpyError> {
    let (size, number) = kind;
    let mut bytes = Vec::new();
    (&mut reader)
        .take((expected * size) as u64)
        .read_to_end(&mut bytes)?;
    let found = bytes.len() / size;
    if found < expected {
        return Err(NpyError::Short { found, expected });
    }
    let values: Vec<f64> = bytes.chunks_exact(size).map(number).collect();
    let faulty = values.iter().position(|value| !value.is_finite());
    match faulty {
        Some(place) => Err(NpyError::NotFinite {
            place,
            value: values[place],
        }),
        None => Ok(values),
    }
}

fn after<'t>(header: &'t str, key: &str) -> Option<&'t str> {
    let place = header.find(key)?;
    Some(&header[place + key.len()..])
}

fn shape(header: &str) -> Option<Vec<usize>> {
    let text = after(header, "'shape':")?.trim_start().strip_prefix('(')?;
    let text = text.split(')').next()?;
    let counts = text.split(',').map(str::trim).filter(|x| !x.is_empty());
    let counts: Vec<usize> = counts.map(|x| x.parse().ok()).collect::<Option<_>>()?;
    (counts.len() == 1 || counts.len() == 2).then_some(counts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn file(header: &str, data: &[u8]) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(data);
        bytes
    }

    fn sound() -> Vec<u8> {
        let numbers: Vec<u8> = (1..=6).flat_map(|x| f64::from(x).to_le_bytes()).collect();
        file(
            "{'descr': '<f8', 'fortran_order': True, 'shape': (2, 3), }\n",
            &numbers,
        )
    }

    #[test]
    fn arrays_are_read_row_by_row() {
        let array = read(sound().as_slice()).unwrap();
        assert_eq!(array.shape, [2, 3]);
        assert_eq!(array.values, [1.0, 3.0, 5.0, 2.0, 4.0, 6.0]);
        let whole = file(
            "{'descr': '<i4', 'fortran_order': False, 'shape': (2,), }",
            &[7, 0, 0, 0, 255, 255, 255, 255],
        );
        assert_eq!(read(whole.as_slice()).unwrap().values, [7.0, -1.0]);
    }

    #[test]
    fn faults_are_said() {
        let said = |bytes: &[u8]| read(bytes).expect_err("it is faulty").to_string();
        assert!(said(b"PK").contains("no NPY file"));
        let bytes = sound();
        assert!(said(&bytes[..bytes.len() - 9]).contains("after 4 of 6 numbers"));
        let claimed = "{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000,), }";
        assert!(said(&file(claimed, &[])).contains("too many numbers"));
        let objects = "{'descr': '|O', 'fortran_order': False, 'shape': (1,), }";
        assert!(said(&file(objects, &[])).contains("float64"));
        let faulty = "{'descr': '<f8', 'fortran_order': False, 'shape': (1,), }";
        assert!(said(&file(faulty, &f64::NAN.to_le_bytes())).contains("number 0"));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        #[test]
        fn damaged_files_are_read_or_refused(at in 0..100_usize, cut in 0..9_usize, put in prop::collection::vec(any::<u8>(), 0..9)) {
            let mut bytes = sound();
            let end = (at + cut).min(bytes.len());
            bytes.splice(at.min(end)..end, put);
            if let Ok(array) = read(bytes.as_slice()) {
                prop_assert!(array.values.len() < 1000);
            }
        }
    }
}
