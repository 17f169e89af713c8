//! Models drawn at random over the whole grammar.
//!
//! Mass, stiffness and motion are about one; units of mass, time and length make other sizes of them, in half of the models.

use hertzian_tests::random::Random;

use crate::differential::expression::{Expression, Wave};
use crate::differential::laws;
use crate::differential::model::{
    CONTACTS, COORDINATES, Contact, Law, Model, Parameter, Term, written,
};

/// Exponents of mass, time and length.
pub type Dimension = [f64; 3];

pub const FORCE: Dimension = [1.0, -2.0, 1.0];
pub const LENGTH: Dimension = [0.0, 0.0, 1.0];
pub const SPEED: Dimension = [0.0, -1.0, 1.0];
pub const STIFFNESS: Dimension = [1.0, -2.0, 0.0];
pub const DAMPING: Dimension = [1.0, -1.0, 0.0];
const MASS: Dimension = [1.0, 0.0, 0.0];

/// A model that is being written.
pub struct Draft {
    pub random: Random,
    pub model: Model,
    units: [f64; 3],
    waves: Vec<u32>,
}

impl Draft {
    /// A quantity of about one, in the units of the model: a parameter, or now and then a number.
    pub fn quantity(&mut self, name: &str, value: f64, dimension: Dimension) -> Expression {
        let plain = self.random.once_in(6);
        let value = value * self.unit(dimension);
        if plain && value >= 0.0 && written(value) {
            return Expression::Number(value);
        }
        self.parameter(name, value)
    }

    pub fn parameter(&mut self, name: &str, value: f64) -> Expression {
        let parameters = &mut self.model.parameters;
        parameters.push(Parameter {
            name: format!("{name}{}", parameters.len()),
            value,
            positive: value > 0.0,
        });
        Expression::Parameter(parameters.len() - 1)
    }

    pub fn unit(&self, dimension: Dimension) -> f64 {
        let powers = self.units.iter().zip(dimension);
        powers.map(|(unit, exponent)| unit.powf(exponent)).product()
    }

    fn wave(&mut self, wave: Wave) -> Wave {
        self.waves.push(wave.denominator);
        wave
    }
}

/// The model of a number, with time and length in units that are so many times as large.
pub fn model(index: u64, [time, length]: [f64; 2]) -> Model {
    let mut random = Random::of(index);
    let units = if random.once_in(2) {
        [
            random.magnitude(1e-3, 1e2),
            random.magnitude(1e-5, 1.0),
            random.magnitude(1e-6, 1.0),
        ]
    } else {
        [1.0; 3]
    };
    let coordinates = random.one_of(&[1, 1, 1, 2, 2, 3]);
    let model = Model {
        name: format!("Model{index}"),
        coordinates,
        left: vec![Vec::new(); coordinates],
        right: vec![Vec::new(); coordinates],
        sharpest: 1.0,
        divisor: 1,
        ..Model::default()
    };
    let mut draft = Draft {
        random,
        model,
        units: [units[0], time * units[1], length * units[2]],
        waves: Vec::new(),
    };
    structure(&mut draft);
    nonlinearities(&mut draft);
    excitation(&mut draft);
    range(&mut draft);
    draft.model.size = draft.unit(LENGTH);
    draft.model.divisor = draft.waves.iter().copied().fold(1, least_common_multiple);
    draft.model
}

