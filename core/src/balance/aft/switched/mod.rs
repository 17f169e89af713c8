//! Alternating frequency/time with exact switching: the law is integrated from crossing to crossing.
//!
//! With the phases `tau_c` at which the gap crosses a level known, the harmonics of the force are sums over the panels
//! between them,
//!
//! ```text
//! F_k = 1/pi sum over panels  int phi(g, r) e^(i k tau) dtau                                                  (1)
//! ```
//!
//! and no integrand has a jump or a kink inside a panel. A change `dg` of the gap moves the ends of the panels too: where
//! the force jumps by `[phi]` from below the level to above, `dtau_c = -(dg - dl) / g'` gives
//!
//! ```text
//! dF_k = 1/pi int (phi_g dg + phi_r dr) e^(i k tau) dtau
//!      + 1/pi sum over crossings  [phi] / |g'| (dg - dl) e^(i k tau_c)                                       (2)
//! ```
//!
//! so that a crossing adds an impulse of weight `[phi] / |g'|` to the series of `phi_g`, and the Jacobian is exact.
//!
//! Three ways lead to the integrals of (1): a closed form where the force is affine in gap and rate ([`affine`]), a rule
//! graded towards the ends where it is not ([`panel`]), and equally spaced samples where the orbit stays on one piece all
//! the period long ([`whole`]).
//!
//! Sources: Petrov and Ewins (2003), Analytical formulation of friction interface elements for analysis of nonlinear
//! multi-harmonic vibrations of bladed disks (exact transition points in harmonic balance); Krack, Panning-von Scheidt
//! and Wallaschek (2013), A high-order harmonic balance method for systems with distinct states.

mod affine;
mod cut;
mod panel;
mod spectrum;
#[cfg(test)]
mod tests;
mod whole;

use super::{Change, ContactDerivatives, ContactForces, ContactInput};
use crate::law::{On, Variation};
use crate::laws::generic::scales::{Scales, Sight};
use crate::laws::single;
use crate::numeric::fourier::crossings::levels::Switch;
use crate::numeric::fourier::kernels::Product;
use crate::numeric::fourier::series;
use affine::Affine;
use cut::Cut;
use panel::Quadrature;
use whole::Whole;

/// Workspace for one contact after the other; after the first few calls nothing is allocated.
#[derive(Debug, Default)]
pub(crate) struct SwitchedAft {
    cut: Cut,
    affine: Affine,
    quadrature: Quadrature,
    whole: Whole,
    product: Product,
    /// Where the laws met so far may be sharp; a law is known by the place of its facts.
    sharp: Vec<(usize, Option<Scales>)>,
}

/// Largest change from node to node, in the units of [`Scales`], with which the coefficients of the force fall and tell the rest.
const SEEN: f64 = 1.5;

/// Whether a law changes on a piece between nodes where they do not see it.
fn overlooks(scales: &mut Option<Scales>, piece: usize, [gap, rate]: [&[f64]; 2]) -> bool {
    let sight = |scales: &mut Scales| scales.look(piece, gap, rate, SEEN);
    scales.as_mut().map(sight) == Some(Sight::Missed)
}

/// What is summed up over the panels.
struct Sums<'s> {
    force: &'s mut [f64],
    slopes: Option<Slopes<'s>>,
}

/// The derivatives among it.
struct Slopes<'s> {
    by_gap: &'s mut [f64],
    by_rate: &'s mut [f64],
    by_parameter: &'s mut [f64],
    change: Option<Changing<'s>>,
}

/// How gap, rate and arguments change with the parameter.
#[derive(Clone, Copy)]
struct Changing<'s> {
    change: Change<'s>,
    /// Gap and rate do.
    motion: bool,
    /// Some argument does.
    arguments: bool,
}

impl<'s> Changing<'s> {
    fn of(change: Change<'s>) -> Self {
        let varies = |of: &[f64]| of.iter().any(|x| *x != 0.0);
        Self {
            motion: varies(change.gap) || varies(change.rate),
            arguments: varies(change.arguments),
            change,
        }
    }

    /// The arguments that change, and by how much.
    fn arguments(self) -> impl Iterator<Item = (usize, f64)> + 's {
        let all = self.change.arguments.iter().copied().enumerate();
        all.filter(|&(_, by)| by != 0.0)
    }
}

/// What is wanted at the nodes.
#[derive(Clone, Copy)]
enum Wanted<'s> {
    Force,
    Slopes,
    /// The slopes, and what the parameter changes.
    Changes(Changing<'s>),
}

impl Wanted<'_> {
    fn of<'s>(sums: &Sums<'s>) -> Wanted<'s> {
        match &sums.slopes {
            None => Wanted::Force,
            Some(slopes) => slopes.change.map_or(Wanted::Slopes, Wanted::Changes),
        }
    }
}

