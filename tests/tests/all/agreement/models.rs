//! The models that are compared. A new one is a declaration, and a line of the table.

use hertzian::oscillator;
use hertzian::system::System;
use hertzian_tests::random::Random;

type Model = fn(&mut Random) -> Box<dyn System>;

/// Names, and models with random parameters.
pub const MODELS: &[(&str, Model)] = &[
    ("one-sided Hertz", |r| {
        Box::new(Hertz {
            zeta: r.between(0.0, 0.5),
        })
    }),
    ("continuous power", |r| {
        Box::new(Continuous {
            alpha: r.between(0.05, 4.0),
        })
    }),
    ("one-sided, exponent 0.6", |r| {
        Box::new(Soft {
            zeta: r.between(0.0, 0.5),
        })
    }),
    ("backlash", |r| {
        Box::new(Backlash {
            play: r.between(0.0, 2.0),
        })
    }),
    ("Hunt-Crossley", |r| {
        Box::new(HuntCrossley {
            k: r.between(0.1, 9.0),
            c: r.between(0.0, 0.9),
        })
    }),
    ("linear contact", |r| {
        Box::new(LinearContact {
            k: r.between(0.1, 9.0),
            c: r.between(0.0, 0.9),
        })
    }),
    ("two powers", |r| {
        Box::new(TwoPowers {
            alpha: r.between(0.05, 2.0),
            beta: r.between(2.0, 4.0),
            weight: r.between(-1.0, 1.0),
        })
    }),
    ("rough layer", |r| {
        Box::new(RoughLayer {
            n: r.between(1.6, 4.0),
            layer: r.between(0.01, 1.0),
        })
    }),
    ("flanks", |r| {
        Box::new(Flanks {
            play: r.between(0.0, 2.0),
            drive_side: r.between(0.5, 3.0),
            coast_side: r.between(0.5, 3.0),
        })
    }),
    ("thirds and fourths", |r| {
        Box::new(Fractions {
            k: r.between(-2.0, 2.0),
            play: r.between(0.0, 2.0),
        })
    }),
    ("seal", |r| {
        Box::new(Seal {
            c: r.between(0.0, 0.9),
            n: r.between(1.05, 4.0),
        })
    }),
    ("Hunt-Crossley without tension", |r| {
        Box::new(NoTension {
            k: r.between(0.1, 9.0),
            c: r.between(0.0, 0.9),
        })
    }),
    ("backlash with different sides", |r| {
        Box::new(Gears {
            drive_side: r.between(0.1, 9.0),
            coast_side: r.between(0.1, 9.0),
            front: r.between(0.0, 2.0),
            back: r.between(0.0, 2.0),
        })
    }),
    ("bilinear", |r| {
        Box::new(Bilinear {
            pushed: r.between(0.1, 9.0),
            pulled: r.between(0.1, 9.0),
        })
    }),
    ("preloaded stop", |r| {
        Box::new(PreloadedStop {
            k: r.between(0.1, 9.0),
            preload: r.between(0.0, 2.0),
        })
    }),
    ("attraction and contact", |r| {
        Box::new(Tip {
            h: r.between(0.01, 1.0),
            a: r.between(0.01, 1.0),
            k: r.between(0.1, 9.0),
        })
    }),
    ("Duffing", |r| {
        Box::new(Duffing {
            beta: r.between(-1.0, 1.0),
        })
    }),
    ("van der Pol", |r| {
        Box::new(VanDerPol {
            mu: r.between(-1.0, 5.0),
        })
    }),
    ("quadratic damping", |r| {
        Box::new(QuadraticDamping {
            c: r.between(0.0, 2.0),
        })
    }),
    ("smooth friction", |r| {
        Box::new(SmoothFriction {
            friction: r.between(0.0, 2.0),
            speed: r.between(0.01, 1.0),
        })
    }),
    ("exponential well", |r| {
        Box::new(Well {
            depth: r.between(0.0, 2.0),
            width: r.between(0.1, 2.0),
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

oscillator! {
    /// Linear contact on one side: the damping force jumps.
    LinearContact(x) {
        /// stiffness
        param k > 0;
        /// damping
        param c in 0.0..;

        /// gap > 0 is penetration
        law contact(gap) { gap > 0 => k*gap + c*dot(gap), else => 0 }

        ddot(x) + contact(x) = cos(omega*t) + 1;
    }
}

oscillator! {
    /// Two powers of either sign, both exponents parameters.
    TwoPowers(x) {
        /// lower exponent
        param alpha > 0;
        /// higher exponent
        param beta > 0;
        /// factor of the second power
        param weight;

        ddot(x) + 0.064*dot(x) + sgn(x)*|x|^alpha + weight*sgn(x)*|x|^beta = 0.1*cos(omega*t);
    }
}

oscillator! {
    /// A power of a scaled gap beside a Hertz contact.
    RoughLayer(x) {
        /// exponent
        param n > 0;
        /// thickness of the layer
        param layer > 0;

        /// gap > 0 is penetration
        law rough(gap) { gap > 0 => gap^1.5 + layer^1.5*(gap/layer)^n, else => 0 }

        ddot(x) + rough(x) = 0.1*cos(omega*t) + 1;
    }
}

oscillator! {
    /// Teeth with an exponent on each side: the bases of the two powers differ.
    Flanks(x) {
        /// half of the backlash
        param play > 0;
        /// exponent above
        param drive_side > 0;
        /// exponent below
        param coast_side > 0;

        /// gap beyond either flank
        law teeth(gap) {
            gap > play  => (gap - play)^drive_side,
            gap < -play => -2*(-gap - play)^coast_side,
            else        => 0,
        }

        ddot(x) + teeth(x) = cos(omega*t);
    }
}

oscillator! {
    /// Exponents of thirds and fourths, on both sides of a play.
    Fractions(x) {
        /// weight
        param k;
        /// half of the play
        param play > 0;

        /// gap beyond either side
        law layers(gap) {
            gap > play  => (gap - play)^(4/3) + k*(gap - play)^1.25,
            gap < -play => -(-gap - play)^(5/3) - k*(-gap - play)^(2/3)*dot(gap),
            else        => 0,
        }

        ddot(x) + layers(x) = cos(omega*t);
    }
}

oscillator! {
    /// A power of what may not be negative and depends on the rate.
    Seal(x) {
        /// relaxation
        param c in 0.0..;
        /// exponent
        param n > 1;

        /// gap > 0 is penetration
        law lip(gap) { gap > 0 => max(0, gap + c*dot(gap))^n, else => 0 }

        ddot(x) + x + lip(x) = cos(omega*t);
    }
}

oscillator! {
    /// A fast separation does not pull: the force switches at a rate.
    NoTension(x) {
        /// stiffness
        param k > 0;
        /// damping
        param c in 0.0..;

        /// gap > 0 is penetration
        law contact(gap) { gap > 0 => max(0, k*gap^1.5*(1 + c*dot(gap))), else => 0 }

        ddot(x) + contact(x) = 1 + cos(omega*t);
    }
}

oscillator! {
    /// Play between flanks of different stiffness, which varies in time.
    Gears(x) {
        /// stiffness of the front flank
        param drive_side > 0;
        /// stiffness of the back flank
        param coast_side > 0;
        /// place of the front flank
        param front > 0;
        /// place of the back flank
        param back > 0;

        /// gap beyond either flank
        law teeth(gap) {
            gap > front           => drive_side*(gap - front),
            -back <= gap <= front => 0,
            gap < -back           => coast_side*(gap + back),
        }

        ddot(x) + 0.1*dot(x) + (1 + 0.2*cos(omega*t))*teeth(x) = 0.1;
    }
}

oscillator! {
    /// Two slopes that meet at zero.
    Bilinear(x) {
        /// stiffness above zero
        param pushed > 0;
        /// stiffness below zero
        param pulled > 0;

        /// either side of zero
        law spring(gap) { gap > 0 => pushed*gap, else => pulled*gap }

        ddot(x) + 0.05*dot(x) + spring(x) = cos(omega*t);
    }
}

oscillator! {
    /// The force begins at the preload: a static jump.
    PreloadedStop(x) {
        /// stiffness
        param k > 0;
        /// force at touch
        param preload in 0.0..;

        /// The level itself belongs to contact.
        law stop(gap) { gap >= 0 => preload + k*gap, else => 0 }

        ddot(x) + 0.05*dot(x) + x + stop(x - 1) = cos(omega*t);
    }
}

oscillator! {
    /// Van der Waals attraction outside, Hertz contact inside (DMT).
    Tip(x) {
        /// strength of the attraction
        param h > 0;
        /// distance that keeps it finite
        param a > 0;
        /// stiffness in contact
        param k > 0;

        /// gap > 0 is penetration
        law surface(gap) {
            gap > 0 => k*gap^1.5 - h/a^2,
            else    => -h*(a - gap)^-2,
        }

        ddot(x) + 0.01*dot(x) + x + surface(x - 1) = cos(omega*t);
    }
}

oscillator! {
    /// Cubic spring.
    Duffing(x) {
        /// cubic stiffness
        param beta;

        ddot(x) + 0.1*dot(x) + x + beta*x^3 = cos(omega*t);
    }
}

oscillator! {
    /// Damping that drives small motion.
    VanDerPol(x) {
        /// damping
        param mu;

        ddot(x) + mu*(x^2 - 1)*dot(x) + x = cos(omega*t);
    }
}

oscillator! {
    /// Drag.
    QuadraticDamping(x) {
        /// damping
        param c in 0.0..;

        ddot(x) + c*|dot(x)|*dot(x) + x = cos(omega*t);
    }
}

oscillator! {
    /// Dry friction made smooth.
    SmoothFriction(x) {
        /// force at high speed
        param friction in 0.0..;
        /// speed at which it is reached
        param speed > 0;

        ddot(x) + friction*tanh(dot(x)/speed) + x = cos(omega*t);
    }
}

oscillator! {
    /// A well with smooth walls.
    Well(x) {
        /// force
        param depth in 0.0..;
        /// width
        param width > 0;

        ddot(x) + 0.1*dot(x) + x + depth*x*exp(-(x/width)^2) = cos(omega*t);
    }
}
