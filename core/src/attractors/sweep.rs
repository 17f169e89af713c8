//! Bifurcation diagrams by brute force: what a motion settles to as a parameter or the frequency changes in steps.
//!
//! At every value the motion goes on from the last state of the value before, so that it stays with its attractor as long as
//! there is one: a sweep up and a sweep down show hysteresis.

use super::failure;
use super::log::{Log, Reader, Writer};
use crate::error::Error;
use crate::model::request::RequestError;
use crate::model::validate;
use crate::system::Variable;
use crate::time::FlowError;
use crate::time::poincare::{Crossing, Section};
use crate::time::stroboscope::Stroboscope;

/// What is seen at more values would not fit into memory well.
const MOST_VALUES: usize = 1 << 24;

/// What is swept and what is kept.
///
/// ```
/// use hertzian::time::stroboscope::Stroboscope;
/// use hertzian::attractors::sweep::Sweep;
/// use hertzian::system::Variable;
///
/// hertzian::oscillator! {
///     Linear(x) {
///         param drive;
///         ddot(x) + 0.2*dot(x) + 4*x = drive*cos(omega*t);
///     }
/// }
///
/// let model = Linear { drive: 3.0 };
/// let sweep = Sweep {
///     variable: Variable::Omega,
///     values: Sweep::spread(0.5, 1.5, 5)?,
///     start: vec![0.0, 0.0],
///     transient: 100,
///     periods: 1,
///     escape: 1e6,
/// };
/// let mut map = Stroboscope::of(&model, 0.5)?;
/// let rows = sweep.run(&mut map, None, None, &mut |_| true)?;
/// for row in &rows {
///     // The amplitude of the cosine: 3 k / (k^2 + (0.2 omega)^2), k = 4 - omega^2
///     let k = 4.0 - row.value * row.value;
///     let expected = 3.0 * k / (k * k + (0.2 * row.value).powi(2));
///     assert!((row.points[0] - expected).abs() < 1e-9);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// What changes.
    pub variable: Variable,
    /// Its values, in order.
    pub values: Vec<f64>,
    /// Where the motion starts, and starts again after it has escaped.
    pub start: Vec<f64>,
    /// Applications of the map that are dropped at every value.
    pub transient: usize,
    /// Applications of the map that are looked at after those.
    pub periods: usize,
    /// A state with an entry beyond this has escaped; infinite for none.
    pub escape: f64,
}

/// What was seen at one value.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Row {
    /// The value.
    pub value: f64,
    /// States, one after the other: of the stroboscope, or where the motion crossed a section.
    pub points: Vec<f64>,
    /// Why it has no points; the motion started again.
    pub ended: Option<Ended>,
    /// The state that the next value goes on from.
    #[cfg_attr(feature = "serde", serde(skip))]
    last: Vec<f64>,
}

/// Why nothing was seen at a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ended {
    /// The motion grew beyond the bound.
    Escaped,
    /// The variable cannot have this value, or the motion could not be computed.
    Failed(FlowError),
}

impl From<FlowError> for Ended {
    fn from(error: FlowError) -> Self {
        Self::Failed(error)
    }
}

impl std::fmt::Display for Ended {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Escaped => write!(f, "the motion grew beyond the bound"),
            Self::Failed(error) => error.fmt(f),
        }
    }
}

impl Sweep {
    /// Values at equal distances, both ends included.
    ///
    /// # Errors
    /// If there are more than 2^24 of them.
    pub fn spread(from: f64, to: f64, count: usize) -> Result<Vec<f64>, Error> {
        if count > MOST_VALUES {
            let (name, value) = ("values", count as f64);
            let must = "must be at most 2^24";
            return Err(RequestError::Option { name, value, must }.into());
        }
        let last = count.saturating_sub(1).max(1) as f64;
        let at = |i: usize| {
            let part = i as f64 / last;
            (1.0 - part) * from + part * to
        };
        Ok((0..count).map(at).collect())
    }

