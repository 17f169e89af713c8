//! Laws drawn at random: powers, contacts, smooth and sharp ones, and those of the rate.

use crate::differential::draw::{DAMPING, Draft, FORCE, LENGTH, SPEED, STIFFNESS};
use crate::differential::expression::Expression;
use crate::differential::model::{Law, Sharp, Variable};

fn zero() -> Expression {
    Expression::Number(0.0)
}

fn one() -> Expression {
    Expression::Number(1.0)
}

/// One of all kinds.
pub fn law(draft: &mut Draft) -> Law {
    match draft.random.below(12) {
        0..=2 => one_sided(draft),
        3 => backlash(draft),
        4 => surface(draft),
        5 => both_sides(draft),
        6 => slopes(draft),
        7 | 8 => sharp_of_gap(draft),
        9 => sharp_of_rate(draft),
        10 => of_rate(draft),
        _ => exponential(draft),
    }
}

fn whole(expression: Expression) -> Law {
    Law {
        pieces: vec![expression],
        ..Law::default()
    }
}

/// One that changes with a ratio of a variable to a width.
fn sharp(expression: Expression, of: Variable, width: Expression) -> Law {
    Law {
        sharp: Some(Sharp { of, width }),
        ..whole(expression)
    }
}

/// An exponent and a base: a plain number or a parameter, of which the base is a plain number then.
fn power(draft: &mut Draft, base: Expression, size: f64) -> Expression {
    let random = &mut draft.random;
    let exponent = match random.below(8) {
        0 => 1.0,
        1 | 2 => 1.5,
        3 => 2.0,
        4 => 3.0,
        5 => random.one_of(&[4.0, 2.5]),
        6 => random.between(0.5, 1.0),
        _ => random.between(1.0, 4.0),
    };
    if draft.random.once_in(4) {
        let force = draft.quantity("s", size, FORCE);
        let length = draft.quantity("u", 1.0, LENGTH);
        let exponent = draft.parameter("n", exponent);
        force.times(base.over(length).to(exponent))
    } else {
        let size = size * draft.unit(FORCE) / draft.unit(LENGTH).powf(exponent);
        let size = draft.parameter("s", size);
        size.times(base.to(Expression::Number(exponent)))
    }
}

/// A stop, with or without damping.
pub fn one_sided(draft: &mut Draft) -> Law {
    let size = draft.random.magnitude(0.2, 50.0);
    let spring = power(draft, Expression::Gap, size);
    let mut bend = None;
    let above = match draft.random.below(7) {
        0 => {
            let c = draft.random.magnitude(0.005, 0.3);
            let c = draft.quantity("c", c, DAMPING);
            spring.plus(c.times(Expression::Rate))
        }
        1 | 2 => {
            let c = draft.random.magnitude(0.01, 0.5);
            let c = draft.quantity("c", c, [0.0, 1.0, -1.0]);
            let damping = one().plus(c.clone().times(Expression::Rate));
            let force = spring.times(damping);
            if draft.random.once_in(2) {
                bend = Some((Variable::Rate, one().negative().over(c)));
                force.positive()
            } else {
                force
            }
        }
        3 if draft.random.once_in(2) => {
            let preload = draft.random.between(0.05, 0.5);
            draft.quantity("p", preload, FORCE).plus(spring)
        }
        _ => spring,
    };
    Law {
        levels: vec![zero()],
        pieces: vec![zero(), above],
        bend,
        ..Law::default()
    }
}

/// Play between two flanks.
fn backlash(draft: &mut Draft) -> Law {
    let play = draft.random.between(0.1, 1.0) * draft.unit(LENGTH);
    let play = draft.parameter("play", play);
    let sizes = [
        draft.random.magnitude(0.5, 20.0),
        draft.random.magnitude(0.5, 20.0),
    ];
    let above = Expression::Gap.plus(play.clone().negative());
    let below = Expression::Gap.negative().plus(play.clone().negative());
    Law {
        levels: vec![play.clone().negative(), play],
        pieces: vec![
            power(draft, below, sizes[0]).negative(),
            zero(),
            power(draft, above, sizes[1]),
        ],
        ..Law::default()
    }
}

/// Attraction outside of a contact.
fn surface(draft: &mut Draft) -> Law {
    let size = draft.random.magnitude(0.5, 20.0);
    let a = draft.random.between(0.2, 1.0);
    let h = draft.random.between(0.02, 0.3) * a * a;
    let spring = power(draft, Expression::Gap, size);
    let h = draft.quantity("h", h, [1.0, -2.0, 3.0]);
    let a = a * draft.unit(LENGTH);
    let a = draft.parameter("a", a);
    let square = |base: Expression| h.clone().over(base.to(Expression::Number(2.0)));
    let outside = a.clone().plus(Expression::Gap.negative());
    Law {
        levels: vec![zero()],
        pieces: vec![
            square(outside).negative(),
            spring.plus(square(a).negative()),
        ],
        ..Law::default()
    }
}

