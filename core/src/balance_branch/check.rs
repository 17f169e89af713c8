//! Whether a request can be followed, and with what resolution.

use std::sync::Arc;

use crate::balance::aft::Aft;
use crate::balance::resolution::Chooser;
use crate::balance::symmetry::{Over, Permutations, has_stride, is_broken};
use crate::balance::{Lattice, Parity, Resolution};
use crate::balance_branch::context::BranchContext;
use crate::balance_branch::options::HarmonicBalance;
use crate::branches::orbit::Orbit;
use crate::branches::point::Event;
use crate::branches::request::{Guess, Request};
use crate::continuation::follow::FollowOptions;
use crate::continuation::newton::NewtonOptions;
use crate::continuation::step_control;
use crate::error::Error;
use crate::model::error::ModelError;
use crate::model::layout::{ContactLayout, Layout};
use crate::model::request::RequestError;
use crate::model::rigid::{self, Place};
use crate::model::validate;
use crate::numeric::fourier::series;
use crate::system::{Bound, Variable};

/// More samples of an orbit would take more than a gigabyte.
const MOST_SAMPLES: usize = 10_000_000;
/// Harmonics that are coupled densely in the search for a first orbit.
const CORE_AT_START: usize = 40;
/// Harmonics beyond those of the declaration that are always taken: the estimate of the error takes higher ones for free masses.
const LEAST_BEYOND: usize = 4;
/// More harmonics of an excitation period are never chosen, only taken when given.
const MOST_HARMONICS: usize = 150;
/// Part of a value to its neighbour in a range of which only the first orbit is wanted.
const ASIDE: f64 = 1e-3;
/// Frequencies that differ by no more than this part are one.
const SAME: f64 = 1e-9;
/// The dense matrix of more unknowns would take more than 300 megabytes.
const MOST_UNKNOWNS: usize = 6000;

/// What orbits of a system may have, and those that are looked for.
struct Symmetries {
    /// The system has odd symmetry, and those that are looked for have not.
    asymmetric: bool,
    /// Harmonics of the most regular ones are multiples of this one.
    stride: usize,
    permutations: Permutations,
}

/// What was asked for.
#[derive(Clone, Copy)]
pub(crate) struct Asked<'r> {
    pub(crate) request: &'r Request,
    pub(crate) balance: &'r HarmonicBalance,
}

impl<'r> Asked<'r> {
    pub(crate) fn of(request: &'r Request, balance: &'r HarmonicBalance) -> Self {
        Self { request, balance }
    }

    /// Checks everything that was asked for.
    pub(crate) fn check(&self) -> Result<(BranchContext, FollowOptions), Error> {
        let facts = self.request.system.facts();
        if facts.coordinates.is_empty() {
            return Err(ModelError::NoCoordinates.into());
        }
        let variable = self.request.variable()?;
        let range = self.request.range()?;
        let (parameters, omega) = self.held_at_first(variable, range)?;
        self.check_options()?;
        self.check_near()?;
        let mut resolution = self.resolution()?;
        let layout = Layout::of(self.request.system.as_ref());
        let place = Place {
            system: self.request.system.as_ref(),
            layout: &layout,
            parameters: &parameters,
            omega,
            variable,
        };
        let symmetries = self.use_symmetries(place, range, &mut resolution);
        check_ends(place, range)?;
        let newton = NewtonOptions {
            tolerance: (1e-3 * self.request.tolerance).clamp(1e-11, 1e-6),
            iterations: 12,
            damped: false,
        };
        let [from, to] = range;
        let options = FollowOptions {
            from,
            to,
            points: step_control::max_points(self.request.max_points)?,
            steps: step_control::largest_step(self.request.largest_step)?,
            newton,
        };
        let chooser = self.chooser(resolution);
        if let (Some(chooser), Some(orbit)) = (&chooser, self.near()) {
            resolution.harmonics = chooser.admitted(orbit.harmonics());
        }
        Ok((
            BranchContext {
                system: Arc::clone(&self.request.system),
                parameters,
                omega,
                variable,
                resolution,
                newton,
                selection: self.balance.selection(),
                asymmetric: symmetries.asymmetric,
                stride: symmetries.stride,
                permutations: symmetries.permutations,
                stability: self.request.stability.then_some(self.balance.multipliers),
                accuracy: self.balance.accuracy,
                chooser,
                from,
                to,
                cancel: self.request.cancel.clone(),
                keep: self.request.keep.clone(),
            },
            options,
        ))
    }

    /// Parameters and frequency at the first value of what is varied, checked.
    fn held_at_first(
        &self,
        variable: Variable,
        [from, to]: [f64; 2],
    ) -> Result<(Vec<f64>, f64), Error> {
        let facts = self.request.system.facts();
        validate::range(facts, variable, from, to)?;
        let omega = self.request.held_omega(variable)?.unwrap_or(from);
        validate::omega(omega)?;
        let mut parameters = self.request.parameters();
        if let Variable::Parameter(index) = variable {
            parameters[index] = from;
        }
        validate::parameters(facts, &parameters)?;
        Ok((parameters, omega))
    }

