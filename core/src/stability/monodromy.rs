//! The monodromy matrix of an orbit, integrated from switch to switch.
//!
//! Perturbations of an orbit of the system (1) of [`system`](crate::system) obey, with phase derivatives and the state
//! `(q, dq/dtau)`,
//!
//! ```text
//! Y' = [        0                   I       ]
//!      [ -M^-1 S / Omega^2   -M^-1 T / Omega ] Y                                                             (1)
//! S = K + sum_c e_c (phi_g d_c + phi_r dd_c/dt),    T = C + sum_c e_c phi_r d_c                              (2)
//! ```
//!
//! between the phases at which a gap crosses a level. At such a phase the field jumps by that of the force, `[phi]`, and
//! perturbations by the saltation matrix
//!
//! ```text
//! I - [ 0 ; M^-1 e_c [phi] / (Omega g') ] [ d_c^T  0 ]                                                       (3)
//! ```
//!
//! where `g'` is the rate of the gap: positive or negative, but the same on both sides. On each panel the steps are those
//! of [`magnus`](super::magnus), and are graded towards the ends where the stiffness is a broken power of the distance.
//!
//! Sources: Leine and Nijmeijer (2004), Dynamics and Bifurcations of Non-Smooth Mechanical Systems, chapter 7
//! (saltation); Blanes et al. (2009) (steps).

use std::f64::consts::TAU;

use nalgebra::allocator::Allocator;
use nalgebra::{Complex, Const, DMatrix, DefaultAllocator, Dim, Dyn, OMatrix};

use super::method::{Cost, Floquet, Found};
use super::orbit::Orbit;
use super::{distance, eigenvalues, magnus};
use crate::balance::{gap_series, rate_series};
use crate::fourier::crossings::{Crossing, crossings};
use crate::fourier::grading::Grading;
use crate::fourier::series;
use crate::law::{Derivatives, On, Quantity, TermFacts, Variation};
use crate::layout::Term;
use crate::system::{Part, Wave};

/// Steps per period at first.
const FIRST_DENSITY: f64 = 16.0;
/// Steps per period at most.
const LARGEST_DENSITY: f64 = 1024.0;

/// Integrates orbits, one after the other.
#[derive(Debug)]
pub(crate) struct Monodromy {
    /// Steps per period that sufficed for the last orbit.
    density: f64,
    cost: Cost,
}

impl Monodromy {
    pub(crate) fn new() -> Self {
        Self {
            density: FIRST_DENSITY,
            cost: Cost::default(),
        }
    }

    fn integrate(&mut self, panels: &Panels<'_>, density: f64) -> Vec<Complex<f64>> {
        let matrix = panels.monodromy(density);
        self.cost.spectra += 1;
        self.cost.order = self.cost.order.max(matrix.nrows());
        eigenvalues(&matrix)
    }
}

impl Floquet for Monodromy {
    /// Halves the steps until that changes the multipliers little.
    fn multipliers(&mut self, orbit: &Orbit<'_>, aim: f64) -> Found {
        let Some(panels) = Panels::new(*orbit) else {
            return Found::NOTHING;
        };
        let mut density = self.density;
        let mut coarse = self.integrate(&panels, 0.5 * density);
        let mut fine = self.integrate(&panels, density);
        loop {
            let change = distance(&coarse, &fine);
            if change <= aim || density >= LARGEST_DENSITY {
                // Steps that are far shorter than needed are lengthened for the next orbit.
                let shorter = change < 1e-3 * aim && density > FIRST_DENSITY;
                self.density = if shorter { 0.5 * density } else { density };
                return Found {
                    multipliers: fine,
                    error: change,
                };
            }
            density *= 2.0;
            coarse = std::mem::replace(&mut fine, self.integrate(&panels, density));
        }
    }

    fn cost(&self) -> Cost {
        self.cost
    }
}

/// A gap crosses a level.
#[derive(Debug, Clone, Copy)]
struct Switch {
    tau: f64,
    contact: usize,
    level: usize,
    rising: bool,
}

/// What the integration needs of one contact.
struct Contact<'a> {
    layout: &'a crate::layout::ContactLayout,
    arguments: Vec<f64>,
    levels: Vec<f64>,
    gap: Vec<f64>,
    rate: Vec<f64>,
    /// Its gap crosses a level.
    switching: bool,
}

