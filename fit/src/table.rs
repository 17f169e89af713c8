//! Data sets from a table whose header says what is in its columns.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use hertzian::observe::Wanted;
use hertzian::{Model, System};

use crate::data::{DataSet, Sweep};
use crate::error::FitError;
use crate::unit;

/// What a column holds, and the factor to the units of the model.
#[derive(Debug, Clone, PartialEq)]
enum Column {
    Omega(f64),
    Parameter(String, f64),
    /// With the unit that was written.
    Measured(Wanted, f64, Option<String>),
    /// With the unit that was written.
    Deviation(Option<Wanted>, Option<String>),
    Sweep,
    Set,
}

/// Rows that belong together.
#[derive(Debug, Default)]
struct Rows {
    places: Vec<f64>,
    values: Vec<f64>,
    deviations: Vec<f64>,
}

/// What makes rows one data set: its name in the table, the sweep, the values of parameters, what was measured.
type Key = (String, usize, Vec<u64>, usize);

/// The data sets of a table, as text with commas, semicolons or tabs. The first line names the columns, with units in brackets: `omega` or
/// `frequency [Hz]` or the parameter that was varied; what was measured, as `x:p2p [um]`, in one or several columns; and where they are
/// known `sd` (or `sd of x:p2p`) for standard deviations, `sweep` with `rising`, `falling`, `settled` or `controlled`, `set` with a name, and
/// parameters that had several values, such as `drive [N]`. Rows that are alike in the last three are one data set. Lines that begin with `#` are
/// left out, and so is what was not measured: an empty cell. Where a parameter was varied, `omega` is the frequency at which.
///
/// ```
/// hertzian::oscillator! {
///     Linear(x) {
///         param drive = 1;
///         ddot(x) + 0.1*dot(x) + x = drive*cos(omega*t);
///     }
/// }
///
/// let table = "frequency [Hz], x:p2p, sd, sweep, drive\n\
///              0.12, 2.1, 0.02, rising, 0.5\n\
///              0.14, 4.0, 0.02, rising, 0.5\n\
///              0.14, 8.1, 0.04, rising, 1.0\n";
/// let sets = hertzian_fit::read(table, &Linear::default(), None)?;
/// assert_eq!(sets.len(), 2);
/// assert_eq!(sets[0].name(), "x:p2p rising drive=0.5");
/// # Ok::<(), hertzian_fit::FitError>(())
/// ```
///
/// # Errors
/// What is wrong, with its line.
pub fn read(text: &str, system: &dyn System, omega: Option<f64>) -> Result<Vec<DataSet>, FitError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let lines = text.lines().zip(1_u64..);
    let mut lines = lines.filter(|(line, _)| !line.trim().is_empty() && !line.starts_with('#'));
    let (header, line) = lines.next().ok_or_else(|| fault(1, "the table is empty"))?;
    let mut marks = [b',', b';', b'\t'].into_iter();
    let mark = marks.find(|mark| header.as_bytes().contains(mark));
    let cells = |line: &str, number: u64| {
        cells(line, mark.unwrap_or(b',')).map_err(|message| fault(number, &message))
    };
    let columns = columns(&cells(header, line)?, &Model::of(system))
        .map_err(|message| fault(line, &message))?;
    let varied = varied(&columns).map_err(|message| fault(line, &message))?;
    let mut sets: Vec<(Key, Rows)> = Vec::new();
    for (row, number) in lines {
        let row = cells(row, number)?;
        take(&row, &columns, varied, &mut sets).map_err(|message| fault(number, &message))?;
    }
    if sets.is_empty() {
        return Err(fault(line, "there are no rows below the header"));
    }
    let sets = sets.into_iter();
    Ok(sets
        .map(|(key, rows)| set(&key, rows, &columns, varied, omega))
        .collect())
}

/// The cells of a line, which may be in quotation marks.
fn cells(line: &str, mark: u8) -> Result<csv::StringRecord, String> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .trim(csv::Trim::All)
        .delimiter(mark)
        .from_reader(line.as_bytes());
    let record = reader.records().next();
    let record = record.unwrap_or_else(|| Ok(csv::StringRecord::new()));
    record.map_err(|error| error.to_string())
}

fn fault(line: u64, message: &str) -> FitError {
    let message = message.to_owned();
    FitError::Table { line, message }
}

