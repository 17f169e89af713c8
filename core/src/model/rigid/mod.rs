//! Rigid motions: directions in which nothing holds a system, as two gears whose contact is all that couples them.
//!
//! A direction `r` is rigid, and `w` is its counterpart among the equations, if for every wave of a matrix or a direction
//!
//! ```text
//! K r = 0,   d_c . r = 0     and     w^T K = 0,   w^T e_c = 0                                                 (1)
//! ```
//!
//! for all contacts `c`. A shift along `r` then changes no force, so that the mean of an orbit is known but for it, and `w^T` times the
//! equations of motion leaves `w^T (M q'' + C q') = w^T f`: there is a periodic orbit only if the mean of `w^T f` is zero. If so, the one
//! is taken whose mean has no rigid part. With the projector `P` on the rigid motions the equations of the mean get
//!
//! ```text
//! Omega^2 M P mean(q),     P = R (W^T M R)^-1 W^T M,     R = [r_1 ...], W = [w_1 ...]                          (2)
//! ```
//!
//! which is zero at that orbit, since `W^T` times these equations leaves nothing else; whatever the units of the coordinates, it is as
//! large as the inertia of the first harmonic. Where an orbit is closed by integration, `omega P` is added in the equations of the velocities.
//!
//! A shift of an orbit does not change with time: a multiplier that is one. So is a constant velocity along `R_0`, the directions of `R`
//! with `C r = 0`, and the two belong to a Jordan block, whose computed eigenvalues err by the root of rounding. They are known, and
//! taken out of a monodromy matrix exactly: with `B` orthonormal and orthogonal to these invariant directions, the others are those of
//!
//! ```text
//! B^T Phi B,     B = diag(N, N_0),   N^T R = 0,   N_0^T R_0 = 0                                               (3)
//! ```
//!
//! Sources: Geradin and Rixen (2015), Mechanical Vibrations, section 2.6 (systems with rigid-body modes, self-equilibrated loads);
//! Golub and Van Loan (2013), Matrix Computations, theorem 7.1.6 (deflation by an invariant subspace).

pub(crate) mod centre;
mod null_space;

use nalgebra::DMatrix;

use crate::error::Error;
use crate::model::error::ModelError;
use crate::model::layout::Layout;
use crate::system::{System, Variable};
use null_space::Rows;

/// Values of the variable, as parts of a range, at which the directions are looked for.
const LOOKED_AT: [f64; 5] = [0.0, 0.137, 0.36, 0.83, 1.0];
/// The same beside one value, as parts of it, where no range is known.
const BESIDE: [f64; 2] = [0.0137, -0.0093];
/// Mean loads that cancel along a direction to this part of their sizes cancel.
const BALANCED: f64 = 1e-12;
/// `W^T M R` has no inverse if its determinant is smaller than this part of what its entries allow.
const REGULAR: f64 = 1e-10;

/// The rigid motions of a system whose mean loads are in balance along them.
#[derive(Debug, Clone)]
pub(crate) struct Rigid {
    /// `R (W^T M R)^-1 W^T`, the acceleration that loads give to the rigid motions
    response: DMatrix<f64>,
    /// `P` of (2)
    projector: DMatrix<f64>,
    /// `M P`
    inertia: DMatrix<f64>,
    /// `N` and `N_0` of (3)
    complements: [DMatrix<f64>; 2],
}

/// Where a system is looked at: everything but the value of the variable.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    pub(crate) system: &'a dyn System,
    pub(crate) layout: &'a Layout,
    pub(crate) parameters: &'a [f64],
    pub(crate) omega: f64,
    pub(crate) variable: Variable,
}

impl<'a> Place<'a> {
    /// The coefficients at a value of the variable.
    pub(crate) fn coefficients(&self, value: f64) -> Vec<f64> {
        let (mut parameters, mut omega) = (self.parameters.to_vec(), self.omega);
        match self.variable {
            Variable::Omega => omega = value,
            Variable::Parameter(index) => parameters[index] = value,
        }
        let mut coefficients = vec![0.0; self.layout.coefficients];
        self.system
            .coefficients(&parameters, omega, &mut coefficients);
        coefficients
    }

    /// The same where the variable has another value, with room for the parameters.
    pub(crate) fn moved<'p>(&self, value: f64, parameters: &'p mut [f64]) -> Place<'p>
    where
        'a: 'p,
    {
        let mut omega = self.omega;
        match self.variable {
            Variable::Omega => omega = value,
            Variable::Parameter(index) => parameters[index] = value,
        }
        Place {
            system: self.system,
            layout: self.layout,
            parameters,
            omega,
            variable: self.variable,
        }
    }

    /// The value that the variable has there.
    pub(crate) fn value(&self) -> f64 {
        match self.variable {
            Variable::Omega => self.omega,
            Variable::Parameter(index) => self.parameters[index],
        }
    }
}

/// `R`, `W` and `R_0`, column by column.
struct Directions {
    right: DMatrix<f64>,
    left: DMatrix<f64>,
    undamped: DMatrix<f64>,
}

impl Directions {
    /// Those that are rigid for all of these coefficients; `None` if there are none, or not as many among the equations as among
    /// the coordinates.
    fn of(layout: &Layout, coefficients: &[Vec<f64>]) -> Option<Self> {
        let n = layout.coordinates;
        let mut rows = Rows::new(n);
        for (at, values) in coefficients.iter().enumerate() {
            rows.begin(at);
            rows.add_right(layout, values);
        }
        let right = rows.null_space();
        if right.ncols() == 0 {
            return None;
        }
        let mut columns = Rows::new(n);
        for (at, values) in coefficients.iter().enumerate() {
            columns.begin(at);
            columns.add_left(layout, values);
            rows.begin(at);
            rows.add_damping(layout, values);
        }
        let left = columns.null_space();
        (left.ncols() == right.ncols()).then(|| Self {
            undamped: rows.null_space(),
            right,
            left,
        })
    }