/// An orbit cut into panels.
pub(crate) struct Panels<'a> {
    orbit: Orbit<'a>,
    contacts: Vec<Contact<'a>>,
    switches: Vec<Switch>,
    inverse_mass: DMatrix<f64>,
}

impl<'a> Panels<'a> {
    /// Cuts an orbit at its switches. `None` if the mass matrix is singular.
    pub(crate) fn new(orbit: Orbit<'a>) -> Option<Self> {
        let n = orbit.layout.coordinates;
        let mut mass = DMatrix::zeros(n, n);
        for entry in &orbit.layout.mass {
            mass[(entry.row, entry.column)] += orbit.coefficients[entry.coefficient];
        }
        let mut contacts: Vec<_> = orbit
            .layout
            .contacts
            .iter()
            .map(|layout| Contact::new(&orbit, layout))
            .collect();
        let mut switches = Vec::new();
        for (index, contact) in contacts.iter_mut().enumerate() {
            let before = switches.len();
            contact.switches(index, &mut switches);
            contact.switching = switches.len() > before;
        }
        switches.sort_by(|a, b| a.tau.total_cmp(&b.tau));
        Some(Self {
            orbit,
            contacts,
            switches,
            inverse_mass: mass.try_inverse()?,
        })
    }

    /// The monodromy matrix over one period of the orbit, with this many steps per period on panels that need steps.
    pub(crate) fn monodromy(&self, density: f64) -> DMatrix<f64> {
        let dense = |entries: Vec<f64>, order| DMatrix::from_vec(order, order, entries);
        match self.orbit.layout.coordinates {
            1 => dense(self.integrate(Const::<2>, density).as_slice().to_vec(), 2),
            n => dense(
                self.integrate(Dyn(2 * n), density).as_slice().to_vec(),
                2 * n,
            ),
        }
    }

    fn integrate<D: Dim>(&self, order: D, density: f64) -> OMatrix<f64, D, D>
    where
        DefaultAllocator: Allocator<D, D>,
    {
        let mut product = OMatrix::identity_generic(order, order);
        let Some(first) = self.switches.first() else {
            return self.panel(order, (0.0, TAU), Grading::NONE, density, product);
        };
        // The period begins at a switch, so that every panel lies between two of them.
        let closing = Switch {
            tau: first.tau + TAU,
            ..*first
        };
        let ends = self.switches[1..].iter().chain(std::iter::once(&closing));
        for (from, to) in self.switches.iter().zip(ends) {
            let exponent = self.exponent(from).min(self.exponent(to));
            let grading = Grading::for_exponent(exponent);
            product = self.panel(order, (from.tau, to.tau), grading, density, product);
            product = self.saltation(order, to) * product;
        }
        product
    }

    /// Smallest exponent with which a derivative of the force behaves at a switch, on either of its sides.
    fn exponent(&self, switch: &Switch) -> f64 {
        let contact = &self.contacts[switch.contact];
        let facts = self.orbit.system.law(contact.layout.law).facts();
        let derivative = |term: &&TermFacts| matches!(term.of, Quantity::ByGap | Quantity::ByRate);
        let below = facts.pieces[switch.level]
            .terms
            .iter()
            .filter(derivative)
            .map(|term| term.upper);
        let above = facts.pieces[switch.level + 1]
            .terms
            .iter()
            .filter(derivative)
            .map(|term| term.lower);
        below
            .chain(above)
            .map(|exponent| exponent.value(&contact.arguments))
            .filter(|exponent| exponent.fract() != 0.0 || *exponent < 0.0)
            .fold(f64::INFINITY, f64::min)
    }

    /// The solution at the end of a panel, from that at its start.
    fn panel<D: Dim>(
        &self,
        order: D,
        (start, end): (f64, f64),
        grading: Grading,
        density: f64,
        mut product: OMatrix<f64, D, D>,
    ) -> OMatrix<f64, D, D>
    where
        DefaultAllocator: Allocator<D, D>,
    {
        let width = end - start;
        if width <= 0.0 {
            return product;
        }
        let pieces: Vec<usize> = self
            .contacts
            .iter()
            .map(|contact| contact.piece(contact.switching.then_some(0.5 * (start + end))))
            .collect();
        let constant = self.is_constant(&pieces);
        let steps = if constant {
            1
        } else {
            ((density * width / TAU).ceil() as usize).max(4)
        };
        let grading = if constant { Grading::NONE } else { grading };
        let h = 1.0 / steps as f64;
        let nodes: Vec<_> = (0..steps)
            .flat_map(|step| {
                magnus::NODES.map(|node| grading.map((step as f64 + node) * h, start, end))
            })
            .collect();
        let taus: Vec<f64> = nodes.iter().map(|node| node.tau).collect();
        let slopes = self.slopes(&pieces, &taus);
        for step in 0..steps {
            let scaled = [0, 1, 2].map(|node| {
                let index = 3 * step + node;
                self.matrix(order, taus[index], &slopes, index) * (h * nodes[index].slope)
            });
            product = magnus::step(&scaled) * product;
        }
        product
    }