    /// Runs the sweep. Points are states of the stroboscope, or crossings of a section. What the log holds of this sweep is
    /// not computed again; what is computed is added to it. Ends early where `see` says so, after each new row.
    ///
    /// # Errors
    /// If a number of the request cannot be used, or the log cannot be written.
    pub fn run(
        &self,
        map: &mut Stroboscope,
        section: Option<&Section<'_>>,
        mut log: Option<&mut Log>,
        see: &mut dyn FnMut(&Row) -> bool,
    ) -> Result<Vec<Row>, Error> {
        self.check()?;
        let records = log.as_deref().map_or(&[][..], Log::records);
        let known = records.iter().map_while(|record| Row::read(record));
        let mut rows: Vec<Row> = known.take(self.values.len()).collect();
        let last = rows.last().map(|row| row.last.clone());
        let mut state = last.unwrap_or_else(|| self.start.clone());
        for &value in &self.values[rows.len()..] {
            let mut points = Vec::new();
            let ended = map.set(self.variable, value).map_err(Ended::from);
            let ended = ended.and_then(|()| self.row(map, section, &mut state, &mut points));
            let ended = ended.err();
            if ended.is_some() {
                points.clear();
                state.clone_from(&self.start);
            }
            let row = Row {
                value,
                points,
                ended,
                last: state.clone(),
            };
            if let Some(log) = &mut log {
                log.append(&row.written())?;
            }
            let goes_on = see(&row);
            rows.push(row);
            if !goes_on {
                break;
            }
        }
        Ok(rows)
    }

    fn check(&self) -> Result<(), Error> {
        validate::option(
            "values",
            self.values.len() as f64,
            0.0..=MOST_VALUES as f64,
            "must be at most 2^24",
        )?;
        validate::positive("escape", self.escape)?;
        for &entry in &self.start {
            validate::finite("start", entry)?;
        }
        Ok(())
    }

    /// One value.
    fn row(
        &self,
        map: &mut Stroboscope,
        section: Option<&Section<'_>>,
        state: &mut [f64],
        points: &mut Vec<f64>,
    ) -> Result<(), Ended> {
        for _ in 0..self.transient {
            map.map(state)?;
            self.stays(state)?;
        }
        for _ in 0..self.periods {
            if let Some(section) = section {
                let mut see = |crossing: Crossing<'_>| points.extend_from_slice(crossing.state);
                section.follow(map, state, map.stride(), &mut see)?;
            } else {
                map.map(state)?;
                points.extend_from_slice(state);
            }
            self.stays(state)?;
        }
        Ok(())
    }

    fn stays(&self, state: &[f64]) -> Result<(), Ended> {
        let inside = state.iter().all(|x| x.abs() <= self.escape);
        if inside { Ok(()) } else { Err(Ended::Escaped) }
    }
}

impl Row {
    fn written(&self) -> Vec<u8> {
        let mut writer = Writer::default();
        writer.numbers(&[self.value]);
        writer.numbers(&self.points);
        writer.numbers(&match self.ended {
            None => vec![],
            Some(Ended::Escaped) => vec![0.0],
            Some(Ended::Failed(error)) => failure::numbers(error).to_vec(),
        });
        writer.numbers(&self.last);
        writer.0
    }

