//! How fast orbits converge with the nodes of a stretch, against shooting.

use super::{OneSided, solved};
use crate::contact_equation::orbit::motion::Motion;
use crate::system::System;
use crate::{FrequencyResponse, Shooting};

crate::oscillator! {
    /// A stop that moves at another frequency than the load.
    Moving(x) {
        law stop(gap) { gap > 0 => 3*gap^1.5 + 0.2*gap*dot(gap), else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x - 0.3 - 0.1*cos(2*omega*t)) = 0.5*cos(omega*t);
    }
}

crate::oscillator! {
    /// A stop that is pressed on: the force jumps.
    Pressed(x) {
        law stop(gap) { gap > 0 => 4*gap + 0.3, else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x - 0.5) = 0.2 + 0.5*cos(omega*t);
    }
}

crate::oscillator! {
    /// A contact with damping that does not pull, and a damper in one direction: kinks in the rate.
    Kinked(x) {
        law stop(gap) { gap > 0 => max(0, 3*gap + 4*gap*dot(gap)), else => 0 }
        law damper(gap) { 0.4*max(0, dot(gap)) }
        ddot(x) + 0.1*dot(x) + x + stop(x - 0.3) + damper(x) = 0.8*cos(omega*t);
    }
}

crate::oscillator! {
    /// A gear with backlash: contact on both flanks, softer than linear on one of them.
    Flanks(x) {
        law teeth(gap) {
            gap > 0.3  => 2*(gap - 0.3)^1.5,
            gap < -0.3 => -3*(-gap - 0.3),
            else       => 0,
        }
        ddot(x) + 0.1*dot(x) + 0.3*x + teeth(x) = 0.1 + 0.6*cos(omega*t);
    }
}

/// Parts of peak-to-peak that so many nodes leave out of it.
const ALLOWED: [(usize, f64); 3] = [(12, 1e-5), (24, 1e-9), (32, 1e-12)];
/// The same on a flank on which the gap swings one and a half times before it opens again, as long as the stretch is no panels.
const SWINGING: [(usize, f64); 3] = [(12, 2e-4), (24, 2e-8), (32, 2e-11)];

#[test]
fn a_stretch_is_known_to_twelve_digits_by_32_nodes() {
    let one = |alpha: f64| -> Box<dyn System> {
        Box::new(OneSided {
            alpha,
            load: 1.0,
            drive: 0.3,
        })
    };
    let systems: [(&str, Box<dyn System>, f64, _); 11] = [
        ("1", one(1.0), 0.7, ALLOWED),
        ("3/2", one(1.5), 0.7, ALLOWED),
        ("0.4", one(0.4), 0.7, ALLOWED),
        ("0.6", one(0.6), 0.7, ALLOWED),
        ("1.2", one(1.2), 1.2, ALLOWED),
        ("2.7", one(2.7), 0.7, ALLOWED),
        ("two flanks", Box::new(Flanks {}), 1.4, ALLOWED),
        ("two flanks, long", Box::new(Flanks {}), 0.6, SWINGING),
        ("jump", Box::new(Pressed {}), 1.2, ALLOWED),
        ("moving gap", Box::new(Moving {}), 0.9, ALLOWED),
        ("kinks in the rate", Box::new(Kinked {}), 0.9, ALLOWED),
    ];
    let mut short = Vec::new();
    for (name, system, omega, limits) in &systems {
        let shooting = FrequencyResponse::of(&**system).by(Shooting::new().tolerance(1e-14));
        for &(nodes, allowed) in limits {
            let (mut equations, u) = solved(&**system, *omega, nodes);
            equations.compute(&u, false);
            let [low, high] = Motion::of(&equations).coordinate_extremes()[0];
            let mut begin = vec![0.0; 2];
            Motion::of(&equations).at(0.0, &mut begin);
            let exact = shooting.clone().near_state(&begin).orbit(*omega).unwrap();
            let error = (high.value - low.value) / exact.peak_to_peak() - 1.0;
            println!("{name}: {nodes} nodes, {error:.1e}");
            if error.abs() > allowed {
                short.push((*name, nodes, error));
            }
        }
    }
    assert_eq!(short, []);
}