/// What each column holds.
fn columns(header: &csv::StringRecord, model: &Model) -> Result<Vec<Column>, String> {
    let mut columns: Vec<Column> = Vec::new();
    for (index, cell) in header.iter().enumerate() {
        let column = column(cell, model)
            .map_err(|message| format!("column {}, `{cell}`: {message}", index + 1))?;
        if columns.iter().any(|known| kind(known) == kind(&column)) {
            return Err(format!(
                "column {}, `{cell}`: there is another one like it",
                index + 1
            ));
        }
        columns.push(column);
    }
    let measured: Vec<&Wanted> = measured(&columns).map(|(_, wanted)| wanted).collect();
    for column in &columns {
        match column {
            Column::Deviation(None, _) if measured.len() > 1 => {
                return Err(
                    "several columns are measured: say `sd of x:p2p` instead of `sd`".to_owned(),
                );
            }
            Column::Deviation(Some(of), _) if !measured.contains(&of) => {
                return Err(format!(
                    "there are standard deviations of {of}, and no column {of}"
                ));
            }
            Column::Deviation(of, unit) => {
                let own = columns.iter().find_map(|column| match column {
                    Column::Measured(wanted, _, unit) => {
                        let is_own = of.as_ref().is_none_or(|of| of == wanted);
                        is_own.then_some(unit)
                    }
                    _ => None,
                });
                if let (Some(unit), Some(own)) = (unit, own)
                    && Some(unit) != own.as_ref()
                {
                    let message = "standard deviations are in the unit of what was measured";
                    return Err(format!("[{unit}]: {message}, as its column has it"));
                }
            }
            _ => {}
        }
    }
    if measured.is_empty() {
        return Err(
            "no column says what was measured: name one as `x:p2p`, `x:rms` or `x:h1`".to_owned(),
        );
    }
    Ok(columns)
}

/// What may be there once.
fn kind(column: &Column) -> String {
    match column {
        Column::Omega(_) => "omega".to_owned(),
        Column::Parameter(name, _) => format!("parameter {name}"),
        Column::Measured(wanted, ..) => format!("measured {wanted}"),
        Column::Deviation(of, _) => format!("deviation {of:?}"),
        Column::Sweep => "sweep".to_owned(),
        Column::Set => "set".to_owned(),
    }
}

/// What a column holds, by its head.
fn column(cell: &str, model: &Model) -> Result<Column, String> {
    let (name, unit) = match cell.split_once('[') {
        None => (cell.trim(), None),
        Some((name, rest)) => {
            let unit = rest
                .trim()
                .strip_suffix(']')
                .ok_or("a unit ends with `]`")?;
            (name.trim(), Some(unit.trim()))
        }
    };
    let parameter = model
        .parameters
        .iter()
        .find(|parameter| parameter.name == name);
    let factor = |expected: &str| unit::factor(unit, expected, !model.units.is_empty());
    if let Some(parameter) = parameter {
        return Ok(Column::Parameter(name.to_owned(), factor(&parameter.unit)?));
    }
    let written = unit.map(str::to_owned);
    match name {
        "omega" => return Ok(Column::Omega(frequency(unit.unwrap_or("rad/s"))?)),
        "frequency" => {
            let unit = unit.ok_or("say its unit: [Hz], [rpm] or [rad/s]")?;
            return Ok(Column::Omega(frequency(unit)?));
        }
        "sweep" => return Ok(Column::Sweep),
        "set" => return Ok(Column::Set),
        "sd" => return Ok(Column::Deviation(None, written)),
        _ => {}
    }
    let of = name.strip_prefix("sd of ").map(str::trim);
    let wanted = of.unwrap_or(name);
    if !wanted.contains(':') {
        let names: Vec<&str> = model
            .parameters
            .iter()
            .map(|parameter| parameter.name.as_str())
            .collect();
        return Err(format!(
            "it is neither `omega`, `frequency [Hz]`, something measured as `x:p2p`, `sd`, `sweep`, `set`, nor a parameter; parameters are {}",
            names.join(", ")
        ));
    }
    let wanted: Wanted = wanted
        .parse()
        .map_err(|error: hertzian::RequestError| error.to_string())?;
    model.check(&wanted).map_err(|error| error.to_string())?;
    if of.is_some() {
        return Ok(Column::Deviation(Some(wanted), written));
    }
    let factor = factor(&wanted.measure.unit(model.unit_of(&wanted.name)))?;
    Ok(Column::Measured(wanted, factor, written))
}

/// The factor to radians per unit of time.
fn frequency(unit: &str) -> Result<f64, String> {
    match unit {
        "rad/s" | "1/s" => Ok(1.0),
        "Hz" => Ok(TAU),
        "kHz" => Ok(1e3 * TAU),
        "rpm" => Ok(TAU / 60.0),
        _ => Err(format!(
            "[{unit}] is no unit of a frequency: take [Hz], [kHz], [rpm] or [rad/s]"
        )),
    }
}

/// The columns that are measured.
fn measured(columns: &[Column]) -> impl Iterator<Item = (usize, &Wanted)> {
    let columns = columns.iter().enumerate();
    columns.filter_map(|(index, column)| match column {
        Column::Measured(wanted, ..) => Some((index, wanted)),
        _ => None,
    })
}

/// The column of what was varied.
fn varied(columns: &[Column]) -> Result<usize, String> {
    let omega = columns
        .iter()
        .position(|column| matches!(column, Column::Omega(_)));
    let parameter = || {
        columns
            .iter()
            .position(|column| matches!(column, Column::Parameter(..)))
    };
    omega.or_else(parameter).ok_or_else(|| {
        "no column says where it was measured: name one `omega`, `frequency [Hz]`, or as the parameter that was varied".to_owned()
    })
}