    /// Whether the matrix of (1) is the same everywhere on a panel.
    fn is_constant(&self, pieces: &[usize]) -> bool {
        let constant = |wave: Wave| wave.harmonic == 0;
        let contacts = self.contacts.iter().zip(pieces).all(|(contact, &piece)| {
            let facts = &self.orbit.system.law(contact.layout.law).facts().pieces[piece];
            let waves = contact.layout.force.iter().chain(&contact.layout.gap);
            let vanishes = facts.by_gap == Variation::Zero && facts.by_rate == Variation::Zero;
            vanishes
                || facts.by_gap != Variation::Varying
                    && facts.by_rate != Variation::Varying
                    && waves.into_iter().all(|term| constant(term.wave))
        });
        contacts
            && self
                .orbit
                .layout
                .stiffness
                .iter()
                .all(|entry| constant(entry.wave))
    }

    /// `(phi_g, phi_r)` of every contact at the phases.
    fn slopes(&self, pieces: &[usize], taus: &[f64]) -> Vec<[Vec<f64>; 2]> {
        let room = || vec![0.0; taus.len()];
        let (mut gap, mut rate, mut force) = (room(), room(), room());
        let contacts = self.contacts.iter().zip(pieces);
        contacts
            .map(|(contact, &piece)| {
                for (index, &tau) in taus.iter().enumerate() {
                    gap[index] = series::value(&contact.gap, tau);
                    rate[index] = series::value(&contact.rate, tau);
                }
                let (mut by_gap, mut by_rate) = (room(), room());
                let out = Derivatives {
                    force: &mut force,
                    by_gap: &mut by_gap,
                    by_rate: &mut by_rate,
                };
                let law = self.orbit.system.law(contact.layout.law);
                law.derivatives(On::Piece(piece), &contact.arguments, &gap, &rate, out);
                [by_gap, by_rate]
            })
            .collect()
    }

    /// The matrix of (1) at a phase, with the contacts' derivatives taken from a batch.
    fn matrix<D: Dim>(
        &self,
        order: D,
        tau: f64,
        slopes: &[[Vec<f64>; 2]],
        index: usize,
    ) -> OMatrix<f64, D, D>
    where
        DefaultAllocator: Allocator<D, D>,
    {
        let Orbit {
            layout,
            coefficients,
            base,
            period,
            ..
        } = self.orbit;
        let n = layout.coordinates;
        let mut matrix = OMatrix::zeros_generic(order, order);
        for i in 0..n {
            matrix[(i, n + i)] = 1.0;
        }
        for entry in &layout.stiffness {
            let value = coefficients[entry.coefficient] * wave_at(entry.wave, period, tau);
            self.subtract(&mut matrix, entry.row, entry.column, value / (base * base));
        }
        for entry in &layout.damping {
            let value = coefficients[entry.coefficient];
            self.subtract(&mut matrix, entry.row, n + entry.column, value / base);
        }
        for (contact, [by_gap, by_rate]) in self.contacts.iter().zip(slopes) {
            let (by_gap, by_rate) = (by_gap[index], by_rate[index]);
            for e in &contact.layout.force {
                let e_value = self.direction(e, tau);
                for d in &contact.layout.gap {
                    let d_value = self.direction(d, tau);
                    let d_slope = coefficients[d.coefficient] * slope_at(d.wave, period, tau);
                    let stiffness = e_value * (by_gap * d_value / base + by_rate * d_slope) / base;
                    self.subtract(&mut matrix, e.index, d.index, stiffness);
                    let damping = e_value * by_rate * d_value / base;
                    self.subtract(&mut matrix, e.index, n + d.index, damping);
                }
            }
        }
        matrix
    }

