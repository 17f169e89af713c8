//! A system at values of its parameters and its frequency, in the pairs of its [linear part](super::linear), `y' = A y + ..`: contacts, and
//! waves of the load with their steady response `(i h Omega - A)^-1 b_h` (1), which a pair of states in resonance has not.
//!
//! Source: Meirovitch (2001), Fundamentals of Vibrations, section 7.15 (response of general systems by pairs of states).

use nalgebra::{Complex, DMatrix, DVector};

use super::block::{Block, Pair, times};
use super::configuration::{Affine, Kept};
use super::linear::{Linear, Seen, seen};
use crate::model::layout::{ContactLayout, Layout, Term, constant};
use crate::numeric::linear;
use crate::system::{Part, System};

/// A vector that moves with the phase, `sum_h a_h cos h tau + b_h sin h tau`.
#[derive(Debug, Clone, Default)]
pub(in crate::contact_equation) struct Moving {
    constant: Vec<f64>,
    waves: Vec<(f64, Vec<f64>, Vec<f64>)>,
}

impl Moving {
    fn add(&mut self, term: &Term, factor: f64, column: &[f64]) {
        if self.constant.is_empty() {
            self.constant = vec![0.0; column.len()];
        }
        let add = |to: &mut Vec<f64>| {
            for (to, x) in to.iter_mut().zip(column) {
                *to += factor * x;
            }
        };
        if term.wave.harmonic == 0 {
            add(&mut self.constant);
            return;
        }
        let harmonic = f64::from(term.wave.harmonic);
        let known = self.waves.iter().position(|(h, ..)| *h == harmonic);
        let place = known.unwrap_or_else(|| {
            let zero = vec![0.0; column.len()];
            self.waves.push((harmonic, zero.clone(), zero));
            self.waves.len() - 1
        });
        let (_, cosine, sine) = &mut self.waves[place];
        match term.wave.part {
            Part::Cosine => add(cosine),
            Part::Sine => add(sine),
        }
    }

    /// The largest entry that it may have.
    pub(in crate::contact_equation) fn size(&self) -> f64 {
        self.sizes().into_iter().fold(0.0, f64::max)
    }

    /// The largest that each entry may be.
    fn sizes(&self) -> Vec<f64> {
        let entries = 0..self.constant.len();
        let of = |i: usize| {
            let waves = self.waves.iter();
            let waves = waves.map(|(_, cosine, sine)| cosine[i].abs() + sine[i].abs());
            self.constant[i].abs() + waves.sum::<f64>()
        };
        entries.map(of).collect()
    }

    /// It does not move.
    pub(in crate::contact_equation) fn is_constant(&self) -> bool {
        self.waves.is_empty()
    }

    /// What does not move of it, if that is anything.
    pub(in crate::contact_equation) fn constant(&self) -> &[f64] {
        &self.constant
    }

    /// Writes a derivative by the phase; the zeroth is the vector.
    pub(in crate::contact_equation) fn write(&self, tau: f64, derivative: u32, to: &mut [f64]) {
        to.fill(0.0);
        if derivative == 0 {
            to[..self.constant.len()].copy_from_slice(&self.constant);
        }
        for (harmonic, cosine, sine) in &self.waves {
            let turns = derivative_of_turn(*harmonic, tau, derivative);
            for (i, to) in to.iter_mut().enumerate().take(cosine.len()) {
                *to += turns[0] * cosine[i] + turns[1] * sine[i];
            }
        }
    }

    /// The product of a derivative by the phase and other entries.
    fn dot(&self, tau: f64, derivative: u32, entries: &[f64]) -> f64 {
        let mut sum = if derivative == 0 {
            dot(&self.constant, entries)
        } else {
            0.0
        };
        for (harmonic, cosine, sine) in &self.waves {
            let turns = derivative_of_turn(*harmonic, tau, derivative);
            let [cosine, sine] = [cosine, sine].map(|of| linear::dot(of, entries));
            sum += turns[0] * cosine + turns[1] * sine;
        }
        sum
    }

    /// The highest harmonic.
    fn harmonic(&self) -> f64 {
        let harmonics = self.waves.iter().map(|(harmonic, ..)| *harmonic);
        harmonics.fold(0.0, f64::max)
    }

