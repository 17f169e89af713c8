//! Numbers as arrays of numpy, and the other way round.

use hertzian::Complex;
use numpy::{AllowTypeChange, PyArray1, PyArray2, PyArrayLike1, PyArrayLike2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyAny;

/// An array of two dimensions with so many columns, row by row.
pub fn matrix<T: numpy::Element>(
    py: Python<'_>,
    numbers: Vec<T>,
    columns: usize,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let rows = numbers.len().checked_div(columns).unwrap_or(0);
    PyArray1::from_vec(py, numbers).reshape([rows, columns])
}

/// The same of rows that need not be as long; what is missing is not a number.
pub fn ragged<'py>(
    py: Python<'py>,
    rows: &[&[Complex<f64>]],
) -> PyResult<Bound<'py, PyArray2<Complex<f64>>>> {
    let columns = rows.iter().map(|row| row.len()).max().unwrap_or(0);
    let missing = Complex::new(f64::NAN, f64::NAN);
    let filled = |row: &&[Complex<f64>]| {
        let mut row = row.to_vec();
        row.resize(columns, missing);
        row
    };
    let numbers: Vec<Complex<f64>> = rows.iter().flat_map(filled).collect();
    // Without columns there are no numbers to count rows by.
    PyArray1::from_vec(py, numbers).reshape([rows.len(), columns])
}

/// Numbers from an array or a list.
pub fn numbers(value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let array: PyArrayLike1<'_, f64, AllowTypeChange> = value.extract()?;
    Ok(array.as_array().iter().copied().collect())
}

/// Rows of numbers from an array or a list of lists.
pub fn rows(value: &Bound<'_, PyAny>) -> PyResult<Vec<Vec<f64>>> {
    let array: PyArrayLike2<'_, f64, AllowTypeChange> = value.extract()?;
    let rows = array.as_array();
    Ok(rows
        .rows()
        .into_iter()
        .map(|row| row.iter().copied().collect())
        .collect())
}
