//! The table as Parquet: groups of rows, each column by itself, so that a group is what is held at a time.
//!
//! Source: Apache Parquet, format 2; a value that is missing has the definition level zero.

use std::io::{self, Write};
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;

use crate::merge::Source;
use crate::table::{Column, ColumnKind, Value};

/// Rows of a group.
const GROUP: usize = 1 << 16;

/// Writes the table.
pub(crate) fn parquet(source: &Source<'_>, to: &mut (impl Write + Send)) -> io::Result<()> {
    let columns = &source.study.columns;
    let schema = schema(columns).map_err(io::Error::other)?;
    let properties = Arc::new(WriterProperties::builder().build());
    let writer = SerializedFileWriter::new(to, Arc::new(schema), properties);
    let mut writer = writer.map_err(io::Error::other)?;
    let mut rows: Vec<Vec<Value>> = Vec::new();
    source.each(|row| {
        rows.push(row);
        if rows.len() < GROUP {
            return Ok(());
        }
        let written = group(&mut writer, columns, &rows);
        rows.clear();
        written.map_err(io::Error::other)
    })?;
    if !rows.is_empty() {
        group(&mut writer, columns, &rows).map_err(io::Error::other)?;
    }
    writer.close().map(|_| ()).map_err(io::Error::other)
}

fn schema(columns: &[Column]) -> Result<Type, ParquetError> {
    let fields = columns.iter().map(|column| {
        let (physical, logical) = match column.kind {
            ColumnKind::Whole => (Physical::INT64, None),
            ColumnKind::Number => (Physical::DOUBLE, None),
            ColumnKind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let field = Type::primitive_type_builder(&column.name, physical);
        let field = field.with_repetition(Repetition::OPTIONAL);
        field.with_logical_type(logical).build().map(Arc::new)
    });
    let fields = fields.collect::<Result<Vec<_>, _>>()?;
    Type::group_type_builder("study")
        .with_fields(fields)
        .build()
}

fn group<W: Write + Send>(
    writer: &mut SerializedFileWriter<W>,
    columns: &[Column],
    rows: &[Vec<Value>],
) -> Result<(), ParquetError> {
    let mut group = writer.next_row_group()?;
    for (place, column) in columns.iter().enumerate() {
        let Some(to) = group.next_column()? else {
            break;
        };
        let values = rows.iter().map(|row| &row[place]);
        fill(to, column.kind, values)?;
    }
    group.close().map(|_| ())
}

/// Writes a column of a group.
fn fill<'v>(
    mut to: SerializedColumnWriter<'_>,
    kind: ColumnKind,
    values: impl Iterator<Item = &'v Value> + Clone,
) -> Result<(), ParquetError> {
    let is_there = |value: &Value| i16::from(!matches!(value, Value::Missing));
    let levels: Vec<i16> = values.clone().map(is_there).collect();
    let levels = Some(&levels[..]);
    match kind {
        ColumnKind::Whole => {
            let whole = values.filter_map(|value| match value {
                Value::Whole(value) => Some(*value as i64),
                _ => None,
            });
            let whole: Vec<i64> = whole.collect();
            to.typed::<Int64Type>().write_batch(&whole, levels, None)?;
        }
        ColumnKind::Number => {
            let numbers = values.filter_map(|value| match value {
                Value::Number(value) => Some(*value),
                _ => None,
            });
            let numbers: Vec<f64> = numbers.collect();
            to.typed::<DoubleType>()
                .write_batch(&numbers, levels, None)?;
        }
        ColumnKind::Text => {
            let texts = values.filter_map(|value| match value {
                Value::Text(text) => Some(ByteArray::from(text.as_str())),
                _ => None,
            });
            let texts: Vec<ByteArray> = texts.collect();
            to.typed::<ByteArrayType>()
                .write_batch(&texts, levels, None)?;
        }
    }
    to.close()
}