    /// Of a single entry.
    pub(in crate::contact_equation) fn value(&self, tau: f64, derivative: u32) -> f64 {
        if self.is_constant() {
            let value = if derivative == 0 {
                self.constant.first()
            } else {
                None
            };
            return value.copied().unwrap_or(0.0);
        }
        let mut to = [0.0];
        self.write(tau, derivative, &mut to);
        to[0]
    }
}

/// A derivative of cosine and sine of a harmonic of a phase, by that.
fn derivative_of_turn(harmonic: f64, tau: f64, derivative: u32) -> [f64; 2] {
    let (s, c) = (harmonic * tau).sin_cos();
    let turns = match derivative % 4 {
        0 => [c, s],
        1 => [-s, c],
        2 => [-c, -s],
        _ => [s, -c],
    };
    let factor = harmonic.powi(derivative as i32);
    turns.map(|x| factor * x)
}

/// A contact.
#[derive(Debug, Clone, Default)]
pub(in crate::contact_equation) struct Contact {
    pub(in crate::contact_equation) law: usize,
    pub(in crate::contact_equation) arguments: Vec<f64>,
    pub(in crate::contact_equation) levels: Vec<f64>,
    /// Whether the force jumps at them.
    pub(in crate::contact_equation) jumps: Vec<bool>,
    /// `T^-1 [0; M^-1 e]`: what a unit force does to the states, with the sign of the right-hand side.
    pub(in crate::contact_equation) input: Moving,
    /// `d . q` and `d . q'` as rows over the states.
    pub(in crate::contact_equation) gap: Moving,
    pub(in crate::contact_equation) rate: Moving,
    /// `delta`
    pub(super) offset: Moving,
    /// `d`, over the coordinates.
    direction: Moving,
    /// Unless one of these moves.
    pub(super) standing: Option<Standing>,
}

/// What of a contact does not move, over the coordinates.
#[derive(Debug, Clone)]
pub(super) struct Standing {
    /// `e`
    pub(in crate::contact_equation) force: DVector<f64>,
    /// `d`
    pub(in crate::contact_equation) gap: DVector<f64>,
    /// `delta`
    pub(super) offset: f64,
}

impl Contact {
    /// A gap on a piece: no farther than at its ends.
    pub(in crate::contact_equation) fn held(&self, piece: usize, gap: f64) -> f64 {
        let below = piece.checked_sub(1).map(|level| self.levels[level]);
        let above = self.levels.get(piece);
        gap.max(below.unwrap_or(f64::NEG_INFINITY))
            .min(above.copied().unwrap_or(f64::INFINITY))
    }

    /// An affine force at both ends of its piece: between them it is where it does not depend on the rate, else it is anywhere.
    pub(in crate::contact_equation) fn force_at_ends(
        &self,
        affine: &Affine,
        piece: usize,
    ) -> [f64; 2] {
        if affine.by_rate != 0.0 {
            return [f64::NEG_INFINITY, f64::INFINITY];
        }
        [f64::NEG_INFINITY, f64::INFINITY].map(|far| {
            let gap = self.held(piece, far);
            // Of a force that does not change with an infinite gap.
            let by = if affine.by_gap == 0.0 {
                0.0
            } else {
                affine.by_gap * (gap - affine.at)
            };
            affine.force + by
        })
    }

    /// The highest harmonic of what moves in its gap.
    pub(in crate::contact_equation) fn harmonic(&self) -> f64 {
        self.gap.harmonic().max(self.offset.harmonic())
    }

    /// Neither its direction nor its offset moves.
    pub(in crate::contact_equation) fn stands(&self) -> bool {
        self.gap.is_constant() && self.offset.is_constant()
    }

    /// Gap and rate at a phase that moves so fast, by positions and velocities: (2).
    pub(in crate::contact_equation) fn gap_of(
        &self,
        tau: f64,
        base: f64,
        state: &[f64],
    ) -> [f64; 2] {
        let (positions, velocities) = state.split_at(state.len() / 2);
        let of = |derivative: u32| {
            let offset = self.offset.value(tau, derivative);
            self.direction.dot(tau, derivative, positions) - offset
        };
        let rate = self.direction.dot(tau, 0, velocities);
        let turning = if self.stands() { 0.0 } else { of(1) };
        [of(0), rate + base * turning]
    }