/// A power on both sides of zero.
fn both_sides(draft: &mut Draft) -> Law {
    let size = draft.random.magnitude(0.2, 3.0);
    let power = power(draft, Expression::Gap.abs(), size);
    Law {
        bend: Some((Variable::Gap, zero())),
        ..whole(Expression::Gap.sign().times(power))
    }
}

/// Two or three slopes.
fn slopes(draft: &mut Draft) -> Law {
    let slope = |draft: &mut Draft| {
        let k = draft.random.magnitude(0.3, 10.0);
        draft.quantity("k", k, STIFFNESS)
    };
    let [low, middle] = [slope(draft), slope(draft)];
    let gap = || Expression::Gap;
    if draft.random.once_in(2) {
        return Law {
            levels: vec![zero()],
            pieces: vec![low.times(gap()), middle.times(gap())],
            ..Law::default()
        };
    }
    let high = slope(draft);
    let level = draft.random.between(0.2, 0.9) * draft.unit(LENGTH);
    let level = draft.parameter("l", level);
    let beyond = gap().plus(level.clone().negative());
    let above = middle.clone().times(level.clone()).plus(high.times(beyond));
    Law {
        levels: vec![zero(), level],
        pieces: vec![low.times(gap()), middle.times(gap()), above],
        ..Law::default()
    }
}

/// How sharp a smooth law is.
fn sharpness(draft: &mut Draft) -> f64 {
    let sharpness = draft.random.magnitude(1e-4, 1.0);
    draft.model.sharpest = draft.model.sharpest.min(sharpness);
    sharpness
}

fn sharp_of_gap(draft: &mut Draft) -> Law {
    let sharpness = sharpness(draft);
    let size = draft.random.magnitude(0.05, 1.0);
    let force = draft.quantity("s", size, FORCE);
    let width = sharpness * draft.unit(LENGTH);
    let scale = draft.parameter("w", width);
    let ratio = Expression::Gap.over(scale.clone());
    let square = ratio.clone().to(Expression::Number(2.0));
    let force = match draft.random.below(7) {
        0 | 1 => force.times(ratio.tanh()),
        2 => Expression::Product(vec![force, ratio, square.negative().exp()]),
        3 => force.times(square.negative().exp()),
        4 => force.over(one().plus(ratio.to(Expression::Number(8.0)))),
        5 => force.over(one().plus(ratio.negative().exp())),
        _ => force.times(ratio.over(one().plus(square))),
    };
    sharp(force, Variable::Gap, scale)
}

fn sharp_of_rate(draft: &mut Draft) -> Law {
    let sharpness = sharpness(draft);
    let size = draft.random.magnitude(0.02, 0.4);
    let size = if draft.random.once_in(4) {
        -0.3 * size
    } else {
        size
    };
    let force = draft.quantity("s", size, FORCE);
    let width = sharpness * draft.unit(SPEED);
    let scale = draft.parameter("v", width);
    let ratio = Expression::Rate.over(scale.clone());
    let square = ratio.clone().to(Expression::Number(2.0));
    let force = match draft.random.below(4) {
        0 | 1 => force.times(ratio.tanh()),
        2 => force.over(one().plus(ratio.negative().exp())),
        _ => force.times(ratio.over(one().plus(square))),
    };
    sharp(force, Variable::Rate, scale)
}

/// Forces of the rate that are not smooth.
fn of_rate(draft: &mut Draft) -> Law {
    let size = draft.random.magnitude(0.01, 0.5);
    let rate = || Expression::Rate;
    if draft.random.once_in(2) {
        let c = draft.quantity("c", size, [1.0, 0.0, -1.0]);
        return whole(c.times(rate().abs().times(rate())));
    }
    let c = draft.quantity("c", size, DAMPING);
    let (force, bend) = if draft.random.once_in(2) {
        (c.times(rate().positive()), zero())
    } else {
        let level = draft.random.between(-0.3, 0.3);
        let level = draft.quantity("r", level, SPEED);
        let above = rate().plus(level.clone().negative());
        (c.times(above).positive(), level)
    };
    Law {
        bend: Some((Variable::Rate, bend)),
        ..whole(force)
    }
}

/// A spring that hardens as an exponential.
fn exponential(draft: &mut Draft) -> Law {
    let size = draft.random.between(0.05, 0.5);
    let force = draft.quantity("s", size, FORCE);
    let scale = draft.random.between(0.3, 1.5) * draft.unit(LENGTH);
    let scale = draft.parameter("w", scale);
    let grown = Expression::Gap.over(scale).exp();
    whole(force.times(grown.plus(one().negative())))
}