    /// Takes only the harmonics that orbits with the symmetries of the system have, where such orbits are wanted.
    fn use_symmetries(
        &self,
        place: Place<'_>,
        range: [f64; 2],
        resolution: &mut Resolution,
    ) -> Symmetries {
        let over = Over { place, range };
        let odd = over.is_odd() && self.request.period() == 1;
        let kept = self.balance.symmetric && !self.near().is_some_and(lacks_symmetry);
        if odd && kept {
            resolution.parity = Parity::Odd;
            if self.balance.harmonics.is_none() {
                // An even number is as good as the one below it.
                resolution.harmonics |= 1;
            }
        }
        let mut stride = 1;
        if self.request.period() == 1 && self.balance.symmetric {
            stride = over.stride();
            self.take_stride(stride, resolution);
        }
        Symmetries {
            asymmetric: odd && !kept,
            stride,
            permutations: over.permutations(),
        }
    }

    /// Another value that what is varied may have, next to one.
    pub(crate) fn aside(&self, value: f64) -> Result<f64, Error> {
        let facts = self.request.system.facts();
        let unit = if value == 0.0 { 1.0 } else { value.abs() };
        let above = value + ASIDE * unit;
        let Variable::Parameter(index) = self.request.variable()? else {
            return Ok(above);
        };
        let facts = &facts.parameters[index];
        let towards = |bound: Bound| match bound {
            Bound::Unbounded => above,
            Bound::Included(bound) | Bound::Excluded(bound) => 0.5 * (value + bound),
        };
        // In a narrow range, half of the way to one of its ends.
        let neighbours = [
            above,
            value - ASIDE * unit,
            towards(facts.maximum),
            towards(facts.minimum),
        ];
        let admitted = |neighbour: &f64| *neighbour != value && facts.admits(*neighbour);
        Ok(neighbours.into_iter().find(admitted).unwrap_or(above))
    }

    /// The orbit that the first one is to be near. It has its series.
    pub(crate) fn near(&self) -> Option<&Orbit> {
        match &self.request.near {
            Some(Guess::Orbit(orbit)) => Some(orbit),
            _ => None,
        }
    }

    /// An event is one of the system, within the range, and at the same excitation frequency if that does not vary.
    pub(crate) fn has(&self, event: &Event) -> Result<(), Error> {
        self.request.fits(&event.point.orbit)?;
        let value = event.point.value;
        let (from, to) = (
            self.request.from.unwrap_or(value),
            self.request.to.unwrap_or(value),
        );
        if !(from.min(to)..=from.max(to)).contains(&value) {
            return Err(RequestError::Option {
                name: "event",
                value,
                must: "must be between from and to",
            }
            .into());
        }
        let varies = self.request.variable()?;
        let expected = match varies {
            Variable::Omega => Some(value),
            Variable::Parameter(_) => self.request.omega,
        };
        let omega = event.point.orbit.omega;
        match expected {
            Some(expected) if (omega - expected).abs() > SAME * expected.abs() => {
                Err(RequestError::Option {
                    name: "event",
                    value: omega,
                    must: "must have the excitation frequency of this request",
                }
                .into())
            }
            _ => Ok(()),
        }
    }

    /// Checks what the first orbit is to be near.
    fn check_near(&self) -> Result<(), Error> {
        let Some(orbit) = self.near() else {
            return Ok(());
        };
        self.request.fits(orbit)?;
        if orbit.period == self.request.period() {
            return Ok(());
        }
        Err(RequestError::Option {
            name: "period",
            value: self.request.period() as f64,
            must: "must be that of the orbit given by `near_orbit`",
        }
        .into())
    }

    /// Checks the numbers among the options.
    fn check_options(&self) -> Result<(), Error> {
        validate::option(
            "tolerance",
            self.request.tolerance,
            1e-12..=1e-1,
            "must be from 1e-12 to 0.1",
        )?;
        validate::option(
            "period",
            self.request.period() as f64,
            1.0..=1000.0,
            "must be from 1 to 1000",
        )
    }

    /// How harmonics follow the tolerance: unless they were given, or the contacts are sampled.
    fn chooser(&self, resolution: Resolution) -> Option<Chooser> {
        let free = self.balance.harmonics.is_none() && self.balance.aft == Aft::Switched;
        let layout = Layout::of(self.request.system.as_ref());
        let least = (layout.highest_harmonic() + LEAST_BEYOND) * self.request.period();
        let unknowns_allow = most_harmonics(&layout);
        let most =
            MOST_HARMONICS * self.request.period() * self.request.system.facts().divisor as usize;
        free.then(|| {
            Chooser::new(
                self.request.tolerance,
                least.min(resolution.harmonics),
                most.min(unknowns_allow),
                resolution.lattice(),
            )
        })
    }

