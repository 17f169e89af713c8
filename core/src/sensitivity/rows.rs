//! What is read off orbits, row by row.

use super::Missing;
use super::sample_phases::Needs;
use super::slopes::signals::Asked;
use crate::branches::branch::{Model, Source};
use crate::error::Error;
use crate::model::request::RequestError;
use crate::orbit::observe::{Measure, Wanted};

/// Harmonics that are read off where nothing is asked for by name.
const HARMONICS: usize = 5;

/// What is read of which signal.
#[derive(Debug, Clone)]
pub(super) struct Row {
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) asked: Asked,
    pub(super) measure: Measure,
}

/// Everything that is read off.
pub(super) fn all(model: &Model) -> Vec<Row> {
    let mut measures = Measure::USUAL.to_vec();
    let harmonics = (1..=HARMONICS).flat_map(|h| [Measure::Amplitude(h), Measure::Phase(h)]);
    measures.extend(harmonics);
    let outputs = model.outputs.iter().map(|output| &output.name);
    let moving: Vec<&String> = outputs.chain(&model.coordinates).collect();
    let of_motions = moving.into_iter().flat_map(|name| {
        let measures = measures.iter();
        measures.map(|&measure| (name.clone(), measure))
    });
    let contacts = model.contacts.iter().zip(&model.pieces);
    let of_contacts = contacts.flat_map(|(name, &pieces)| {
        let usual = [
            Measure::Maximum,
            Measure::Minimum,
            Measure::Mean,
            Measure::Impulse,
        ];
        let pieces = (1..=pieces).map(Measure::OnPiece);
        let measures = usual.into_iter().chain(pieces);
        measures.map(|measure| (name.clone(), measure))
    });
    let wanted = of_motions.chain(of_contacts);
    let rows = wanted.filter_map(|(name, measure)| {
        let wanted = Wanted { name, measure };
        row(model, &wanted).ok()
    });
    let power = Row {
        name: "power".to_owned(),
        unit: String::new(),
        asked: Asked::Power,
        measure: Measure::Mean,
    };
    rows.chain([power]).collect()
}

/// What is asked for as rows, and what of it has no derivative at any orbit: a whole number.
///
/// # Errors
/// If nothing has such a name.
pub(super) fn with_derivatives(
    model: &Model,
    wanted: &[Wanted],
) -> Result<(Vec<Row>, Vec<Missing>), Error> {
    let (mut rows, mut missing) = (Vec::new(), Vec::new());
    for wanted in wanted {
        if wanted.measure == Measure::Impacts {
            model.check(wanted)?;
            let why = "a number of impacts is whole, and has no derivative";
            missing.push(Missing::new(wanted.to_string(), why));
        } else {
            rows.push(row(model, wanted)?);
        }
    }
    Ok((rows, missing))
}

/// What is asked for as a row.
///
/// # Errors
/// If nothing has that name, or it has no derivative.
pub(super) fn row(model: &Model, wanted: &Wanted) -> Result<Row, Error> {
    if let Some(row) = row_of_rate(model, wanted) {
        return Ok(row);
    }
    let source = model.measurable(wanted)?;
    if wanted.measure == Measure::Impacts {
        return Err(RequestError::NoContactMeasure {
            name: wanted.name.clone(),
            measure: wanted.measure.in_words(),
        }
        .into());
    }
    let unit = match source {
        Source::Output(index) => model.outputs[index].unit.clone(),
        Source::Coordinate(index) => model.units.get(index).cloned().unwrap_or_default(),
        Source::Contact(index) => model.force_units.get(index).cloned().unwrap_or_default(),
    };
    Ok(Row {
        name: wanted.to_string(),
        unit: wanted.measure.unit(&unit),
        asked: match source {
            Source::Output(index) => Asked::Output(index),
            Source::Coordinate(index) => Asked::Coordinate(index),
            Source::Contact(index) => Asked::Contact(index),
        },
        measure: wanted.measure,
    })
}

/// The rate `dot(x)` of a coordinate, or its acceleration `ddot(x)`.
fn row_of_rate(model: &Model, wanted: &Wanted) -> Option<Row> {
    let inside = |head: &str| wanted.name.strip_prefix(head)?.strip_suffix(')');
    let (name, asked): (&str, fn(usize) -> Asked) = match inside("ddot(") {
        Some(name) => (name, Asked::Acceleration),
        None => (inside("dot(")?, Asked::Rate),
    };
    let index = model.coordinates.iter().position(|own| own == name)?;
    let of_contact = matches!(
        wanted.measure,
        Measure::Impacts | Measure::Impulse | Measure::OnPiece(_)
    );
    let unit = model.units.get(index).filter(|unit| !unit.is_empty());
    let by = if asked(index) == Asked::Rate(index) {
        "s"
    } else {
        "s^2"
    };
    (!of_contact).then(|| Row {
        name: wanted.to_string(),
        unit: unit.map_or_else(String::new, |unit| {
            wanted.measure.unit(&format!("{unit}/{by}"))
        }),
        asked: asked(index),
        measure: wanted.measure,
    })
}

/// What must be computed for measures of signals.
pub(super) fn needs(rows: &[Row], asked: &[Asked], nodes: usize) -> Needs {
    let mut needs = Needs {
        extremes: false,
        integrals: false,
        harmonics: vec![0; asked.len()],
        nodes,
    };
    for row in rows {
        match row.measure {
            Measure::PeakToPeak | Measure::Maximum | Measure::Minimum => needs.extremes = true,
            Measure::CrestFactor => (needs.extremes, needs.integrals) = (true, true),
            Measure::Mean | Measure::Rms | Measure::Impulse => needs.integrals = true,
            Measure::Amplitude(h) | Measure::Phase(h) => {
                let signals = needs.harmonics.iter_mut().zip(asked);
                let own = signals.filter(|(_, asked)| **asked == row.asked);
                own.for_each(|(harmonics, _)| *harmonics = h.max(*harmonics));
            }
            _ => {}
        }
    }
    needs
}
