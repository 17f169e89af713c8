//! The table of a study: columns, and rows of values as text that is read back to the same bits.

use hertzian::Event;
use hertzian::bifurcation::Cell;

use crate::plan::What;

/// A column of the table.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Column {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub kind: ColumnKind,
}

/// What a column holds; any of its values may be missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ColumnKind {
    /// Whole numbers.
    Whole,
    /// Numbers.
    Number,
    /// Text.
    Text,
}

/// A value in the table.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Value {
    /// There is none.
    Missing,
    /// A whole number.
    Whole(u64),
    /// A number.
    Number(f64),
    /// Text in one line.
    Text(String),
}

impl From<Option<f64>> for Value {
    fn from(value: Option<f64>) -> Self {
        value.map_or(Self::Missing, Self::Number)
    }
}

impl Value {
    /// A text, in one line.
    pub(crate) fn text(text: impl AsRef<str>) -> Self {
        let lines = text.as_ref().lines().map(str::trim);
        Self::Text(lines.collect::<Vec<_>>().join("; "))
    }

    /// A count.
    pub(crate) fn count(count: usize) -> Self {
        Self::Whole(count as u64)
    }

    /// As it stands in a table with commas.
    pub(crate) fn written(&self) -> String {
        match self {
            Self::Missing => String::new(),
            Self::Whole(value) => value.to_string(),
            // The shortest text that is read as the same number.
            Self::Number(value) => format!("{value:?}"),
            Self::Text(text) => text.clone(),
        }
    }

    /// Reads what was written; `None` where it is not of the kind.
    pub(crate) fn read(text: &str, kind: ColumnKind) -> Option<Self> {
        if text.is_empty() {
            return Some(Self::Missing);
        }
        match kind {
            ColumnKind::Whole => text.parse().ok().map(Self::Whole),
            ColumnKind::Number => text.parse().ok().map(Self::Number),
            ColumnKind::Text => Some(Self::Text(text.to_owned())),
        }
    }
}

/// Columns of how the place of an event moves with these: the derivative by each with its error, and why there are none.
pub(crate) fn moved(by: &[String]) -> impl Iterator<Item = Column> {
    let of = |name: &String| {
        let names = [format!("by_{name}"), format!("error_by_{name}")];
        names.map(|name| column(&name, ColumnKind::Number))
    };
    let why = (!by.is_empty()).then(|| column("without", ColumnKind::Text));
    by.iter().flat_map(of).chain(why)
}

fn column(name: &str, kind: ColumnKind) -> Column {
    let name = name.to_owned();
    Column { name, kind }
}

/// The columns of a study with these names of what varies, these signals, and what places of events move with. What varies under the name of
/// another column has one with an underscore.
pub(crate) fn columns(
    what: What,
    names: &[String],
    signals: &[String],
    by: &[String],
) -> Vec<Column> {
    let rest = about(what, signals, by);
    let mut columns = vec![column("variant", ColumnKind::Whole)];
    for name in names {
        let mut own = column(name, ColumnKind::Number);
        let is_taken = |own: &Column| {
            let others = columns.iter().chain(&rest);
            let names = names.iter().filter(|other| *other != name);
            let mut all = others.map(|other| &other.name).chain(names);
            all.any(|other| *other == own.name)
        };
        while is_taken(&own) {
            own.name.push('_');
        }
        columns.push(own);
    }
    columns.extend(rest);
    columns
}

/// The columns after those of what varies.
fn about(what: What, signals: &[String], by: &[String]) -> Vec<Column> {
    use ColumnKind::{Number, Text, Whole};
    let mut columns = vec![column("row", Text)];
    if what == What::Solutions {
        columns.push(column("value", Number));
        for name in Cell::COUNTED {
            columns.push(column(name, Whole));
        }
        columns.push(column("largest", Number));
        columns.push(column("signal", Text));
        columns.push(column("periods", Text));
    } else {
        columns.push(column("kind", Text));
        columns.push(column("branch", Whole));
        columns.push(column("period", Whole));
        columns.push(column("value", Number));
        columns.push(column("error", Number));
        columns.extend(signals.iter().map(|signal| column(signal, Number)));
        columns.push(column("size_error", Number));
        columns.extend(moved(by));
    }
    columns.push(column("verdict", Text));
    columns.push(column("ended", Text));
    columns
}

/// What a row is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum About {
    /// An event of a branch.
    Event,
    /// A place where something like it was seen and not located.
    NotLocated,
    /// An orbit at a value that was asked for.
    At,
    /// The orbit at which a signal is largest.
    Largest,
    /// What there is at a value.
    Cell,
    /// A variant of which there is nothing to say.
    Nothing,
    /// A bifurcation whose branch was not followed.
    NotFollowed,
    /// A variant, or a value of one, that could not be computed.
    Failed,
}

impl About {
    /// As the column `row` has it.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Event => "event",
            Self::NotLocated => "not-located",
            Self::At => "at",
            Self::Largest => "largest",
            Self::Cell => "cell",
            Self::Nothing => "nothing",
            Self::NotFollowed => "not-followed",
            Self::Failed => "failed",
        }
    }
}

/// The kind of an event as a column has it.
pub(crate) fn kind(event: &Event) -> String {
    event.kind.to_string()
}
