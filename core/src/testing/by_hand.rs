//! The paper's oscillator written out by hand: the naive end of the chain of oracles, for tests of the runtime.
//!
//! `x'' + 2 zeta H(x) x' + H(x) sgn(x) |x|^alpha = A cos(omega t) + W`, Wang et al. (2021), Eq. (1).

use std::sync::Arc;

use crate::law::{
    ArgumentFacts, Derivatives, Exponent, Law, LawFacts, LevelFacts, On, Parts, PieceFacts,
    Quantity, RateDependence, TermFacts, Variation,
};
use crate::system::{ContactFacts, ParameterFacts, Place, System, SystemFacts, Variable, Wave};

/// The oscillator, with all its parameters at run time.
#[derive(Debug, Clone)]
pub(crate) struct PowerForm {
    pub(crate) values: [f64; 4],
    facts: SystemFacts,
    law: PowerLaw,
}

/// Its law: arguments `[zeta, alpha]`.
#[derive(Debug, Clone)]
struct PowerLaw {
    one_sided: bool,
    facts: LawFacts,
}

impl PowerForm {
    pub(crate) fn new(one_sided: bool, alpha: f64, zeta: f64, load: f64, drive: f64) -> Self {
        let (wave, contact) = (Wave::CONSTANT, 0);
        let places = [
            Place::Mass { row: 0, column: 0 },
            Place::Load { row: 0, wave },
            Place::Load {
                row: 0,
                wave: Wave::cosine(1),
            },
            Place::ForceDirection {
                contact,
                row: 0,
                wave,
            },
            Place::GapDirection {
                contact,
                column: 0,
                wave,
            },
            Place::Argument { contact, index: 0 },
            Place::Argument { contact, index: 1 },
        ];
        let facts = SystemFacts::new("PowerForm")
            .coordinates(["x"])
            .parameters(["zeta", "alpha", "load", "drive"].map(ParameterFacts::new))
            .contacts(1, [ContactFacts::new(0)])
            .places(places);
        let law = PowerLaw::new(one_sided);
        Self {
            values: [zeta, alpha, load, drive],
            facts,
            law,
        }
    }
}

/// The force is a power of the distance from the level, the stiffness one less; by the exponent, with a logarithm.
fn terms() -> Vec<TermFacts> {
    let term = |of, number, logarithm| {
        let exponent = Exponent::of_argument(number, 1);
        TermFacts::new(of, exponent, exponent).logarithm(logarithm)
    };
    vec![
        term(Quantity::Force, 0.0, false),
        term(Quantity::ByGap, -1.0, false),
        term(Quantity::ByArgument(1), 0.0, true),
    ]
}

impl PowerLaw {
    fn new(one_sided: bool) -> Self {
        let slopes = |piece: PieceFacts| piece.slopes(Variation::Varying, Variation::Constant);
        let closed = slopes(PieceFacts::smooth(2)).terms(terms());
        let open = if one_sided {
            PieceFacts::zero(2)
        } else {
            closed.clone()
        };
        let level = LevelFacts::default()
            .by_gap_jumps(true)
            .by_rate_jumps(one_sided)
            .unbounded_by_gap(true);
        let facts = LawFacts::new("contact", [level], [open, closed])
            .arguments(["zeta", "alpha"].map(|name| ArgumentFacts::named(name.into())))
            .rate(RateDependence::Linear)
            .odd(!one_sided);
        Self { one_sided, facts }
    }

    /// Force and derivatives by gap, rate, `zeta` and `alpha`.
    fn point(&self, on: On, [zeta, alpha]: [f64; 2], g: f64, r: f64) -> [f64; 5] {
        let above = match on {
            On::AllPieces => g > 0.0,
            On::Piece(piece) => piece == 1,
        };
        if self.one_sided && !above {
            return [0.0; 5];
        }
        let sign = if above { 1.0 } else { -1.0 };
        let size = (sign * g).max(0.0);
        let power = size.powf(alpha);
        let slope = if size > 0.0 {
            alpha * size.powf(alpha - 1.0)
        } else {
            0.0
        };
        let log = if size > 0.0 { power * size.ln() } else { 0.0 };
        [
            2.0 * zeta * r + sign * power,
            slope,
            2.0 * zeta,
            2.0 * r,
            sign * log,
        ]
    }
}

impl Law for PowerLaw {
    fn facts(&self) -> &LawFacts {
        &self.facts
    }

    fn levels(&self, _arguments: &[f64], levels: &mut [f64]) {
        levels[0] = 0.0;
    }

    fn levels_by(&self, _arguments: &[f64], _argument: usize, by_argument: &mut [f64]) {
        by_argument[0] = 0.0;
    }

    fn force(&self, on: On, a: &[f64], gap: &[f64], rate: &[f64], force: &mut [f64]) {
        for ((force, g), r) in force.iter_mut().zip(gap).zip(rate) {
            *force = self.point(on, [a[0], a[1]], *g, *r)[0];
        }
    }

    fn derivatives(&self, on: On, a: &[f64], gap: &[f64], rate: &[f64], out: Derivatives<'_>) {
        for (i, (g, r)) in gap.iter().zip(rate).enumerate() {
            let [force, by_gap, by_rate, ..] = self.point(on, [a[0], a[1]], *g, *r);
            (out.force[i], out.by_gap[i], out.by_rate[i]) = (force, by_gap, by_rate);
        }
    }

    fn derivatives_and_by(
        &self,
        argument: usize,
        on: On,
        a: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
        by_argument: &mut [f64],
    ) {
        self.derivatives(on, a, gap, rate, out);
        for (i, (g, r)) in gap.iter().zip(rate).enumerate() {
            by_argument[i] = self.point(on, [a[0], a[1]], *g, *r)[3 + argument];
        }
    }

    fn parts(&self) -> Option<Parts<'_>> {
        None
    }
}

impl System for PowerForm {
    fn facts(&self) -> &SystemFacts {
        &self.facts
    }

    fn values(&self, values: &mut [f64]) {
        values.copy_from_slice(&self.values);
    }

    fn coefficients(&self, p: &[f64], _omega: f64, coefficients: &mut [f64]) {
        coefficients.copy_from_slice(&[1.0, p[2], p[3], 1.0, 1.0, p[0], p[1]]);
    }

    fn coefficients_by(&self, variable: Variable, _p: &[f64], _omega: f64, out: &mut [f64]) {
        out.fill(0.0);
        match variable {
            Variable::Parameter(0) => out[5] = 1.0,
            Variable::Parameter(1) => out[6] = 1.0,
            Variable::Parameter(2) => out[1] = 1.0,
            Variable::Parameter(3) => out[2] = 1.0,
            Variable::Parameter(_) | Variable::Omega => {}
        }
    }

    fn law(&self, _index: usize) -> &dyn Law {
        &self.law
    }

    fn shared(&self) -> Arc<dyn System> {
        Arc::new(self.clone())
    }
}
