//! The models that are compared. A new one is a declaration, and a line of the table.

use hertzian::oscillator;
use hertzian::system::System;

use crate::random::Random;

type Model = fn(&mut Random) -> Box<dyn System>;

/// Names, and models with random parameters.
pub const MODELS: &[(&str, Model)] = &[
    ("one-sided Hertz", |r| {
        Box::new(Hertz {
            zeta: r.within(0.0, 0.5),
        })
    }),
    ("continuous power", |r| {
        Box::new(Continuous {
            alpha: r.within(0.05, 4.0),
        })
    }),
    ("one-sided, exponent 0.6", |r| {
        Box::new(Soft {
            zeta: r.within(0.0, 0.5),
        })
    }),
    ("backlash", |r| {
        Box::new(Backlash {
            play: r.within(0.0, 2.0),
        })
    }),
    ("Hunt-Crossley", |r| {
        Box::new(HuntCrossley {
            k: r.within(0.1, 9.0),
            c: r.within(0.0, 0.9),
        })
    }),
];

oscillator! {
    /// One-sided Hertz contact with damping.
    Hertz(x) {
        /// damping ratio
        param zeta in 0.0..;

        /// gap > 0 is penetration
        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap^1.5,
            else    => 0,
        }

        ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
    }
}

oscillator! {
    /// A power of either sign, its exponent a parameter.
    Continuous(x) {
        /// exponent
        param alpha > 0;

        ddot(x) + 0.064*dot(x) + sgn(x)*|x|^alpha = 0.1*cos(omega*t);
    }
}

oscillator! {
    /// One-sided contact with unbounded stiffness at touch.
    Soft(x) {
        /// damping ratio
        param zeta in 0.0..;

        /// gap > 0 is penetration
        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap^0.6,
            else    => 0,
        }

        ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
    }
}

oscillator! {
    /// Backlash: no force within the play.
    Backlash(x) {
        /// half of the play
        param play > 0;

        /// gap beyond the play on either side
        law teeth(gap) {
            gap > play  => gap - play,
            gap < -play => gap + play,
            else        => 0,
        }

        ddot(x) + 0.064*dot(x) + teeth(x) = 0.1*cos(omega*t);
    }
}

oscillator! {
    /// Contact whose damping grows with the force.
    HuntCrossley(x) {
        /// stiffness
        param k > 0;
        /// damping
        param c in 0.0..;

        /// gap > 0 is penetration
        law contact(gap) {
            gap > 0 => k*gap^1.5*(1 + c*dot(gap)),
            else    => 0,
        }

        ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
    }
}