    /// The same by the states of the linear part.
    pub(in crate::contact_equation) fn gap_in(
        &self,
        tau: f64,
        base: f64,
        states: &[f64],
    ) -> [f64; 2] {
        let of = |derivative: u32| {
            let offset = self.offset.value(tau, derivative);
            self.gap.dot(tau, derivative, states) - offset
        };
        let rate = self.rate.dot(tau, 0, states);
        let turning = if self.stands() { 0.0 } else { of(1) };
        [of(0), rate + base * turning]
    }

    /// The direction of one that stands, over the coordinates.
    pub(in crate::contact_equation) fn constant_direction(&self) -> &[f64] {
        &self.direction.constant
    }

    /// The offset of one that stands.
    pub(in crate::contact_equation) fn constant_offset(&self) -> f64 {
        self.offset.value(0.0, 0)
    }

    /// Gap and rate of one that stands, as what they see of the states.
    pub(in crate::contact_equation) fn row(&self) -> Vec<Seen> {
        let [gap, rate] = [&self.gap, &self.rate].map(|of| of.constant.iter().copied());
        seen(gap, rate)
    }

    /// The largest sizes that both rows may have.
    pub(in crate::contact_equation) fn largest(&self, base: f64) -> Vec<Seen> {
        let (gap, mut rate) = (self.gap.sizes(), self.rate.sizes());
        let turning = base * self.gap.harmonic();
        rate.resize(gap.len(), 0.0);
        for (rate, gap) in rate.iter_mut().zip(&gap) {
            *rate += turning * gap;
        }
        seen(gap.into_iter(), rate.into_iter())
    }

    /// Gap and rate in these states, and what they are of the states as rows. There is room for `another` row.
    ///
    /// ```text
    /// g = d . q - delta,    g' = d . q' + (d' . q - delta') tau'                                              (2)
    /// ```
    pub(in crate::contact_equation) fn output(
        &self,
        at: Instant,
        states: &[f64],
        [gap, rate]: [&mut [f64]; 2],
        another: &mut [f64],
    ) -> Output {
        let Instant {
            tau,
            base,
            by_omega,
        } = at;
        let stands = self.gap.is_constant() && self.offset.is_constant();
        if stands && self.gap.constant.len() == gap.len() {
            // Most contacts: nothing but the states counts.
            gap.copy_from_slice(&self.gap.constant);
            rate.copy_from_slice(&self.rate.constant);
            let offset = self.offset.constant.first().copied().unwrap_or(0.0);
            return Output {
                gap: dot(gap, states) - offset,
                rate: dot(rate, states),
                ..Output::default()
            };
        }
        self.gap.write(tau, 0, gap);
        self.rate.write(tau, 0, rate);
        let mut output = Output {
            gap: linear::dot(gap, states) - self.offset.value(tau, 0),
            rate: linear::dot(rate, states),
            ..Output::default()
        };
        if !self.gap.is_constant() {
            output.by_phase[1] = self.rate.dot(tau, 1, states);
            output.by_phase[1] += base * self.gap.dot(tau, 2, states);
            self.gap.write(tau, 1, another);
            output.by_phase[0] = linear::dot(another, states);
            for (rate, turning) in rate.iter_mut().zip(&*another) {
                *rate += base * turning;
            }
        }
        output.by_phase[0] -= self.offset.value(tau, 1);
        output.by_phase[1] -= base * self.offset.value(tau, 2);
        let turning = output.by_phase[0];
        output.rate += base * turning;
        output.by_omega = turning * by_omega;
        output
    }
}

/// A wave of the load.
#[derive(Debug, Clone)]
pub(in crate::contact_equation) struct Wave {
    pub(in crate::contact_equation) harmonic: f64,
    /// Per pair, the complex amplitude of what it does to the states.
    pub(in crate::contact_equation) input: Vec<[Complex<f64>; 2]>,
    /// Per state, the steady response and its derivative by the base frequency; zero in resonance.
    pub(in crate::contact_equation) steady: Vec<[Complex<f64>; 2]>,
    /// The pairs in resonance with it.
    pub(in crate::contact_equation) resonant: Vec<usize>,
}