/// Masses, springs and dampers to the ground and in a row.
fn structure(draft: &mut Draft) {
    let count = draft.model.coordinates;
    for i in 0..count {
        let mass = if draft.random.once_in(2) {
            1.0
        } else {
            draft.random.between(0.5, 2.5)
        };
        let mass = draft.quantity("m", mass, MASS);
        draft.model.masses.push(mass);
        let zeta = draft.random.magnitude(0.003, 0.15);
        let c = draft.quantity("c", 2.0 * zeta, DAMPING);
        draft.model.left[i].push(c.times(Expression::Velocity(i)));
        if !draft.random.once_in(if count == 1 { 6 } else { 4 }) {
            let k = draft.random.between(0.3, 2.0);
            // Two wells, where a cubic spring comes beside.
            let k = if draft.random.once_in(15) { -k } else { k };
            if k < 0.0 {
                let cubic = draft.random.between(0.5, 1.5) * draft.unit(STIFFNESS)
                    / draft.unit(LENGTH).powi(2);
                let cubic = draft.parameter("w", cubic);
                let power = Expression::Position(i).to(Expression::Number(3.0));
                draft.model.left[i].push(cubic.times(power));
            }
            let k = draft.quantity("k", k, STIFFNESS);
            draft.model.left[i].push(k.times(Expression::Position(i)));
        }
    }
    for i in 1..count {
        let h = draft.random.between(0.2, 2.0);
        let e = draft.random.magnitude(0.003, 0.05);
        let h = draft.quantity("h", h, STIFFNESS);
        let e = draft.quantity("e", e, DAMPING);
        for [a, b] in [[i - 1, i], [i, i - 1]] {
            let x = Expression::Position(a).plus(Expression::Position(b).negative());
            let v = Expression::Velocity(a).plus(Expression::Velocity(b).negative());
            draft.model.left[a].push(h.clone().times(x));
            draft.model.left[a].push(e.clone().times(v));
        }
    }
}

/// Contacts with laws, and polynomials.
fn nonlinearities(draft: &mut Draft) {
    let count = draft.model.coordinates;
    let polynomial = draft.random.once_in(4);
    if polynomial {
        let stiffness = draft.random.between(0.05, 1.0);
        let cubic = |draft: &Draft| stiffness * draft.unit(STIFFNESS) / draft.unit(LENGTH).powi(2);
        if count == 1 {
            let power = draft.random.one_of(&[3.0, 5.0]);
            let size = cubic(draft) * draft.unit(LENGTH).powf(3.0 - power);
            let s = draft.parameter("s", size);
            let x = Expression::Position(0).to(Expression::Number(power));
            draft.model.left[0].push(s.times(x));
        } else {
            let size = cubic(draft);
            let s = draft.parameter("s", size);
            for [a, b] in [[0, 1], [1, 0]] {
                let square = Expression::Position(b).to(Expression::Number(2.0));
                let product = Expression::Product(vec![s.clone(), square, Expression::Position(a)]);
                draft.model.left[a].push(product);
            }
        }
    }
    if count > 1 && draft.random.once_in(10) {
        return balls(draft);
    }
    let laws = match (polynomial, draft.random.below(3)) {
        (true, 0) => 0,
        (_, 1) => 2,
        _ => 1,
    };
    for _ in 0..laws {
        let law = laws::law(draft);
        attach(draft, law);
    }
}

/// A contact of a coordinate with the ground, or of two.
fn attach(draft: &mut Draft, law: Law) {
    let count = draft.model.coordinates;
    let random = &mut draft.random;
    let a = random.below(count);
    let factor = random.one_of(&[1.0, 1.0, 1.0, -1.0, 2.0 / 3.0]);
    let whole = |coordinate, factor| Term {
        coordinate,
        factor,
        wave: None,
    };
    let mut terms = vec![whole(a, factor)];
    if count > 1 && random.once_in(2) {
        terms.push(whole((a + 1) % count, -factor));
    }
    let apart = random.between(-0.5, 1.2);
    let distance = random.once_in(2).then_some(apart);
    let moves = random.once_in(6);
    let amplitude = random.between(0.05, 0.5);
    let modulated = random.once_in(8);
    let distance = distance.map(|d| draft.quantity("d", d, LENGTH));
    let moving = moves.then(|| {
        let wave = some_wave(draft, true);
        (draft.quantity("b", amplitude, LENGTH), wave)
    });
    let factor = modulated.then(|| {
        let depth = draft.random.between(0.05, 0.4);
        let wave = Expression::Wave(some_wave(draft, false));
        Expression::Number(1.0).plus(Expression::Number(depth).times(wave))
    });
    draft.model.laws.push(law);
    draft.model.contacts.push(Contact {
        law: draft.model.laws.len() - 1,
        terms,
        distance,
        moving,
        factor,
    });
}

