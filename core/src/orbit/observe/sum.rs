//! Outputs as sums of what is smooth and of forces.
//!
//! ```text
//! y = S(tau) + sum_c W_c(tau) phi_c(g_c, g_c')                                                                (1)
//! ```
//!
//! with Fourier series `S` and `W_c`. An acceleration is what the equations of motion give,
//! `q'' = M^-1 ( f - C q' - K q - sum_c e_c phi_c )`: it jumps where a force does, and no digit is lost by differentiating a series
//! twice.

use nalgebra::{DMatrix, DVector};

use crate::balance::{Balance, rate_series, stretched};
use crate::branches::orbit::Orbit;
use crate::model::layout::Layout;
use crate::numeric::fourier::series;
use crate::system::{Part, Place, Signal, System, Wave};

/// An orbit by its series, and what its system is at its parameters.
#[derive(Debug)]
pub(crate) struct Motions<'o> {
    pub(super) system: &'o dyn System,
    pub(super) layout: Layout,
    pub(super) coefficients: Vec<f64>,
    /// Coordinate by coordinate.
    pub(super) rows: &'o [f64],
    pub(super) length: usize,
    pub(super) period: usize,
    pub(super) base: f64,
}

/// An output in the form (1).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sum {
    pub(super) smooth: Vec<f64>,
    /// Contacts with the series that multiply their forces.
    pub(super) weights: Vec<(usize, Vec<f64>)>,
}

impl<'o> Motions<'o> {
    /// Of an orbit whose series are known.
    pub(crate) fn of(system: &'o dyn System, parameters: &[f64], orbit: &'o Orbit) -> Option<Self> {
        let coordinates = system.facts().coordinates.len();
        let fits = orbit.coordinates == coordinates
            && coordinates > 0
            && parameters.len() == system.facts().parameters.len();
        (orbit.has_series() && fits).then(|| {
            let mut coefficients = vec![0.0; system.facts().places.len()];
            system.coefficients(parameters, orbit.omega, &mut coefficients);
            Self {
                system,
                layout: Layout::of(system),
                coefficients,
                rows: &orbit.series,
                length: orbit.series.len() / coordinates,
                period: orbit.period,
                base: orbit.base,
            }
        })
    }

    /// Of a solution of the balance, at the variable that it was set to last.
    pub(super) fn of_balance(balance: &Balance<'o>, rows: &'o [f64]) -> Self {
        Self {
            system: balance.system(),
            layout: balance.layout().clone(),
            coefficients: balance.coefficients().to_vec(),
            rows,
            length: balance.length(),
            period: balance.resolution().period,
            base: balance.base(),
        }
    }