    fn read(record: &[u8]) -> Option<Self> {
        let mut reader = Reader(record);
        Some(Self {
            value: *reader.numbers()?.first()?,
            points: reader.numbers()?,
            ended: match reader.numbers()?[..] {
                [] => None,
                [_] => Some(Ended::Escaped),
                [kind, a, b] => Some(Ended::Failed(failure::of_numbers([kind, a, b])?)),
                _ => return None,
            },
            last: reader.numbers()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::affine::Affine;
    use crate::time::poincare::Direction;

    crate::oscillator! {
        /// Wang et al. (2021), Eq. (1), one-sided, exponent one.
        OneSided(x) {
            param zeta in 0.0..;
            param load;
            param drive;
            law contact(gap) {
                gap > 0 => 2*zeta*dot(gap) + gap,
                else    => 0,
            }
            ddot(x) + contact(x) = drive*cos(omega*t) + load;
        }
    }

    const MODEL: OneSided = OneSided {
        zeta: 0.032,
        load: 1.0,
        drive: 1.0,
    };

    fn map() -> Stroboscope {
        let flow = Affine::new(&MODEL, &[0.032, 1.0, 1.0], 1.0).expect("affine");
        Stroboscope::new(Box::new(flow))
    }

    fn sweep(from: f64, to: f64, start: [f64; 2]) -> Sweep {
        Sweep {
            variable: Variable::Parameter(2),
            values: Sweep::spread(from, to, 26).expect("values"),
            start: start.to_vec(),
            transient: 400,
            periods: 4,
            escape: 1e6,
        }
    }

    /// States that differ.
    fn distinct(row: &Row) -> usize {
        let mut seen: Vec<f64> = Vec::new();
        for x in row.points.chunks(2).map(|state| state[0]) {
            if seen.iter().all(|y| (x - y).abs() > 1e-3) {
                seen.push(x);
            }
        }
        seen.len()
    }

    /// Period one doubles at A = 1.282584168, and a period two ends in a fold at A = 0.294528806 (exact values, computed
    /// independently of this project); between them both are stable.
    #[test]
    fn up_and_down_show_the_hysteresis() {
        let run = |sweep: Sweep| {
            sweep
                .run(&mut map(), None, None, &mut |_| true)
                .expect("rows")
        };
        let up = run(sweep(0.2, 1.45, [0.5, 0.0]));
        let down = run(sweep(1.0, 0.2, [-5.632, 3.5266]));
        // Beside a bifurcation the transient is long.
        for row in up.iter().filter(|row| (row.value - 1.282_584).abs() > 0.02) {
            let doubled = row.value > 1.282_584;
            assert_eq!(distinct(row), 1 + usize::from(doubled), "{}", row.value);
        }
        for row in down
            .iter()
            .filter(|row| (row.value - 0.294_529).abs() > 0.02)
        {
            let before = row.value > 0.294_529;
            assert_eq!(distinct(row), 1 + usize::from(before), "{}", row.value);
        }
        assert!(up.iter().chain(&down).all(|row| row.ended.is_none()));
        // At A = 1: the exact states of both.
        let at_one = up.iter().find(|row| (row.value - 1.0).abs() < 1e-9);
        let first = at_one.expect("a row").points[0];
        assert!((first + 1.999_776_122_757_642_7).abs() < 1e-9, "{first}");
        let second = down[0].points[0].max(down[0].points[2]);
        assert!((second + 5.632_060_192_753_841).abs() < 1e-9, "{second}");
    }

    #[test]
    fn a_run_that_was_ended_goes_on_with_the_same_rows() {
        let sweep = sweep(1.0, 1.5, [0.5, 0.0]);
        let all = sweep
            .run(&mut map(), None, None, &mut |_| true)
            .expect("rows");
        let folder = std::env::temp_dir().join(format!("hertzian-sweep-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join("sweep");
        let _ = std::fs::remove_file(&path);
        let mut computed = 0;
        let mut rows = Vec::new();
        while rows.len() < all.len() {
            let mut log = Log::open(&path, "sweep").expect("a log");
            let before = computed;
            let mut see = |_: &Row| {
                computed += 1;
                computed - before < 10
            };
            rows = sweep
                .run(&mut map(), None, Some(&mut log), &mut see)
                .expect("rows");
        }
        assert_eq!(rows, all);
        assert_eq!(computed, all.len());
        let _ = std::fs::remove_dir_all(&folder);
    }

    #[test]
    fn values_beyond_what_memory_holds_are_refused() {
        for count in [MOST_VALUES + 1, usize::MAX] {
            let refused = Sweep::spread(0.0, 1.0, count);
            let refused = refused.expect_err("too many");
            assert!(matches!(
                refused.downcast_ref(),
                Some(RequestError::Option { name: "values", .. })
            ));
        }
        assert_eq!(Sweep::spread(0.0, 1.0, 3), Ok(vec![0.0, 0.5, 1.0]));
    }

    #[test]
    fn a_section_gives_its_crossings() {
        let sweep = Sweep {
            values: vec![1.0],
            ..sweep(1.0, 1.0, [-2.0, 0.18])
        };
        let section = Section::entry(0, 0.0, Direction::Rising);
        let rows = sweep.run(&mut map(), Some(&section), None, &mut |_| true);
        let row = &rows.expect("rows")[0];
        // Period one meets the contact once in each period, at one speed.
        assert_eq!(row.points.len(), 8);
        for state in row.points.chunks(2) {
            assert!(state[0].abs() < 1e-13 && (state[1] - row.points[1]).abs() < 1e-9);
        }
    }

    /// Without damping and at its own frequency an oscillator grows without bound.
    #[test]
    fn what_escapes_starts_again() {
        crate::oscillator! {
            Resonance(x) {
                param drive;
                ddot(x) + x = drive*cos(omega*t);
            }
        }
        let model = Resonance { drive: 1.0 };
        let flow = Affine::new(&model, &[1.0], 1.0).expect("affine");
        let sweep = Sweep {
            variable: Variable::Parameter(0),
            values: vec![1.0, 0.0],
            start: vec![1.0, 0.0],
            transient: 10,
            periods: 2,
            escape: 10.0,
        };
        let mut map = Stroboscope::new(Box::new(flow));
        let rows = sweep
            .run(&mut map, None, None, &mut |_| true)
            .expect("rows");
        assert_eq!(rows[0].ended, Some(Ended::Escaped));
        assert!(rows[0].points.is_empty());
        assert!(rows[1].ended.is_none() && (rows[1].points[0] - 1.0).abs() < 1e-12);
    }
}