impl Wave {
    /// Of what it does to the states.
    pub(in crate::contact_equation) fn new(harmonic: f64, input: &DVector<Complex<f64>>) -> Self {
        let pairs = input.as_slice().as_chunks().0;
        Self {
            harmonic,
            input: pairs.to_vec(),
            steady: vec![[Complex::new(0.0, 0.0); 2]; 2 * pairs.len()],
            resonant: Vec::new(),
        }
    }

    /// All pairs are in resonance with it.
    pub(in crate::contact_equation) fn is_resonant(&self) -> bool {
        2 * self.resonant.len() == self.steady.len()
    }

    /// It does not change, on a pair that nothing holds: states are a parabola.
    pub(in crate::contact_equation) fn is_constant_on(&self, block: &Block) -> bool {
        self.harmonic == 0.0 && block.is_free()
    }

    /// These states after a time from rest.
    fn parabola(&self, block: &Block, r: usize, time: f64) -> Pair {
        let input = self.input[r].map(|x| x.re);
        let moved = times(block.deviation, input);
        [0, 1].map(|i| time * (input[i] + 0.5 * time * moved[i]))
    }
}

/// Where a contact is looked at: the phase, how fast it moves, and how that changes with the frequency that is varied.
#[derive(Debug, Clone, Copy)]
pub(in crate::contact_equation) struct Instant {
    pub(in crate::contact_equation) tau: f64,
    pub(in crate::contact_equation) base: f64,
    pub(in crate::contact_equation) by_omega: f64,
}

/// Gap and rate of a contact, and their explicit derivatives by the phase; that of the rate by the varied frequency.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::contact_equation) struct Output {
    pub(in crate::contact_equation) gap: f64,
    pub(in crate::contact_equation) rate: f64,
    pub(in crate::contact_equation) by_phase: [f64; 2],
    pub(in crate::contact_equation) by_omega: f64,
}

/// Everything of a system at values of its parameters and its frequency.
#[derive(Debug, Clone)]
pub(in crate::contact_equation) struct Values {
    pub(in crate::contact_equation) linear: Linear,
    /// How fast the phase moves.
    pub(in crate::contact_equation) base: f64,
    pub(in crate::contact_equation) contacts: Vec<Contact>,
    pub(in crate::contact_equation) load: Vec<Wave>,
    /// Mass, damping and stiffness of the linear part.
    pub(in crate::contact_equation) matrices: [DMatrix<f64>; 3],
    /// More than the time changes along the branch.
    pub(in crate::contact_equation) changes: bool,
    /// The same while contacts are closed, as far as it was asked for.
    pub(super) kept: Kept,
}

impl Values {
    /// `None` where the mass is singular or the linear part has dependent eigenvectors.
    pub(in crate::contact_equation) fn new(
        system: &dyn System,
        layout: &Layout,
        parameters: &[f64],
        omega: f64,
    ) -> Option<Self> {
        let n = layout.coordinates;
        let mut coefficients = vec![0.0; layout.coefficients];
        system.coefficients(parameters, omega, &mut coefficients);
        let damping = constant(&layout.damping, &coefficients, n);
        let stiffness = constant(&layout.stiffness, &coefficients, n);
        let mass = layout.mass(&coefficients);
        let linear = Linear::new(&mass, &damping, &stiffness)?;
        let contacts = (0..layout.contacts.len())
            .map(|contact| self::contact(system, layout, &coefficients, &linear, contact))
            .collect();
        let load = self::load(layout, &coefficients, &linear);
        let mut values = Self {
            linear,
            base: 0.0,
            contacts,
            load,
            matrices: [mass, damping, stiffness],
            changes: true,
            kept: Kept::default(),
        };
        values.set_omega(omega, f64::from(system.facts().divisor));
        Some(values)
    }

    /// Goes over to another frequency, which no coefficient depends on.
    pub(in crate::contact_equation) fn set_omega(&mut self, omega: f64, divisor: f64) {
        self.set_base(omega / divisor);
    }