    /// Takes multiples of a harmonic as unknowns, or of the largest part of it of which the orbit that is given has no others and some
    /// are below the highest.
    fn take_stride(&self, stride: usize, resolution: &mut Resolution) {
        let given = self.near();
        let admitted = |part: &usize| {
            // What is odd of a sum of even harmonics is nothing.
            let odd = resolution.parity == Parity::Odd && part.is_multiple_of(2);
            let has = given.is_none_or(|orbit| has_stride(orbit, *part));
            stride.is_multiple_of(*part) && *part <= resolution.harmonics && !odd && has
        };
        let Some(stride) = (2..=stride).rev().find(admitted) else {
            return;
        };
        resolution.stride = stride;
        resolution.core *= stride;
        if self.balance.harmonics.is_none() {
            let Lattice { first, step } = resolution.lattice();
            let beyond = resolution.harmonics - first;
            resolution.harmonics = first + beyond.next_multiple_of(step);
        }
    }

    /// The resolution that was asked for, or else that the tolerance asks for.
    fn resolution(&self) -> Result<Resolution, Error> {
        let layout = Layout::of(self.request.system.as_ref());
        let per_period = self.harmonics_per_period(&layout);
        validate::option(
            "harmonics",
            per_period as f64,
            1.0..=1e4,
            "must be from 1 to 10000",
        )?;
        let harmonics = per_period * self.request.period();
        let unknowns = layout.coordinates * series::length(harmonics);
        if unknowns > MOST_UNKNOWNS {
            return Err(RequestError::Unknowns {
                unknowns,
                most: MOST_UNKNOWNS,
            }
            .into());
        }
        let highest = layout.highest_harmonic() * self.request.period();
        if highest > harmonics {
            return Err(RequestError::Harmonics { harmonics, highest }.into());
        }
        Ok(Resolution {
            harmonics,
            core: CORE_AT_START * self.request.period(),
            parity: Parity::All,
            stride: 1,
            samples: self.samples(&layout, per_period)?,
            aft: self.balance.aft,
            period: self.request.period(),
        })
    }

    /// Harmonics for each period of the excitation.
    fn harmonics_per_period(&self, layout: &Layout) -> usize {
        let digits = -self.request.tolerance.log10();
        let by_tolerance = (20.0 * ((digits - 6.0) / 2.0).exp2())
            .round()
            .clamp(5.0, 100.0) as usize;
        let divisor = self.request.system.facts().divisor as usize;
        self.balance.harmonics.unwrap_or_else(|| {
            let least = layout.highest_harmonic() + LEAST_BEYOND;
            let most = (most_harmonics(layout) / self.request.period()).max(1);
            (by_tolerance * divisor).max(least).min(most)
        })
    }

    /// Samples of an orbit, enough for its harmonics.
    fn samples(&self, layout: &Layout, harmonics_per_period: usize) -> Result<usize, Error> {
        let per_period = self
            .balance
            .samples
            .unwrap_or_else(|| (200 * harmonics_per_period).next_power_of_two());
        validate::option(
            "samples",
            per_period as f64,
            1.0..=1e7,
            "must be from 1 to 1e7",
        )?;
        let samples = per_period * self.request.period();
        if samples > MOST_SAMPLES {
            let must = "times the period must be at most 1e7";
            return Err(RequestError::Option {
                name: "samples",
                value: samples as f64,
                must,
            }
            .into());
        }
        // The derivatives are needed up to twice the harmonics of the balance, and the waves of directions and offsets on top.
        let contacts = layout.contacts.iter();
        let wave = |contact: &ContactLayout| {
            contact.offset_harmonic() + contact.force_harmonic() + contact.gap_harmonic()
        };
        let waves = contacts.map(wave).max().unwrap_or(0) * self.request.period();
        let harmonics = harmonics_per_period * self.request.period();
        let least = 2 * (2 * harmonics + waves) + 2;
        if samples < least {
            return Err(RequestError::Samples {
                samples,
                least,
                harmonics,
            }
            .into());
        }
        Ok(samples)
    }
}

/// At both ends of a range levels are in order and masses regular, and nothing in it is carried away. That declared levels are in order
/// within the ranges of the parameters, the compiler has proved. Of other laws the ends are looked at.
fn check_ends(place: Place<'_>, [from, to]: [f64; 2]) -> Result<(), Error> {
    let mut parameters = place.parameters.to_vec();
    for value in [from, to] {
        let omega = match place.variable {
            Variable::Omega => value,
            Variable::Parameter(index) => {
                parameters[index] = value;
                place.omega
            }
        };
        validate::levels(place.system, &parameters, omega)?;
        validate::mass(place.system, &parameters, omega)?;
    }
    rigid::held(place, [from, to])
}

/// So many harmonics of the base frequency have no more than [`MOST_UNKNOWNS`].
fn most_harmonics(layout: &Layout) -> usize {
    (MOST_UNKNOWNS / layout.coordinates).saturating_sub(1) / 2
}

fn lacks_symmetry(orbit: &Orbit) -> bool {
    is_broken(&orbit.series, orbit.row(0).len())
}