impl<'s> Slopes<'s> {
    /// Derivatives of the arguments by the parameter; empty if none is asked for.
    fn arguments(&self) -> &'s [f64] {
        self.change
            .map_or(&[], |changing| changing.change.arguments)
    }
}

impl ContactForces for SwitchedAft {
    fn operations(&self) -> u64 {
        self.affine.operations + self.quadrature.operations + self.whole.operations
    }

    fn force(&mut self, input: ContactInput<'_>, force: &mut [f64]) {
        force.fill(0.0);
        self.integrate(
            input,
            &mut Sums {
                force,
                slopes: None,
            },
        );
    }

    fn derivatives(
        &mut self,
        input: ContactInput<'_>,
        change: Option<Change<'_>>,
        force: &mut [f64],
        out: &mut ContactDerivatives<'_>,
    ) {
        force.fill(0.0);
        out.by_gap.fill(0.0);
        out.by_rate.fill(0.0);
        out.by_parameter.fill(0.0);
        let slopes = Slopes {
            by_gap: out.by_gap,
            by_rate: out.by_rate,
            by_parameter: out.by_parameter,
            change: change.map(Changing::of),
        };
        self.integrate(
            input,
            &mut Sums {
                force,
                slopes: Some(slopes),
            },
        );
        self.add_jumps(input, change, out);
    }
}

impl SwitchedAft {
    fn integrate(&mut self, input: ContactInput<'_>, sums: &mut Sums<'_>) {
        let facts = input.law.facts();
        self.cut.apply(input);
        let known = self.find_scales(input);
        let scales = &mut self.sharp[known].1;
        if let [whole] = self.cut.panels()
            && whole.is_period()
            && !facts.pieces[whole.piece].affine
        {
            self.whole.add(input, whole.piece, sums, scales);
            return;
        }
        for piece in 0..facts.pieces.len() {
            let of = &facts.pieces[piece];
            let panels = || self.cut.panels().iter().filter(move |p| p.piece == piece);
            if is_nothing(of) || panels().next().is_none() {
                continue;
            }
            if of.affine {
                let levels = self.cut.levels();
                self.affine
                    .add(input, levels, panels(), &mut self.product, sums);
            } else {
                for panel in panels() {
                    self.quadrature
                        .add(input, panel, self.cut.levels(), sums, scales);
                }
            }
        }
    }

    /// The position of the scales of a law, with the arguments at hand.
    fn find_scales(&mut self, input: ContactInput<'_>) -> usize {
        let facts = std::ptr::from_ref(input.law.facts()).addr();
        let known = self.sharp.iter().position(|(of, _)| *of == facts);
        let index = known.unwrap_or_else(|| {
            self.sharp.push((facts, Scales::of(input.law)));
            self.sharp.len() - 1
        });
        if let Some(scales) = &mut self.sharp[index].1 {
            scales.set(input.arguments, self.cut.levels());
        }
        index
    }

    /// Adds the impulses of (2).
    fn add_jumps(
        &mut self,
        input: ContactInput<'_>,
        change: Option<Change<'_>>,
        out: &mut ContactDerivatives<'_>,
    ) {
        for index in 0..self.cut.switches().len() {
            let Switch { tau, level, .. } = self.cut.switches()[index];
            let facts = &input.law.facts().levels[level];
            if !(facts.force_jumps || facts.by_rate_jumps) {
                continue;
            }
            let gap = self.cut.levels()[level];
            let slope = series::value_and_derivatives(input.gap, tau).1;
            let rate = input.base * slope;
            let at_level = |piece| {
                let on = On::Piece(piece);
                single::force(input.law, on, input.arguments, [gap, rate])
            };
            let weight = (at_level(level + 1) - at_level(level)) / slope.abs();
            if !weight.is_finite() {
                continue;
            }
            add_impulse(tau, weight, out.by_gap);
            if let Some(change) = change {
                let level = self.cut.level_by(input, level, change.arguments);
                let moved = series::value(change.gap, tau) - level;
                if moved != 0.0 {
                    add_impulse(tau, weight * moved, out.by_parameter);
                }
            }
        }
    }
}

/// Neither force nor derivatives on this piece.
fn is_nothing(piece: &crate::law::PieceFacts) -> bool {
    piece.force == Variation::Zero
}

/// Adds the series of `weight` times Dirac's impulse at a phase: `weight / pi (1/2 + sum cos k (tau - tau_c))`.
fn add_impulse(tau: f64, weight: f64, series: &mut [f64]) {
    let (sine, cosine) = tau.sin_cos();
    let scaled = weight * std::f64::consts::FRAC_1_PI;
    series[0] += 0.5 * scaled;
    let (mut c, mut s) = (scaled, 0.0);
    for pair in series[1..].chunks_exact_mut(2) {
        (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
        pair[0] += c;
        pair[1] += s;
    }
}