    pub(super) fn row(&self, coordinate: usize) -> &'o [f64] {
        &self.rows[coordinate * self.length..][..self.length]
    }

    /// Harmonics of the orbit and so many of the declaration.
    fn harmonics_with(&self, declared: usize) -> usize {
        series::harmonics(self.row(0)) + self.period * declared
    }

    /// An output of the system.
    pub(super) fn output(&self, output: usize) -> Sum {
        let places = self.system.facts().places.iter();
        let terms: Vec<(Signal, Wave, f64)> = places
            .zip(&self.coefficients)
            .filter_map(|(place, &coefficient)| match *place {
                Place::Output {
                    output: own,
                    of,
                    wave,
                } if own == output => Some((of, wave, coefficient)),
                _ => None,
            })
            .collect();
        let highest = terms.iter().map(|(_, wave, _)| wave.harmonic as usize);
        let own = highest.max().unwrap_or(0);
        let accelerates = |(of, ..): &(Signal, _, _)| matches!(of, Signal::Acceleration(_));
        let declared = if terms.iter().any(accelerates) {
            own + self.layout.highest_harmonic()
        } else {
            own
        };
        let mut sum = Sum {
            smooth: vec![0.0; series::length(self.harmonics_with(declared))],
            weights: Vec::new(),
        };
        for (of, wave, coefficient) in terms {
            let wave = stretched(wave, self.period);
            self.add(&mut sum, of, wave, coefficient);
        }
        sum
    }

    fn add(&self, sum: &mut Sum, of: Signal, wave: Wave, coefficient: f64) {
        match of {
            Signal::Coordinate(index) => {
                series::add_product(self.row(index), wave, coefficient, &mut sum.smooth);
            }
            Signal::Rate(index) => {
                let mut rate = vec![0.0; self.length];
                rate_series(self.row(index), self.base, &mut rate);
                series::add_product(&rate, wave, coefficient, &mut sum.smooth);
            }
            Signal::Acceleration(index) => self.add_acceleration(sum, index, wave, coefficient),
            Signal::Force(contact) => sum.add_force(contact, &[1.0], wave, coefficient),
            // A constant.
            _ => series::add_wave(
                &mut sum.smooth,
                wave.harmonic as usize,
                wave.part,
                coefficient,
            ),
        }
    }

    fn add_acceleration(&self, sum: &mut Sum, index: usize, wave: Wave, coefficient: f64) {
        let inverse_row = self.row_of_inverse_mass(index);
        for (row, &factor) in inverse_row.iter().enumerate() {
            let factor = factor * coefficient;
            if factor == 0.0 {
                continue;
            }
            series::add_product(&self.without_contacts(row), wave, factor, &mut sum.smooth);
            for (contact, layout) in self.layout.contacts.iter().enumerate() {
                for term in layout.force.iter().filter(|term| term.index == row) {
                    let own = stretched(term.wave, self.period);
                    let mut along = vec![0.0; series::length(own.harmonic as usize)];
                    series::add_wave(&mut along, own.harmonic as usize, own.part, 1.0);
                    let factor = -factor * self.coefficients[term.coefficient];
                    sum.add_force(contact, &along, wave, factor);
                }
            }
        }
    }

    /// A row of the inverse of the mass matrix; not a number where it has none.
    fn row_of_inverse_mass(&self, index: usize) -> Vec<f64> {
        let count = self.layout.coordinates;
        let mass: DMatrix<f64> = self.layout.mass(&self.coefficients);
        let mut unit = DVector::zeros(count);
        unit[index] = 1.0;
        let row = mass.transpose().lu().solve(&unit);
        row.map_or_else(|| vec![f64::NAN; count], |row| row.as_slice().to_vec())
    }

    /// `f - C q' - K q` in one equation.
    fn without_contacts(&self, row: usize) -> Vec<f64> {
        let harmonics = self.harmonics_with(self.layout.highest_harmonic());
        let mut sum = vec![0.0; series::length(harmonics)];
        let mut rate = vec![0.0; self.length];
        for entry in self.layout.load.iter().filter(|entry| entry.row == row) {
            let wave = stretched(entry.wave, self.period);
            let value = self.coefficients[entry.coefficient];
            series::add_wave(&mut sum, wave.harmonic as usize, wave.part, value);
        }
        for entry in self.layout.damping.iter().filter(|entry| entry.row == row) {
            rate_series(self.row(entry.column), self.base, &mut rate);
            let factor = -self.coefficients[entry.coefficient];
            series::add_product(&rate, Wave::CONSTANT, factor, &mut sum);
        }
        for entry in self
            .layout
            .stiffness
            .iter()
            .filter(|entry| entry.row == row)
        {
            let wave = stretched(entry.wave, self.period);
            let factor = -self.coefficients[entry.coefficient];
            series::add_product(self.row(entry.column), wave, factor, &mut sum);
        }
        sum
    }
}

impl Sum {
    /// A series alone.
    pub(super) fn series(series: &[f64]) -> Self {
        Self {
            smooth: series.to_vec(),
            weights: Vec::new(),
        }
    }

    /// The force of a contact alone.
    pub(super) fn force(contact: usize) -> Self {
        Self {
            smooth: vec![0.0],
            weights: vec![(contact, vec![1.0])],
        }
    }

    /// Adds the force of a contact times a series, a wave and a number.
    fn add_force(&mut self, contact: usize, along: &[f64], wave: Wave, factor: f64) {
        let length = along.len() + 2 * wave.harmonic as usize;
        let known = self.weights.iter().position(|(own, _)| *own == contact);
        let known = known.unwrap_or_else(|| {
            self.weights.push((contact, Vec::new()));
            self.weights.len() - 1
        });
        let weight = &mut self.weights[known].1;
        weight.resize(weight.len().max(length), 0.0);
        if matches!((wave.harmonic, wave.part), (0, Part::Sine)) {
            return;
        }
        series::add_product(along, wave, factor, weight);
    }
}