/// Takes a row in.
fn take(
    record: &csv::StringRecord,
    columns: &[Column],
    varied: usize,
    sets: &mut Vec<(Key, Rows)>,
) -> Result<(), String> {
    if record.len() != columns.len() {
        return Err(format!(
            "{} cells, and {} columns in the header",
            record.len(),
            columns.len()
        ));
    }
    let number = |index: usize| -> Result<f64, String> {
        let cell = &record[index];
        let value: Option<f64> = cell.parse().ok();
        let value = value.filter(|value| value.is_finite());
        value.ok_or_else(|| format!("`{cell}` in column {} is not a number", index + 1))
    };
    let (mut name, mut sweep) = (String::new(), 0);
    let mut settings = Vec::new();
    let mut deviations: BTreeMap<String, f64> = BTreeMap::new();
    for (index, column) in columns.iter().enumerate() {
        match column {
            Column::Set => record[index].clone_into(&mut name),
            Column::Sweep => sweep = sweep_of(&record[index])?,
            Column::Parameter(_, factor) if index != varied => {
                settings.push((number(index)? * factor).to_bits());
            }
            Column::Deviation(of, _) if !record[index].is_empty() => {
                let deviation = number(index)?;
                if deviation <= 0.0 {
                    return Err(format!(
                        "a standard deviation is {deviation}: it must be positive"
                    ));
                }
                deviations.insert(
                    of.as_ref().map_or(String::new(), ToString::to_string),
                    deviation,
                );
            }
            _ => {}
        }
    }
    let place = number(varied)?
        * match &columns[varied] {
            Column::Omega(factor) | Column::Parameter(_, factor) => *factor,
            _ => 1.0,
        };
    for (index, column) in columns.iter().enumerate() {
        let Column::Measured(wanted, factor, _) = column else {
            continue;
        };
        if record[index].is_empty() {
            continue;
        }
        let of = deviations
            .get(&wanted.to_string())
            .or_else(|| deviations.get(""));
        let has_column = columns.iter().any(|column| match column {
            Column::Deviation(of, _) => of.as_ref().is_none_or(|of| of == wanted),
            _ => false,
        });
        if has_column && of.is_none() {
            return Err(format!("{wanted} has no standard deviation here"));
        }
        let key: Key = (name.clone(), sweep, settings.clone(), index);
        let known = sets.iter().position(|(known, _)| *known == key);
        let known = known.unwrap_or_else(|| {
            sets.push((key, Rows::default()));
            sets.len() - 1
        });
        let rows = &mut sets[known].1;
        rows.places.push(place);
        rows.values.push(number(index)? * factor);
        rows.deviations
            .extend(of.map(|deviation| deviation * factor));
    }
    Ok(())
}

/// Words for sweeps; the first of each is how a set is named.
const SWEEPS: [(&[&str], Sweep); 4] = [
    (&["settled", ""], Sweep::Settled),
    (&["rising", "up"], Sweep::Rising),
    (&["falling", "down"], Sweep::Falling),
    (&["controlled"], Sweep::Controlled),
];

fn sweep_of(cell: &str) -> Result<usize, String> {
    let known = SWEEPS.iter().position(|(words, _)| words.contains(&cell));
    known.ok_or_else(|| format!("`{cell}` is no sweep: rising, falling, settled or controlled"))
}

fn set(key: &Key, rows: Rows, columns: &[Column], varied: usize, omega: Option<f64>) -> DataSet {
    let (name, sweep, settings, measured) = key;
    let wanted = match &columns[*measured] {
        Column::Measured(wanted, ..) => wanted.to_string(),
        _ => String::new(),
    };
    let (words, sweep) = SWEEPS[*sweep];
    let mut words: Vec<String> = vec![
        wanted.clone(),
        if sweep == Sweep::Settled {
            String::new()
        } else {
            words[0].to_owned()
        },
    ];
    let mut set = DataSet::new(wanted, rows.places, rows.values).sweep(sweep);
    let others = columns
        .iter()
        .enumerate()
        .filter(|(index, _)| *index != varied);
    let parameters = others.filter_map(|(_, column)| match column {
        Column::Parameter(name, _) => Some(name),
        _ => None,
    });
    for (parameter, bits) in parameters.zip(settings) {
        let value = f64::from_bits(*bits);
        words.push(format!("{parameter}={value}"));
        set = set.at(parameter, value);
    }
    if let (Column::Parameter(parameter, _), Some(omega)) = (&columns[varied], omega) {
        set = set.varied(parameter, omega);
    } else if let Column::Parameter(parameter, _) = &columns[varied] {
        set = set.varied(parameter, f64::NAN);
    }
    if !rows.deviations.is_empty() {
        set = set.deviations(rows.deviations);
    }
    words.push(name.clone());
    words.retain(|word| !word.is_empty());
    set.named(words.join(" "))
}
