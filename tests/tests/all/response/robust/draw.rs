//! Models, parameters and requests, drawn at random.

use hertzian::{Aft, FrequencyResponse, System};
use hertzian_tests::random::Random;

hertzian::oscillator! {
    /// A contact that opens, with damping that ends with it.
    OneSided(x) {
        param k > 0;
        param alpha > 0;
        param c >= 0;
        param load;
        param drive;
        law contact(gap) { gap > 0 => k*gap^alpha + c*dot(gap), else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// A spring of any power.
    Continuous(x) {
        param k > 0;
        param alpha > 0;
        param c >= 0;
        param load;
        param drive;
        ddot(x) + c*dot(x) + k*sgn(x)*|x|^alpha = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// Play between two flanks.
    Backlash(x) {
        param k > 0;
        param alpha > 0;
        param play > 0;
        param c >= 0;
        param load;
        param drive;
        law flanks(gap) {
            gap > play           => k*(gap - play)^alpha,
            -play <= gap <= play => 0,
            gap < -play          => -k*(-gap - play)^alpha,
        }
        ddot(x) + c*dot(x) + flanks(x) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// Teeth that are damped where they touch, and whose stiffness varies.
    Gears(x) {
        param k > 0;
        param alpha > 0;
        param beta > 0;
        param play > 0;
        param c >= 0;
        param mesh in 0.0..1.0;
        param load;
        param drive;
        law teeth(gap) {
            gap > play           => k*(gap - play)^alpha + c*dot(gap),
            -play <= gap <= play => 0,
            gap < -play          => -k*(-gap - play)^beta + c*dot(gap),
        }
        ddot(x) + (1 + mesh*cos(omega*t))*teeth(x) = drive*sin(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// A spring and a stop whose force begins with a jump.
    PreloadedStop(x) {
        param k > 0;
        param alpha > 0;
        param base > 0;
        param preload >= 0;
        param distance;
        param c >= 0;
        param load;
        param drive;
        law stop(gap) { gap >= 0 => preload + k*gap^alpha, else => 0 }
        ddot(x) + c*dot(x) + base*x + stop(x - distance) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// Damping that grows with the force.
    HuntCrossley(x) {
        param k > 0;
        param alpha > 0;
        param c >= 0;
        param distance;
        param load;
        param drive;
        law contact(gap) { gap > 0 => k*gap^alpha*(1 + c*dot(gap)), else => 0 }
        ddot(x) + contact(x - distance) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// Attraction by a negative power outside of a contact.
    Attraction(x) {
        param k > 0;
        param alpha > 0;
        param beta > 0;
        param h > 0;
        param a > 0;
        param base > 0;
        param distance;
        param c >= 0;
        param load;
        param drive;
        law surface(gap) {
            gap > 0 => k*gap^alpha - h/a^beta,
            else    => -h/(a - gap)^beta,
        }
        ddot(x) + c*dot(x) + base*x + surface(x - distance) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// Two slopes that meet away from rest.
    Bilinear(x) {
        param k > 0;
        param base > 0;
        param distance;
        param c >= 0;
        param load;
        param drive;
        law spring(gap) { gap > 0 => k*gap, else => base*gap }
        ddot(x) + c*dot(x) + spring(x - distance) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// Two masses that strike each other.
    TwoMasses(x, y) {
        param k > 0;
        param alpha > 0;
        param base > 0;
        param distance;
        param c >= 0;
        param load;
        param drive;
        law contact(gap) { gap > 0 => k*gap^alpha + c*dot(gap), else => 0 }
        ddot(x) + c*dot(x) + base*x + contact(x - y - distance) = drive*cos(omega*t) + load;
        2*ddot(y) + c*dot(y) + base*y - contact(x - y - distance) = 0;
    }
}

/// Six decades about one.
fn decades(random: &mut Random) -> f64 {
    random.magnitude(1e-3, 1e3)
}

/// Six decades of either sign, or zero.
fn signed(random: &mut Random) -> f64 {
    let size = decades(random);
    match random.below(6) {
        0 => 0.0,
        1 => -size,
        _ => size,
    }
}

fn exponent(random: &mut Random) -> f64 {
    match random.below(8) {
        0 => 1.0,
        1 => 1.5,
        _ => random.between(0.3, 4.0),
    }
}

/// A model with these parameters.
macro_rules! with {
    ($model:ident: $($parameter:ident),*) => {
        Box::new($model { $($parameter),* })
    };
}

/// A model, and a frequency that has to do with it.
pub(crate) fn model(random: &mut Random) -> (Box<dyn System + Send>, f64) {
    let kind = random.below(9);
    let (k, alpha, beta) = (decades(random), exponent(random), exponent(random));
    let (load, drive) = (signed(random), decades(random));
    let (base, play) = (decades(random), decades(random));
    let distance = signed(random);
    // The stiffness that a static force of that size meets, as a line through the origin.
    let force = if load == 0.0 { drive } else { load.abs() };
    let secant = force / (force / k).powf(alpha.recip());
    let stiffness = match kind {
        4 | 6 => base,
        5 | 0..=3 => secant,
        7 => k,
        _ => base.max(secant),
    };
    let natural = stiffness.sqrt();
    let zeta = if random.once_in(5) {
        0.0
    } else {
        random.magnitude(1e-3, 0.3)
    };
    let c = match kind {
        5 => zeta,
        _ => 2.0 * zeta * natural,
    };
    let mesh = random.between(0.0, 1.0);
    let preload = signed(random).max(0.0);
    let (h, a) = (decades(random), decades(random));
    let model: Box<dyn System + Send> = match kind {
        0 => with!(OneSided: k, alpha, c, load, drive),
        1 => with!(Continuous: k, alpha, c, load, drive),
        2 => with!(Backlash: k, alpha, play, c, load, drive),
        3 => with!(Gears: k, alpha, beta, play, c, mesh, load, drive),
        4 => with!(PreloadedStop: k, alpha, base, preload, distance, c, load, drive),
        5 => with!(HuntCrossley: k, alpha, c, distance, load, drive),
        6 => with!(Attraction: k, alpha, beta, h, a, base, distance, c, load, drive),
        7 => with!(Bilinear: k, base, distance, c, load, drive),
        _ => with!(TwoMasses: k, alpha, base, distance, c, load, drive),
    };
    (model, natural)
}

/// The name and the value of some parameter that is not zero.
fn any_parameter(random: &mut Random, system: &dyn System) -> (String, f64) {
    let parameters = &system.facts().parameters;
    let mut values = vec![0.0; parameters.len()];
    system.values(&mut values);
    let named = parameters.iter().zip(&values);
    let usable: Vec<_> = named.filter(|(_, value)| **value != 0.0).collect();
    let chosen = random.below(usable.len());
    let (parameter, value) = usable[chosen];
    (parameter.name.to_string(), *value)
}

/// What is asked of a model.
#[derive(Debug)]
pub(crate) struct Request {
    /// The parameter that is varied, and the frequency then; or the frequency is.
    parameter: Option<(String, f64)>,
    from: f64,
    to: f64,
    harmonics: Option<usize>,
    aft: Aft,
    period: usize,
    stability: bool,
    points: usize,
}

impl Request {
    pub(crate) fn draw(random: &mut Random, system: &dyn System, natural: f64) -> Self {
        let centre = if random.once_in(4) {
            decades(random)
        } else {
            natural
        };
        let parameter = random.once_in(4).then(|| any_parameter(random, system));
        let (mut from, mut to) = match &parameter {
            Some((_, value)) => (
                value * random.between(0.3, 1.0),
                value * random.between(1.0, 2.0),
            ),
            None if random.once_in(2) => (centre, centre * random.between(1.001, 1.1)),
            None => (
                centre * random.between(0.2, 1.0),
                centre * random.between(1.0, 3.0),
            ),
        };
        let parameter = parameter.map(|(name, _)| (name, centre * random.between(0.3, 2.0)));
        if random.once_in(2) {
            std::mem::swap(&mut from, &mut to);
        }
        // A range takes some 70 points or more, so that few come to its end; most cases are about the start.
        let most = if random.once_in(8) { 400 } else { 10 };
        let points = 3 + random.below(most);
        Self {
            parameter,
            from,
            to,
            harmonics: random.once_in(3).then(|| 1 + random.below(40)),
            aft: match random.below(8) {
                0 => Aft::Sampled,
                1 => Aft::Primitive,
                _ => Aft::Switched,
            },
            period: if random.once_in(20) { 2 } else { 1 },
            stability: random.once_in(2),
            points,
        }
    }

    pub(crate) fn of(&self, system: &dyn System) -> FrequencyResponse {
        let mut response = FrequencyResponse::of(system)
            .from(self.from)
            .to(self.to)
            .aft(self.aft)
            .period(self.period)
            .stability(self.stability)
            .max_points(self.points);
        if let Some((name, omega)) = &self.parameter {
            response = response.vary(name.as_str()).omega(*omega);
        }
        match self.harmonics {
            Some(harmonics) => response.harmonics(harmonics),
            None => response,
        }
    }
}