    /// The phase moves as fast as this.
    pub(in crate::contact_equation) fn set_base(&mut self, base: f64) {
        self.base = base;
        for wave in &mut self.load {
            let frequency = wave.harmonic * self.base;
            let pairs = wave.input.iter().zip(&self.linear.blocks);
            wave.resonant.clear();
            for (r, (input, block)) in pairs.enumerate() {
                let steady = block.steady(frequency, *input);
                if steady.is_none() {
                    wave.resonant.push(r);
                }
                let [response, by] = steady.unwrap_or_default();
                for i in 0..2 {
                    wave.steady[2 * r + i] = [response[i], by[i] * wave.harmonic];
                }
            }
        }
    }

    /// Number of states.
    pub(in crate::contact_equation) fn order(&self) -> usize {
        2 * self.linear.blocks.len()
    }

    /// Writes the steady response at a phase; and its derivatives by the phase, and by the base frequency.
    pub(in crate::contact_equation) fn write_steady(
        &self,
        tau: f64,
        value: &mut [f64],
        derivatives: Option<[&mut [f64]; 2]>,
    ) {
        value.fill(0.0);
        let mut derivatives = derivatives;
        if let Some(derivatives) = &mut derivatives {
            for of in derivatives.iter_mut() {
                of.fill(0.0);
            }
        }
        for wave in &self.load {
            if wave.is_resonant() {
                continue;
            }
            let turn = turn(wave.harmonic * tau);
            for (i, [response, by]) in wave.steady.iter().enumerate() {
                value[i] += turn.re * response.re - turn.im * response.im;
                if let Some([by_phase, by_base]) = &mut derivatives {
                    by_phase[i] -= wave.harmonic * (turn.re * response.im + turn.im * response.re);
                    by_base[i] += turn.re * by.re - turn.im * by.im;
                }
            }
        }
    }

    /// The steady response of a pair at a phase.
    pub(in crate::contact_equation) fn steady(&self, r: usize, tau: f64) -> Pair {
        let mut sum = [0.0; 2];
        for wave in &self.load {
            let turn = turn(wave.harmonic * tau);
            for (i, sum) in sum.iter_mut().enumerate() {
                *sum += (turn * wave.steady[2 * r + i][0]).re;
            }
        }
        sum
    }

    /// Whether there are waves in resonance.
    pub(in crate::contact_equation) fn has_resonance(&self) -> bool {
        self.load.iter().any(|wave| !wave.resonant.is_empty())
    }

    /// Adds what waves in resonance do to the states within a time from rest at a phase.
    pub(in crate::contact_equation) fn add_resonant(
        &self,
        tau: f64,
        time: f64,
        states: &mut [f64],
    ) {
        for wave in &self.load {
            for &r in &wave.resonant {
                let block = &self.linear.blocks[r];
                let state = if wave.is_constant_on(block) {
                    wave.parabola(block, r, time)
                } else {
                    self.resonance(wave, r, [tau, time])[0]
                };
                for i in 0..2 {
                    states[2 * r + i] += state[i];
                }
            }
        }
    }

    /// What a wave in resonance does to a pair within a time from rest at a phase: states, and their derivatives by the time, by the phase
    /// where it begins, and by the base frequency.
    pub(in crate::contact_equation) fn resonance(
        &self,
        wave: &Wave,
        r: usize,
        [tau, time]: [f64; 2],
    ) -> [Pair; 4] {
        let begun = wave.harmonic * tau;
        let later = turn(begun + wave.harmonic * self.base * time);
        let turn = turn(begun);
        let (block, input) = (&self.linear.blocks[r], wave.input[r]);
        let [p, k, p_by, k_by] = block.response_at_rest(wave.harmonic * self.base, time);
        let d = block.deviation;
        let turned = |i: usize| input[0] * d[i][0] + input[1] * d[i][1];
        let state = [0, 1].map(|i| turn * (p * input[i] + k * turned(i)));
        let by_time = [0, 1].map(|i| {
            let a = block.matrix[i];
            (state[0] * a[0] + state[1] * a[1] + later * input[i]).re
        });
        let by_base = |i: usize| turn * wave.harmonic * (p_by * input[i] + k_by * turned(i));
        [
            state.map(|x| x.re),
            by_time,
            state.map(|x| (x * Complex::new(0.0, wave.harmonic)).re),
            [0, 1].map(|i| by_base(i).re),
        ]
    }
}