    /// The direction among the equations along which mean loads are not in balance, and their sum.
    fn unbalanced(&self, layout: &Layout, coefficients: &[f64]) -> Option<(usize, f64)> {
        self.left.column_iter().enumerate().find_map(|(index, w)| {
            let mean = layout.load.iter().filter(|load| load.wave.harmonic == 0);
            let (sum, size) = mean.fold((0.0, 0.0), |(sum, size), load| {
                let part = w[load.row] * coefficients[load.coefficient];
                (sum + part, size + part.abs())
            });
            (sum.abs() > BALANCED * size).then_some((index, sum))
        })
    }
}

impl Rigid {
    /// The rigid motions of a system at and beside the value of its variable; `None` if there are none or loads carry it away.
    pub(crate) fn beside(place: Place<'_>) -> Option<Self> {
        let value = place.value();
        let unit = if value == 0.0 { 1.0 } else { value.abs() };
        let here = vec![place.coefficients(value)];
        Directions::of(place.layout, &here)?;
        let others = BESIDE.map(|part| place.coefficients(value + part * unit));
        let others = others.into_iter().filter(|values| is_finite(values));
        let all: Vec<_> = here.into_iter().chain(others).collect();
        let directions = Directions::of(place.layout, &all)?;
        let unbalanced = |values: &Vec<f64>| directions.unbalanced(place.layout, values).is_some();
        if all.iter().any(unbalanced) {
            return None;
        }
        Self::new(&directions, &place.layout.mass(&all[0]))
    }

    fn new(directions: &Directions, mass: &DMatrix<f64>) -> Option<Self> {
        let Directions {
            right,
            left,
            undamped,
        } = directions;
        let momentum = left.transpose() * mass;
        let moved = &momentum * right;
        let allowed: f64 = moved.row_iter().map(|row| row.norm()).product();
        if moved.determinant().abs() <= REGULAR * allowed {
            return None;
        }
        let response = right * moved.try_inverse()? * left.transpose();
        let projector = &response * mass;
        Some(Self {
            inertia: mass * &projector,
            projector,
            response,
            complements: [right, undamped].map(null_space::complement),
        })
    }

    /// `P` of (2)
    pub(crate) fn projector(&self) -> &DMatrix<f64> {
        &self.projector
    }

    /// `M P` of (2)
    pub(crate) fn inertia(&self) -> &DMatrix<f64> {
        &self.inertia
    }

    /// How many multipliers are one because of them.
    pub(crate) fn multipliers(&self) -> usize {
        let known = |complement: &DMatrix<f64>| complement.nrows() - complement.ncols();
        self.complements.iter().map(known).sum()
    }

    /// A map of positions and velocities without these multipliers, (3), whatever the unit of velocities.
    pub(crate) fn taken_out_of(&self, map: &DMatrix<f64>) -> DMatrix<f64> {
        let [positions, velocities] = &self.complements;
        let n = positions.nrows();
        let order = positions.ncols() + velocities.ncols();
        let mut basis = DMatrix::zeros(2 * n, order);
        basis
            .view_mut((0, 0), positions.shape())
            .copy_from(positions);
        basis
            .view_mut((n, positions.ncols()), velocities.shape())
            .copy_from(velocities);
        basis.transpose() * map * basis
    }
}

/// Refuses a system that its mean load carries away somewhere in a range of the variable: nothing holds it there.
///
/// # Errors
/// [`ModelError::CarriedAway`]
pub(crate) fn held(place: Place<'_>, [from, to]: [f64; 2]) -> Result<(), Error> {
    if Directions::of(place.layout, &[place.coefficients(from)]).is_none() {
        return Ok(());
    }
    let values = LOOKED_AT.map(|part| from + part * (to - from));
    let coefficients = values.map(|value| place.coefficients(value));
    let Some(directions) = Directions::of(place.layout, &coefficients) else {
        return Ok(());
    };
    for (value, coefficients) in values.into_iter().zip(&coefficients) {
        if let Some((index, load)) = directions.unbalanced(place.layout, coefficients) {
            let direction = directions.left.column(index);
            return Err(ModelError::CarriedAway {
                value,
                load,
                direction: null_space::described(
                    &place.system.facts().coordinates,
                    direction.as_slice(),
                ),
            }
            .into());
        }
    }
    Ok(())
}

/// Refuses a system with rigid motions, for methods whose equations are singular along them.
///
/// # Errors
/// [`ModelError::CarriedAway`] or [`ModelError::Free`]
pub(crate) fn none(place: Place<'_>, range: [f64; 2]) -> Result<(), Error> {
    match free(place, range)? {
        None => Ok(()),
        Some(direction) => Err(ModelError::Free { direction }.into()),
    }
}

/// A direction in which nothing holds a system throughout a range, as a sum of coordinates, if there is one.
///
/// # Errors
/// [`ModelError::CarriedAway`]
fn free(place: Place<'_>, [from, to]: [f64; 2]) -> Result<Option<String>, Error> {
    held(place, [from, to])?;
    let coefficients = LOOKED_AT.map(|part| place.coefficients(from + part * (to - from)));
    let directions = Directions::of(place.layout, &coefficients);
    Ok(directions.map(|directions| {
        let names = &place.system.facts().coordinates;
        null_space::described(names, directions.right.column(0).as_slice())
    }))
}

fn is_finite(values: &[f64]) -> bool {
    values.iter().all(|x| x.is_finite())
}