/// Balls that roll around the first two coordinates, as in a bearing.
fn balls(draft: &mut Draft) {
    let law = laws::one_sided(draft);
    draft.model.laws.push(law);
    let law = draft.model.laws.len() - 1;
    let (numerator, denominator) = draft.random.one_of(&[(1, 1), (1, 2), (2, 5)]);
    let clearance = draft.random.between(-0.2, 0.3);
    let clearance = draft.quantity("d", clearance, LENGTH);
    let cosine = draft.wave(Wave::cosine(numerator, denominator));
    let sine = Wave::sine(numerator, denominator);
    // At angles of a right angle apart: directions (cos, sin), (-sin, cos) and so on.
    let directions = [
        [(1.0, cosine), (1.0, sine)],
        [(-1.0, sine), (1.0, cosine)],
        [(-1.0, cosine), (-1.0, sine)],
        [(1.0, sine), (-1.0, cosine)],
    ];
    let balls = draft.random.one_of(&[1, 2, 4]);
    debug_assert!(balls <= CONTACTS && draft.model.coordinates <= COORDINATES);
    for direction in directions.into_iter().take(balls) {
        let terms = direction.iter().enumerate();
        let terms = terms.map(|(coordinate, &(factor, wave))| Term {
            coordinate,
            factor,
            wave: Some(wave),
        });
        draft.model.contacts.push(Contact {
            law,
            terms: terms.collect(),
            distance: Some(clearance.clone()),
            moving: None,
            factor: None,
        });
    }
}

/// A wave of omega, of a multiple, or of a fraction.
fn some_wave(draft: &mut Draft, sine: bool) -> Wave {
    let (numerator, denominator) =
        draft
            .random
            .one_of(&[(1, 1), (1, 1), (1, 1), (2, 1), (3, 1), (1, 2), (2, 5)]);
    let wave = Wave {
        sine,
        ..Wave::cosine(numerator, denominator)
    };
    draft.wave(wave)
}

fn excitation(draft: &mut Draft) {
    let count = draft.model.coordinates;
    let driven = draft.random.below(count);
    let amplitude = draft.random.magnitude(0.03, 2.0);
    let base = Expression::Wave(Wave::cosine(1, 1));
    let unbalance = draft.random.once_in(10);
    let drive = if unbalance {
        let moment = draft.quantity("u", amplitude, [1.0, 0.0, 1.0]);
        let square = Expression::Omega.to(Expression::Number(2.0));
        Expression::Product(vec![moment, square, base])
    } else {
        draft.quantity("drive", amplitude, FORCE).times(base)
    };
    draft.model.right[driven].push(drive);
    if draft.random.once_in(5) {
        let part = draft.random.between(0.1, 0.6);
        let second = draft.quantity("f", part * amplitude, FORCE);
        let sine = draft.random.once_in(2);
        let wave = Expression::Wave(some_wave(draft, sine));
        draft.model.right[driven].push(second.times(wave));
    }
    // What has nothing to come back to but a contact needs a load towards it.
    let free = draft
        .model
        .parameters
        .iter()
        .all(|p| !p.name.starts_with('k'));
    let load = draft.random.between(0.1, 1.0);
    let load = if draft.random.once_in(4) { -load } else { load };
    if free || draft.random.once_in(3) {
        let loaded = draft.random.below(count);
        let load = draft.quantity("load", load, FORCE);
        draft.model.right[loaded].push(load);
    }
}

fn range(draft: &mut Draft) {
    let centre = draft.random.magnitude(0.4, 2.2);
    let width = draft.random.magnitude(1.05, 1.5);
    let unit = draft.unit([0.0, -1.0, 0.0]);
    let [low, high] = [centre / width * unit, centre * width * unit];
    draft.model.range = if draft.random.once_in(2) {
        [low, high]
    } else {
        [high, low]
    };
}

fn least_common_multiple(a: u32, b: u32) -> u32 {
    let (mut divisor, mut rest) = (a, b);
    while rest > 0 {
        (divisor, rest) = (rest, divisor % rest);
    }
    a / divisor * b
}
