//! Which signal is another one after a part of the period, where a motion has come back by then with coordinates in each other's place.
//!
//! With `q(t + s) = S q(t)` the gap of a contact at `t + s` is that of another one at `t`, whatever the motion is, where waves of its direction and its
//! offset that are turned on by `s` have the coefficients of the other's, with coordinates in each other's place. So each force of many equal contacts that
//! follow each other, as the balls of a bearing, is looked at once.
//!
//! Source: Golubitsky, Stewart and Schaeffer (1988), Singularities and Groups in Bifurcation Theory II, chapter XVI (spatio-temporal symmetry).

use std::collections::BTreeMap;

use nalgebra::Complex;

use super::{Contact, Signals};
use crate::system::{Part, Signal, Wave};

/// Coefficients that differ by less than this part of the largest are equal.
const SAME: f64 = 1e-13;

/// What stands at the place of a coordinate after a part of the period: another one, and a sign.
pub(crate) type Entry<'e> = &'e dyn Fn(usize) -> (usize, f64);

/// Complex amplitudes by what they are of, and the harmonic.
type Amplitudes = BTreeMap<(usize, u32), Complex<f64>>;

impl Signals<'_> {
    /// For each signal the one that it is after this phase; none where there is no such.
    pub(crate) fn images(&self, phase: f64, entry: Entry<'_>) -> Vec<Option<usize>> {
        let zero: Vec<Amplitudes> = self.contacts.iter().map(|of| gap(of, 0.0, None)).collect();
        let contacts = self.contacts.iter().map(|of| {
            let later = gap(of, phase, Some(entry));
            let mut all = self.contacts.iter().zip(&zero);
            all.position(|(other, now)| has_law_of(of, other) && are_equal(&later, now))
        });
        let contacts: Vec<Option<usize>> = contacts.collect();
        let now: Vec<Option<Amplitudes>> = self.signals_by(|of| Some((of, 1.0)));
        let later = self.signals_by(|of| match of {
            Signal::Coordinate(index) => {
                let (place, sign) = entry(index);
                Some((Signal::Coordinate(place), sign))
            }
            Signal::Rate(index) => {
                let (place, sign) = entry(index);
                Some((Signal::Rate(place), sign))
            }
            Signal::Acceleration(index) => {
                let (place, sign) = entry(index);
                Some((Signal::Acceleration(place), sign))
            }
            Signal::Force(contact) => contacts[contact].map(|other| (Signal::Force(other), 1.0)),
            of => Some((of, 1.0)),
        });
        let image = |of: &Option<Amplitudes>| {
            let of = of.as_ref()?;
            let is_it = |other: &Option<Amplitudes>| {
                let other = other.as_ref();
                other.is_some_and(|other| are_equal(of, other))
            };
            now.iter().position(is_it)
        };
        later.iter().map(image).collect()
    }

    /// Coefficients of each signal by what they are of; none where waves are among them, or what there is no image of.
    fn signals_by(
        &self,
        image: impl Fn(Signal) -> Option<(Signal, f64)>,
    ) -> Vec<Option<Amplitudes>> {
        let sums = self.sums.iter().map(|terms| {
            let mut found = Amplitudes::new();
            for term in terms {
                let (of, sign) = image(term.of).filter(|_| term.wave == Wave::CONSTANT)?;
                let place = match of {
                    Signal::Constant => 0,
                    Signal::Coordinate(index) => 1 + 4 * index,
                    Signal::Rate(index) => 2 + 4 * index,
                    Signal::Acceleration(index) => 3 + 4 * index,
                    Signal::Force(contact) => 4 + 4 * contact,
                    _ => return None,
                };
                *found.entry((place, 0)).or_default() += sign * term.coefficient;
            }
            Some(found)
        });
        sums.collect()
    }
}

/// Direction and offset of a gap after a phase, with coordinates in each other's place.
fn gap(of: &Contact, phase: f64, entry: Option<Entry<'_>>) -> Amplitudes {
    let mut found = Amplitudes::new();
    let turned = |wave: Wave, coefficient: f64| {
        let angle = f64::from(wave.harmonic) * phase;
        let part = match wave.part {
            Part::Cosine => Complex::new(coefficient, 0.0),
            Part::Sine => Complex::new(0.0, -coefficient),
        };
        part * Complex::new(angle.cos(), angle.sin())
    };
    for (index, wave, coefficient) in of.gap.direction() {
        let (place, sign) = entry.map_or((index, 1.0), |entry| entry(index));
        *found.entry((1 + place, wave.harmonic)).or_default() += sign * turned(wave, coefficient);
    }
    for (wave, coefficient) in of.gap.offset() {
        *found.entry((0, wave.harmonic)).or_default() += turned(wave, coefficient);
    }
    found
}

fn has_law_of(of: &Contact, other: &Contact) -> bool {
    let pairs = of.arguments.iter().zip(&other.arguments);
    let mut pairs = pairs.chain(of.levels.iter().zip(&other.levels));
    of.law == other.law && pairs.all(|(a, b)| (a - b).abs() <= SAME * a.abs().max(b.abs()))
}

/// Whether amplitudes of each thing are equal, to rounding of the largest of them.
fn are_equal(a: &Amplitudes, b: &Amplitudes) -> bool {
    let zero = Complex::new(0.0, 0.0);
    let size = |of: usize| {
        let alike = a.iter().chain(b).filter(|((other, _), _)| *other == of);
        alike.map(|(_, z)| z.norm()).fold(0.0, f64::max)
    };
    let near = |of: &Amplitudes, other: &Amplitudes| {
        let mut entries = of.iter();
        entries.all(|(key, z)| (z - other.get(key).unwrap_or(&zero)).norm() <= SAME * size(key.0))
    };
    near(a, b) && near(b, a)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use crate::time::signals::{Asked, Signals};

    crate::oscillator! {
        /// Two balls that turn, and outputs of several kinds.
        Balls(x, y) {
            law ball(g) { g > 0 => 3*g, else => 0 }
            let one = x*cos(omega*t) + y*sin(omega*t) - 0.1;
            let two = -x*cos(omega*t) - y*sin(omega*t) - 0.1;
            ddot(x) + 0.1*dot(x) + x + ball(one)*cos(omega*t) - ball(two)*cos(omega*t) = 1;
            ddot(y) + 0.1*dot(y) + y + ball(one)*sin(omega*t) - ball(two)*sin(omega*t) = 0;
            output sum = x + y;
            output rate = dot(y) - 3;
            output turning = x*cos(omega*t);
            output both = ball(one) + ball(two);
        }
    }

    #[test]
    fn forces_of_contacts_that_follow_each_other_are_found() {
        let system = Balls {};
        let signals = |asked| Signals::new(&system, &[], 0.7, asked);
        let contacts = signals(Asked::Contacts);
        let same = |index: usize| (index, 1.0);
        assert_eq!(contacts.images(0.5 * TAU, &same), [Some(1), Some(0)]);
        // After another part of the period no ball is where one was.
        assert_eq!(contacts.images(0.3 * TAU, &same), [None; 2]);
        // With both signs changed balls have the gaps of each other at once.
        let opposite = |index: usize| (index, -1.0);
        assert_eq!(contacts.images(0.0, &opposite), [Some(1), Some(0)]);
        let outputs = signals(Asked::Outputs);
        let found = outputs.images(0.5 * TAU, &same);
        assert_eq!(found, [Some(0), Some(1), None, Some(3)]);
        let found = outputs.images(0.0, &opposite);
        assert_eq!(found, [None, None, None, Some(3)]);
    }
}
