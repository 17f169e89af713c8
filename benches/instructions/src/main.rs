//! Calls generated laws, one after the other, inside of `measured`, and prints what it called: `run.sh` lets callgrind count the
//! instructions of each call.
//!
//! Two batches: 1027 samples on all pieces, as sampled methods ask for them, and not a whole number of vectors; and 40 on
//! one piece, as quadrature between two crossings does.
//!
//! With the argument `numerics` it calls what a [branch](numerics) is made of instead, inside of `counted`.

mod numerics;

use std::hint::black_box;

use hertzian::law;
use hertzian::law::{Derivatives, Law, On};

law! {
    /// A spring of exponent 3/2 of either sign, with damping.
    Continuous(gap, zeta) {
        gap > 0 => 2*zeta*dot(gap) + gap^1.5,
        else    => 2*zeta*dot(gap) - (-gap)^1.5,
    }
}

law! {
    /// Hertz contact with damping.
    OneSided(gap, zeta) {
        gap > 0 => 2*zeta*dot(gap) + gap^1.5,
        else    => 0,
    }
}

law! {
    /// As `Continuous`, the exponent an argument.
    ContinuousPower(gap, zeta, alpha > 0) {
        gap > 0 => 2*zeta*dot(gap) + gap^alpha,
        else    => 2*zeta*dot(gap) - (-gap)^alpha,
    }
}

law! {
    /// As `OneSided`, the exponent an argument.
    OneSidedPower(gap, zeta, alpha > 0) {
        gap > 0 => 2*zeta*dot(gap) + gap^alpha,
        else    => 0,
    }
}

law! {
    /// Damping that grows with the force, Hunt and Crossley (1975).
    HuntCrossley(gap, c, n >= 1) {
        gap > 0 => gap^n*(1 + c*dot(gap)),
        else    => 0,
    }
}

law! {
    /// Backlash with flanks of exponent 10/9, that of line contacts.
    Flanks(gap, play > 0) {
        gap > play  => (gap - play)^(10/9),
        gap < -play => -(-gap - play)^(10/9),
        else        => 0,
    }
}

law! {
    /// Exponents of thirds and fourths.
    Rational(gap, k) {
        gap > 0 => k*gap^(4/3) + gap^1.25,
        else    => 0,
    }
}

law! {
    /// A cubic spring with a stop of exponent 5/2.
    Cubic(gap, k) {
        gap > 1 => gap^3 + k*(gap - 1)^2.5,
        else    => gap^3,
    }
}

law! {
    /// Attraction of van der Waals before contact, Derjaguin, Muller and Toporov (1975).
    Adhesion(gap, a > 0) {
        gap > 0 => gap^1.5 - a^-2,
        else    => -(a - gap)^-2,
    }
}

/// Name, law, arguments, and the argument to differentiate by.
type Subject = (&'static str, &'static dyn Law, &'static [f64], usize);

const SUBJECTS: [Subject; 9] = [
    ("continuous, 3/2", &Continuous, &[0.032], 0),
    ("one-sided, 3/2", &OneSided, &[0.032], 0),
    ("continuous, alpha", &ContinuousPower, &[0.032, 1.7], 1),
    ("one-sided, alpha", &OneSidedPower, &[0.032, 1.7], 1),
    ("Hunt-Crossley, n", &HuntCrossley, &[0.2, 1.6], 1),
    ("flanks, 10/9", &Flanks, &[0.3], 0),
    ("thirds and fourths", &Rational, &[2.0], 0),
    ("cubic and 5/2", &Cubic, &[2.0], 0),
    ("adhesion, -2", &Adhesion, &[0.5], 0),
];

/// What is asked of a law.
#[derive(Clone, Copy)]
enum Call {
    Force,
    Derivatives,
    ByArgument,
}

/// Inputs and outputs.
struct Batch {
    on: On,
    gap: Vec<f64>,
    rate: Vec<f64>,
    out: [Vec<f64>; 4],
}

impl Batch {
    /// One period of an orbit.
    fn on_all_pieces() -> Self {
        Self::new(On::AllPieces, 1027, 0.3)
    }

    /// Samples above all levels.
    fn on_last_piece(pieces: usize) -> Self {
        Self::new(On::Piece(pieces - 1), 40, 2.6)
    }

    fn new(on: On, count: usize, mean: f64) -> Self {
        let taus = (0..count).map(|i| std::f64::consts::TAU * i as f64 / count as f64);
        Self {
            on,
            gap: taus.clone().map(|tau| mean + 1.1 * tau.cos()).collect(),
            rate: taus.map(|tau| -1.1 * tau.sin()).collect(),
            out: std::array::from_fn(|_| vec![0.0; count]),
        }
    }
}

fn main() -> Result<(), hertzian::Error> {
    if std::env::args().any(|argument| argument == "numerics") {
        return numerics::all(&mut |name, work| {
            // Tables and workspaces are made before.
            work();
            counted(work);
            println!("{name}");
        });
    }
    laws();
    Ok(())
}

/// Every law, in every way that it is called.
fn laws() {
    for subject in &SUBJECTS {
        let pieces = subject.1.facts().pieces.len();
        for (name, mut batch) in [
            ("all pieces", Batch::on_all_pieces()),
            ("one piece", Batch::on_last_piece(pieces)),
        ] {
            for (what, call) in [
                ("force", Call::Force),
                ("force, by gap, by rate", Call::Derivatives),
                ("the same and by an argument", Call::ByArgument),
            ] {
                // What is chosen once per process is chosen before.
                evaluate(subject, call, &mut batch);
                measured(subject, call, &mut batch);
                println!("{}\t{name}\t{what}", subject.0);
            }
        }
    }
}

/// Callgrind counts between entry and return of a function of this name.
#[unsafe(no_mangle)]
#[inline(never)]
extern "Rust" fn measured(subject: &Subject, call: Call, batch: &mut Batch) {
    evaluate(subject, call, batch);
}

/// The same of what is not a law.
#[unsafe(no_mangle)]
#[inline(never)]
extern "Rust" fn counted(work: &mut dyn FnMut()) {
    work();
}

#[inline]
fn evaluate((_, law, arguments, by): &Subject, call: Call, batch: &mut Batch) {
    let Batch { on, gap, rate, out } = black_box(batch);
    let [force, by_gap, by_rate, by_argument] = out;
    if let Call::Force = call {
        law.force(*on, arguments, gap, rate, force);
        return;
    }
    let out = Derivatives {
        force,
        by_gap,
        by_rate,
    };
    match call {
        Call::ByArgument => {
            law.derivatives_and_by(*by, *on, arguments, gap, rate, out, by_argument);
        }
        _ => law.derivatives(*on, arguments, gap, rate, out),
    }
}