fn contact(
    system: &dyn System,
    layout: &Layout,
    coefficients: &[f64],
    linear: &Linear,
    index: usize,
) -> Contact {
    let of = &layout.contacts[index];
    let law = system.law(of.law);
    let mut contact = Contact {
        law: of.law,
        arguments: vec![0.0; of.argument_count],
        levels: vec![0.0; law.facts().levels.len()],
        jumps: law
            .facts()
            .levels
            .iter()
            .map(|level| level.force_jumps)
            .collect(),
        ..Contact::default()
    };
    of.arguments(coefficients, &mut contact.arguments);
    law.levels(&contact.arguments, &mut contact.levels);
    let column = |matrix: &DMatrix<f64>, i: usize| matrix.column(i).as_slice().to_vec();
    let row =
        |matrix: &DMatrix<f64>, i: usize| -> Vec<f64> { matrix.row(i).iter().copied().collect() };
    for term in &of.force {
        let states = column(&linear.input, term.index);
        contact
            .input
            .add(term, -coefficients[term.coefficient], &states);
    }
    let mut unit = vec![0.0; layout.coordinates];
    for term in &of.gap {
        let factor = coefficients[term.coefficient];
        unit[term.index] = 1.0;
        contact.direction.add(term, factor, &unit);
        unit[term.index] = 0.0;
        contact
            .gap
            .add(term, factor, &row(&linear.positions, term.index));
        contact
            .rate
            .add(term, factor, &row(&linear.velocities, term.index));
    }
    for term in &of.offset {
        contact
            .offset
            .add(term, coefficients[term.coefficient], &[1.0]);
    }
    contact.standing = standing(of, coefficients, layout.coordinates);
    contact
}

fn standing(of: &ContactLayout, coefficients: &[f64], n: usize) -> Option<Standing> {
    let mut terms = of.force.iter().chain(&of.gap).chain(&of.offset);
    let sum = |terms: &[Term], n: usize| {
        let mut to = DVector::zeros(n);
        for term in terms {
            to[term.index] += coefficients[term.coefficient];
        }
        to
    };
    terms.all(|term| term.wave.harmonic == 0).then(|| Standing {
        force: sum(&of.force, n),
        gap: sum(&of.gap, n),
        offset: sum(&of.offset, 1)[0],
    })
}

fn load(layout: &Layout, coefficients: &[f64], linear: &Linear) -> Vec<Wave> {
    let mut waves: Vec<(u32, DVector<Complex<f64>>)> = Vec::new();
    for entry in &layout.load {
        let harmonic = entry.wave.harmonic;
        let known = waves.iter().position(|(h, _)| *h == harmonic);
        let place = known.unwrap_or_else(|| {
            waves.push((harmonic, DVector::zeros(layout.coordinates)));
            waves.len() - 1
        });
        // a cos + b sin = Re((a - i b) e^(i h tau))
        let value = coefficients[entry.coefficient];
        waves[place].1[entry.row] += match entry.wave.part {
            Part::Cosine => Complex::new(value, 0.0),
            Part::Sine => Complex::new(0.0, -value),
        };
    }
    let waves = waves.into_iter().map(|(harmonic, amplitude)| {
        let input = linear.input.map(|x| Complex::new(x, 0.0)) * amplitude;
        Wave::new(f64::from(harmonic), &input)
    });
    waves.collect()
}

/// `e^(i angle)`
pub(in crate::contact_equation) fn turn(angle: f64) -> Complex<f64> {
    if angle == 0.0 {
        return Complex::new(1.0, 0.0);
    }
    let (sine, cosine) = angle.sin_cos();
    Complex::new(cosine, sine)
}

/// The product of a row and states, which are few.
pub(in crate::contact_equation) fn dot(row: &[f64], states: &[f64]) -> f64 {
    row.iter().zip(states).map(|(a, y)| a * y).sum()
}

/// Two of the states.
pub(in crate::contact_equation) fn pair(states: &[f64], r: usize) -> Pair {
    [states[2 * r], states[2 * r + 1]]
}
