//! The problems: curves with a fold that is known.

use hertzian::generic::Declaration;
use hertzian::system::System;

use crate::model::ModelOptions;
use crate::response::models::declared;

/// A curve and what is known of it.
pub struct Problem {
    /// Name of its files.
    pub id: &'static str,
    /// What it is.
    pub title: &'static str,
    /// The oscillator, compiled.
    pub compiled: Box<dyn System>,
    /// The same, interpreted.
    pub interpreted: Box<dyn System>,
    /// Frequencies at which the curve begins and ends.
    pub range: [f64; 2],
    /// All folds in the range.
    pub folds: &'static [f64],
    /// That of largest amplitude.
    pub fold: f64,
    /// Frequency at which the largest orbit is compared.
    pub at: f64,
}

/// Folds are from an independent computation: exponent one from the closed-form flow, the others by event-located integration, in
/// 80-bit arithmetic, with errors below 1e-12.
pub fn all() -> Vec<Problem> {
    vec![
        problem(
            ("one-sided-1", "one-sided, α = 1 (Fig. 5a)"),
            (1.0, true, 0.032, 1.0),
            [0.6, 1.4],
            (
                &[0.715_119_549_676_419, 0.960_163_671_878_57],
                0.715_119_549_676_419,
                0.8,
            ),
        ),
        problem(
            ("one-sided-1.5", "one-sided, α = 1.5 (Fig. 5b)"),
            (1.5, true, 0.032, 1.0),
            [0.6, 1.6],
            (
                &[0.685_842_253_572_486, 1.144_516_913_788_162],
                0.685_842_253_572_486,
                0.8,
            ),
        ),
        problem(
            ("one-sided-0.6", "one-sided, α = 0.6 (Fig. 5c)"),
            (0.6, true, 0.032, 1.0),
            [0.5, 1.2],
            (
                &[
                    0.845_526_217_725_541,
                    0.849_176_252_131_873,
                    0.631_308_249_440_869,
                    0.765_568_492_941_199,
                ],
                0.631_308_249_440_869,
                0.7,
            ),
        ),
        problem(
            ("continuous-1.5", "continuous, α = 1.5 (Fig. 2a)"),
            (1.5, false, 0.01, 0.0),
            [0.5, 1.7],
            (
                &[0.909_513_715_044_238, 1.332_696_002_393_464],
                1.332_696_002_393_464,
                1.2,
            ),
        ),
    ]
}

fn problem(
    (id, title): (&'static str, &'static str),
    (alpha, one_sided, zeta, load): (f64, bool, f64, f64),
    range: [f64; 2],
    (folds, fold, at): (&'static [f64], f64, f64),
) -> Problem {
    let options = ModelOptions {
        alpha,
        one_sided,
        continuous: !one_sided,
        file: None,
        set: Vec::new(),
        zeta,
        load,
        drive: 0.1,
        omega: 1.0,
    };
    Problem {
        id,
        title,
        compiled: declared(&options),
        interpreted: interpreted(&options),
        range,
        folds,
        fold,
        at,
    }
}

/// The same equation as the compiled one, with the same number as its exponent.
fn interpreted(options: &ModelOptions) -> Box<dyn System> {
    let ModelOptions {
        alpha,
        zeta,
        load,
        drive,
        ..
    } = options;
    let force = if options.one_sided {
        format!(
            "law contact(gap) {{ gap > 0 => 2*zeta*dot(gap) + gap^{alpha}, else => 0 }} ddot(x) + contact(x)"
        )
    } else {
        format!("ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^{alpha}")
    };
    let text = format!(
        "Spring(x) {{ param zeta = {zeta:?} in 0.0..; param load = {load:?}; param drive = {drive:?}; {force} = drive*cos(omega*t) + load; }}"
    );
    match Declaration::parse(&text) {
        Ok(model) => Box::new(model),
        // The compiled one, whose equation it is, has passed the same front end.
        Err(_) => declared(options),
    }
}
