//! Signals as sums of products with what moves, and their derivatives along a direction.

use super::{Direction, Instant, Moved, Slopes};
use crate::law::Variation;
use crate::system::{Place, Signal, Wave};

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::sensitivity) enum Asked {
    Coordinate(usize),
    /// Its derivatives by time.
    Rate(usize),
    Acceleration(usize),
    Output(usize),
    Contact(usize),
    /// The power of the load, `f . v`.
    Power,
}

/// A multiple of something that moves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Product {
    pub(in crate::sensitivity) of: Signal,
    pub(in crate::sensitivity) wave: Wave,
    /// One, without a coefficient.
    pub(super) coefficient: Option<usize>,
}

impl Slopes {
    pub(super) fn products(&self, asked: Asked) -> Vec<Product> {
        let once = |of| Product {
            of,
            wave: Wave::CONSTANT,
            coefficient: None,
        };
        match asked {
            Asked::Coordinate(index) => vec![once(Signal::Coordinate(index))],
            Asked::Rate(index) => vec![once(Signal::Rate(index))],
            Asked::Acceleration(index) => vec![once(Signal::Acceleration(index))],
            Asked::Contact(index) => vec![once(Signal::Force(index))],
            Asked::Power => Vec::new(),
            Asked::Output(index) => {
                let places = self.system.facts().places.iter().enumerate();
                let products = places.filter_map(|(coefficient, place)| match *place {
                    Place::Output { output, of, wave } if output == index => Some(Product {
                        of,
                        wave,
                        coefficient: Some(coefficient),
                    }),
                    _ => None,
                });
                products.collect()
            }
        }
    }

    /// Which of the signals one is.
    pub(in crate::sensitivity) fn position(&self, asked: Asked) -> Option<usize> {
        self.asked.iter().position(|own| *own == asked)
    }

    /// Whether a signal is a force that is nothing on these pieces.
    pub(in crate::sensitivity) fn is_nothing(&self, signal: usize, pieces: &[usize]) -> bool {
        let Asked::Contact(contact) = self.asked[signal] else {
            return false;
        };
        let law = self.system.law(self.layout.contacts[contact].law);
        law.facts().pieces[pieces[contact]].force == Variation::Zero
    }

    /// Writes all signals.
    pub(in crate::sensitivity) fn write(&self, at: &Instant, out: &mut [f64]) {
        for (index, out) in out.iter_mut().enumerate() {
            *out = if self.asked[index] == Asked::Power {
                self.power(at)
            } else {
                let products = self.sums[index].iter().map(|product| {
                    let c = product.coefficient.map_or(1.0, |c| self.coefficients[c]);
                    c * self.wave(product.wave, at)[0] * self.signal(product.of, at)
                });
                products.sum()
            };
        }
    }

    fn power(&self, at: &Instant) -> f64 {
        let v = &at.state[self.layout.coordinates..];
        let load = self.layout.load.iter();
        load.map(|e| self.coefficients[e.coefficient] * self.wave(e.wave, at)[0] * v[e.row])
            .sum()
    }

    fn signal(&self, of: Signal, at: &Instant) -> f64 {
        match of {
            Signal::Coordinate(index) => at.state[index],
            Signal::Rate(index) => at.state[self.layout.coordinates + index],
            Signal::Acceleration(index) => at.acceleration[index],
            Signal::Force(contact) => at.forces[contact].force,
            _ => 1.0,
        }
    }

    /// Writes the derivatives of all signals along a direction.
    pub(in crate::sensitivity) fn along<'o>(
        &self,
        at: &Instant,
        direction: Direction<'_>,
        room: &mut Moved,
        out: impl Iterator<Item = &'o mut f64>,
    ) {
        if self.has_forces {
            self.move_forces(at, direction, room);
        }
        for (index, out) in out.enumerate() {
            if self.asked[index] == Asked::Power {
                *out = self.power_along(at, direction);
                continue;
            }
            let products = self.sums[index].iter().map(|product| {
                let [c, dc] = product
                    .coefficient
                    .map_or([1.0, 0.0], |c| self.value(c, direction));
                let [w, slope, _] = self.wave(product.wave, at);
                let change = match product.of {
                    Signal::Coordinate(index) => direction.state[index],
                    Signal::Rate(index) => direction.state[self.layout.coordinates + index],
                    Signal::Acceleration(index) => room.acceleration[index],
                    Signal::Force(contact) => room.forces[contact],
                    _ => 0.0,
                };
                (dc * w + c * slope * direction.phase) * self.signal(product.of, at)
                    + c * w * change
            });
            *out = products.sum();
        }
    }

    fn power_along(&self, at: &Instant, direction: Direction<'_>) -> f64 {
        let n = self.layout.coordinates;
        let (v, dv) = (&at.state[n..], &direction.state[n..]);
        let load = self.layout.load.iter().map(|e| {
            let [w, slope, _] = self.wave(e.wave, at);
            let [c, dc] = self.value(e.coefficient, direction);
            (dc * w + c * slope * direction.phase) * v[e.row] + c * w * dv[e.row]
        });
        load.sum()
    }
}
