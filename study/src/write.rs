//! The table in the forms that other programs read, row by row.

use std::io::{self, Write};

use crate::merge::{Merged, Source};
use crate::table::{Column, ColumnKind, Value};

/// With commas; the first line has the names.
pub(crate) fn csv(source: &Source<'_>, to: &mut impl Write) -> io::Result<()> {
    let mut writer = csv::WriterBuilder::new().from_writer(to);
    let names = source.study.columns.iter().map(|column| &column.name);
    writer.write_record(names).map_err(io::Error::other)?;
    source.each(|row| {
        let written = writer.write_record(row.iter().map(Value::written));
        written.map_err(io::Error::other)
    })?;
    writer.flush()
}

/// An object in each line. What is not finite is a text, which JSON has no numbers for.
pub(crate) fn json_lines(source: &Source<'_>, to: &mut impl Write) -> io::Result<()> {
    source.each(|row| {
        let mut object = serde_json::Map::new();
        for (value, column) in row.into_iter().zip(&source.study.columns) {
            let value = match value {
                Value::Missing => continue,
                Value::Whole(value) => value.into(),
                Value::Number(value) if value.is_finite() => value.into(),
                Value::Number(value) => format!("{value:?}").into(),
                Value::Text(text) => text.into(),
            };
            object.insert(column.name.clone(), value);
        }
        serde_json::to_writer(&mut *to, &object)?;
        to.write_all(b"\n")
    })
}

/// A structured array of numpy, format 1.0 (or 2.0 where its header is long): whole numbers of eight bytes with -1 where there is none,
/// numbers with `nan` there, and texts in UTF-8 as long as the longest of their column.
///
/// Source: numpy, `numpy.lib.format`.
pub(crate) fn npy(source: &Source<'_>, merged: &Merged, to: &mut impl Write) -> io::Result<()> {
    let columns = || source.study.columns.iter().zip(&merged.widths);
    let described = columns().map(|(Column { name, kind }, width)| match kind {
        ColumnKind::Whole => format!("('{name}', '<i8')"),
        ColumnKind::Number => format!("('{name}', '<f8')"),
        ColumnKind::Text => format!("('{name}', '|S{width}')"),
    });
    let described: Vec<String> = described.collect();
    let header = format!(
        "{{'descr': [{}], 'fortran_order': False, 'shape': ({},), }}",
        described.join(", "),
        merged.rows
    );
    // Twelve bytes come before the header of version 2.0, and a line break ends it.
    let length = (header.len() + 13).next_multiple_of(64) - 12;
    let mut bytes = b"\x93NUMPY\x02\x00".to_vec();
    bytes.extend((length as u32).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.resize(length + 11, b' ');
    bytes.push(b'\n');
    to.write_all(&bytes)?;
    source.each(|row| {
        for (value, (column, width)) in row.iter().zip(columns()) {
            match (column.kind, value) {
                (ColumnKind::Whole, Value::Whole(value)) => {
                    to.write_all(&(*value as i64).to_le_bytes())?;
                }
                (ColumnKind::Whole, _) => to.write_all(&(-1_i64).to_le_bytes())?,
                (ColumnKind::Number, Value::Number(value)) => to.write_all(&value.to_le_bytes())?,
                (ColumnKind::Number, _) => to.write_all(&f64::NAN.to_le_bytes())?,
                (ColumnKind::Text, value) => {
                    let mut text = value.written().into_bytes();
                    text.resize(*width, 0);
                    to.write_all(&text)?;
                }
            }
        }
        Ok(())
    })
}