    /// Subtracts `M^-1` times a force `value` on equation `row` from a column of the lower half.
    fn subtract<D: Dim>(
        &self,
        matrix: &mut OMatrix<f64, D, D>,
        row: usize,
        column: usize,
        value: f64,
    ) where
        DefaultAllocator: Allocator<D, D>,
    {
        let n = self.orbit.layout.coordinates;
        for i in 0..n {
            matrix[(n + i, column)] -= self.inverse_mass[(i, row)] * value;
        }
    }

    /// The saltation matrix (3).
    fn saltation<D: Dim>(&self, order: D, switch: &Switch) -> OMatrix<f64, D, D>
    where
        DefaultAllocator: Allocator<D, D>,
    {
        let mut matrix = OMatrix::identity_generic(order, order);
        let contact = &self.contacts[switch.contact];
        let law = self.orbit.system.law(contact.layout.law);
        let facts = law.facts().levels[switch.level];
        let rate = series::value(&contact.rate, switch.tau);
        if !(facts.force_jumps || facts.by_rate_jumps) || rate == 0.0 {
            return matrix;
        }
        let force = |piece| {
            let mut force = [0.0];
            let level = contact.levels[switch.level];
            law.force(
                On::Piece(piece),
                &contact.arguments,
                &[level],
                &[rate],
                &mut force,
            );
            force[0]
        };
        let (below, above) = (force(switch.level), force(switch.level + 1));
        let jump = if switch.rising {
            above - below
        } else {
            below - above
        };
        for e in &contact.layout.force {
            for d in &contact.layout.gap {
                let value = self.direction(e, switch.tau) * jump * self.direction(d, switch.tau);
                self.subtract(
                    &mut matrix,
                    e.index,
                    d.index,
                    value / (self.orbit.base * rate),
                );
            }
        }
        matrix
    }

    fn direction(&self, term: &Term, tau: f64) -> f64 {
        self.orbit.coefficients[term.coefficient] * wave_at(term.wave, self.orbit.period, tau)
    }
}

impl<'a> Contact<'a> {
    fn new(orbit: &Orbit<'a>, layout: &'a crate::layout::ContactLayout) -> Self {
        let law = orbit.system.law(layout.law);
        let mut arguments = vec![0.0; layout.argument_count];
        layout.arguments(orbit.coefficients, &mut arguments);
        let mut levels = vec![0.0; law.facts().levels.len()];
        law.levels(&arguments, &mut levels);
        let length = orbit.series.len() / orbit.layout.coordinates;
        let harmonics = series::harmonics(&orbit.series[..length]);
        let highest = (harmonics + layout.gap_harmonic() * orbit.period)
            .max(layout.offset_harmonic() * orbit.period);
        let mut gap = vec![0.0; series::length(highest)];
        gap_series(
            layout,
            orbit.coefficients,
            orbit.period,
            orbit.series,
            length,
            &mut gap,
        );
        let mut rate = gap.clone();
        rate_series(&gap, orbit.base, &mut rate);
        Self {
            layout,
            arguments,
            levels,
            gap,
            rate,
            switching: false,
        }
    }

    fn switches(&self, contact: usize, switches: &mut Vec<Switch>) {
        let mut found = Vec::new();
        for (level, &value) in self.levels.iter().enumerate() {
            found.clear();
            crossings(&self.gap, value, &mut found);
            switches.extend(found.iter().map(|&Crossing { tau, rising }| Switch {
                tau,
                contact,
                level,
                rising,
            }));
        }
    }

    /// The piece at a phase between switches; without any, that of the mean, for an orbit may touch a level at the phase.
    fn piece(&self, tau: Option<f64>) -> usize {
        let gap = tau.map_or(self.gap[0], |tau| series::value(&self.gap, tau));
        self.levels.iter().filter(|&&level| gap > level).count()
    }
}

/// Value of a wave at a phase of the orbit.
fn wave_at(wave: Wave, period: usize, tau: f64) -> f64 {
    if wave.harmonic == 0 {
        return 1.0;
    }
    let angle = f64::from(wave.harmonic) * period as f64 * tau;
    match wave.part {
        Part::Cosine => angle.cos(),
        Part::Sine => angle.sin(),
    }
}

/// Its phase derivative.
fn slope_at(wave: Wave, period: usize, tau: f64) -> f64 {
    if wave.harmonic == 0 {
        return 0.0;
    }
    let (slope, sign) = wave.derivative();
    sign * f64::from(wave.harmonic) * period as f64 * wave_at(slope, period, tau)
}
