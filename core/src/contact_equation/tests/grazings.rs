//! Touches of levels on random models, against shooting.

use super::{OneSided, TwoMasses, events_agree};
use crate::branches::point::Event;
use crate::system::System;
use crate::testing::random::Random;
use crate::{Branch, ContactEquation, EventKind, FrequencyResponse, Shooting};

crate::oscillator! {
    /// Equal or different stops on both sides.
    Stopped(x) {
        param up;
        param down;
        param stiffness;
        law stop(gap) { gap > 0 => stiffness*gap^1.5, else => 0 }
        ddot(x) + 0.08*dot(x) + x + stop(x - up) - stop(-x - down) = 0.1 + 0.5*cos(omega*t);
    }
}

crate::oscillator! {
    /// Switches of two gaps lie between those of a third one that closes.
    Several(x, y) {
        law stop(gap) { gap > 0 => 4*gap + 0.1*gap*dot(gap), else => 0 }
        law between(gap) { gap > 0 => 3*gap^1.5, else => 0 }
        law wall(gap) { gap > 0 => 5*gap^2, else => 0 }
        law ground(gap) { gap > 0 => 2*gap, else => 0 }
        ddot(x) + 0.1*dot(x) + x + (x - y) + stop(x - 0.3) + between(x - y - 0.2) = 0.3*cos(omega*t);
        ddot(y) + 0.05*dot(y) + 0.5*y - (x - y) + wall(y - 0.3) - between(x - y - 0.2)
            - ground(-y - 0.1*cos(omega*t)) = 0.1*sin(2*omega*t);
    }
}

crate::oscillator! {
    /// Stops behind each other: their gaps have their extremes in one place.
    Behind(x) {
        law first(gap) { gap > 0 => 2*gap + 0.1*gap*dot(gap), else => 0 }
        law second(gap) { gap > 0 => 3*gap^1.5, else => 0 }
        law third(gap) { gap > 0 => 5*gap^2, else => 0 }
        ddot(x) + 0.1*dot(x) + x + first(x - 0.4) + second(x - 0.43) + third(x - 0.45)
            = 0.3*cos(omega*t) + 0.1*sin(2*omega*t);
    }
}

/// A model with a range of frequencies.
fn drawn(random: &mut Random) -> (Box<dyn System>, [f64; 2]) {
    let mut between = |low, high| random.between(low, high);
    match between(0.0, 3.0) as usize {
        0 => {
            let model = OneSided {
                alpha: between(1.0, 3.0),
                load: between(0.8, 1.5),
                drive: between(0.05, 0.3),
            };
            (Box::new(model), [0.7, 1.8])
        }
        1 => (
            Box::new(TwoMasses {
                gap: between(0.1, 0.6),
            }),
            [0.7, 2.2],
        ),
        _ => {
            let model = Stopped {
                up: between(0.3, 1.2),
                down: between(0.3, 1.2),
                stiffness: between(1.0, 8.0),
            };
            (Box::new(model), [0.5, 2.0])
        }
    }
}

fn touches(branch: &Branch) -> Vec<&Event> {
    let is_touch = |event: &&Event| matches!(event.kind, EventKind::Grazing { .. });
    branch.events.iter().filter(is_touch).collect()
}

/// Each is where shooting has it, and the branch goes on to where that of shooting ends. `HERTZIAN_GRAZINGS` of them.
#[test]
fn touches_of_random_models_are_those_of_shooting() {
    let asked = std::env::var("HERTZIAN_GRAZINGS").ok();
    let asked = asked.and_then(|count| count.parse().ok()).unwrap_or(12);
    let mut random = Random::seeded(21);
    let (mut seen, mut wrong) = (0, Vec::new());
    for model in 0.. {
        if seen >= asked {
            break;
        }
        let (system, [from, to]) = drawn(&mut random);
        let request = FrequencyResponse::of(&*system).from(from).to(to);
        let branch = request.clone().by(ContactEquation::new()).run().unwrap();
        let exact = request.by(Shooting::new().tolerance(1e-12)).run().unwrap();
        let (found, known) = (touches(&branch), touches(&exact));
        let apart = |(a, b): (&&Event, &&Event)| (a.point.value - b.point.value).abs();
        let apart = found.iter().zip(&known).map(apart).fold(0.0, f64::max);
        let alike = (branch.stopped, found.len()) == (exact.stopped, known.len());
        if !alike || apart > 1e-9 {
            wrong.push(format!(
                "model {model}: {apart:e}, {} {}",
                branch.stopped, exact.stopped
            ));
        }
        seen += known.len();
    }
    println!("{seen} touches");
    assert_eq!(wrong, [""; 0]);
}

/// While a gap closes, switches of others leave the way between its own, and pass each other elsewhere.
#[test]
fn touches_among_switches_of_other_gaps() {
    for [from, to] in [[0.6, 2.2], [2.2, 1.2]] {
        events_agree(&FrequencyResponse::of(&Several {}).from(from).to(to));
    }
}

/// Three gaps touch one after the other at one phase.
#[test]
fn touches_in_one_place() {
    events_agree(&FrequencyResponse::of(&Behind {}).from(0.5).to(0.59));
}

crate::oscillator! {
    /// Five masses in a row, of which the first hits a Hertz stop and the last is driven.
    Row(q[5]) {
        law stop(gap) { gap > 0 => 200*gap^1.5, else => 0 }
        ddot(q[0]) + 0.03*(dot(q[0]) - dot(q[1])) + q[0] - q[1] + stop(q[0] - 1) = 0;
        for i in 1..4 {
            ddot(q[i]) + 0.03*(2*dot(q[i]) - dot(q[i-1]) - dot(q[i+1])) + 2*q[i] - q[i-1] - q[i+1] = 0;
        }
        ddot(q[4]) + 0.03*(2*dot(q[4]) - dot(q[3])) + 2*q[4] - q[3] = 0.1*cos(omega*t);
    }
}

/// With many modes a gap has several extremes near each other close to its level: the branch goes through every touch, as by shooting.
#[test]
fn gaps_that_tremble_are_followed_through_their_touches() {
    for [from, to] in [[0.26, 0.29], [0.29, 0.26]] {
        super::events_agree(&FrequencyResponse::of(&Row {}).from(from).to(to));
    }
}

crate::oscillator! {
    /// Four masses in a row, of which the first two hit stops and the last is driven.
    TwoStops(q[4]) {
        law stop(gap) { gap > 0 => 100*gap, else => 0 }
        ddot(q[0]) + 0.03*(dot(q[0]) - dot(q[1])) + q[0] - q[1] + stop(q[0] - 1) = 0;
        ddot(q[1]) + 0.03*(2*dot(q[1]) - dot(q[0]) - dot(q[2])) + 2*q[1] - q[0] - q[2] + stop(q[1] - 1) = 0;
        ddot(q[2]) + 0.03*(2*dot(q[2]) - dot(q[1]) - dot(q[3])) + 2*q[2] - q[1] - q[3] = 0;
        ddot(q[3]) + 0.03*(2*dot(q[3]) - dot(q[2])) + 2*q[3] - q[2] = 0.1*cos(omega*t);
    }
}

/// Between the two points around a doubling switches of both stops pass each other. Its place is that of matrix exponentials between roots of
/// `brentq`, with the secant method for the multiplier (scipy 1.17): 0.42096798671794.
#[test]
fn an_event_beside_a_change_of_order_is_found() {
    for [from, to] in [[0.15, 0.8], [0.8, 0.15]] {
        let request = FrequencyResponse::of(&TwoStops {}).from(from).to(to);
        let branch = request.by(ContactEquation::new()).run().unwrap();
        let doublings = branch.events.iter();
        let doublings = doublings.filter(|event| event.kind == EventKind::PeriodDoubling);
        let apart = doublings.map(|event| (event.point.value - 0.420_967_986_717_9).abs());
        let apart: Vec<f64> = apart.collect();
        assert_eq!(apart.len(), 4);
        let nearest = apart.into_iter().fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-12, "{from} {nearest:e}");
        assert_eq!(branch.turns, []);
    }
}

crate::oscillator! {
    /// Stops on both sides of two masses.
    Between(x, y) {
        param stiffness;
        law stop(gap) { gap > 0 => stiffness*gap^1.5 + 0.36*gap*dot(gap), else => 0 }
        ddot(x) + 0.1*dot(x) + 0.5*x + 1.25*(x - y) + stop(x - 0.33) - stop(-x - 0.33) = 0.61*cos(omega*t);
        ddot(y) + 0.1*dot(y) + 0.88*y - 1.25*(x - y) + stop(y - 0.33) - stop(-y - 0.33) = 0;
    }
}

crate::oscillator! {
    /// Stops of three masses in a row, the last one on the other side.
    Three(x, y, z) {
        param stiffness;
        law stop(gap) { gap > 0 => stiffness*gap + 0.16*gap*dot(gap), else => 0 }
        ddot(x) + 0.1*dot(x) + 0.5*x + 0.515*(x - y) + stop(x - 0.397) = 0.59*cos(omega*t);
        ddot(y) + 0.1*dot(y) + 0.4*y - 0.515*(x - y) + 0.515*(y - z) + stop(y - 0.397) = 0;
        ddot(z) + 0.1*dot(z) + 0.4*z - 0.515*(y - z) - stop(-z - 0.397) = 0;
    }
}

/// Where switches of two stops pass each other within a step that a branch turns in, its fold has equations with them in their order: as by
/// shooting, and nothing is left that could not be located.
#[test]
fn a_fold_beside_a_change_of_order_is_found() {
    let models: [(&dyn System, [f64; 2]); 7] = [
        (&Between { stiffness: 15.1 }, [0.77, 0.46]),
        (&Between { stiffness: 15.1 }, [0.46, 0.77]),
        (&Between { stiffness: 14.0 }, [0.77, 0.46]),
        (&Between { stiffness: 14.0 }, [0.46, 0.77]),
        (&Three { stiffness: 19.0 }, [1.15, 0.763]),
        (&Three { stiffness: 18.0 }, [1.15, 0.763]),
        (&Three { stiffness: 18.0 }, [0.763, 1.15]),
    ];
    for (model, [from, to]) in models {
        events_agree(&FrequencyResponse::of(model).from(from).to(to));
    }
}

crate::oscillator! {
    /// The same with other springs, driven harder.
    Harder(x, y, z) {
        param stiffness;
        law stop(gap) { gap > 0 => stiffness*gap + 0.1972*gap*dot(gap), else => 0 }
        ddot(x) + 0.1*dot(x) + 0.5*x + 0.7934*(x - y) + stop(x - 0.2892) = 0.6887*cos(omega*t);
        ddot(y) + 0.1*dot(y) + 0.3639*y - 0.7934*(x - y) + 0.7934*(y - z) + stop(y - 0.2892) = 0;
        ddot(z) + 0.1*dot(z) + 0.3639*z - 0.7934*(y - z) - stop(-z - 0.2892) = 0;
    }
}

/// A pair of multipliers leaves the circle, one of both comes back at minus one 6e-6 later, in a step of 3e-3: what multipliers count to at its
/// ends and at the doubling tells that there is more, and the step is divided until it is found.
#[test]
fn a_torus_beside_a_doubling_is_found() {
    let model = Harder { stiffness: 12.7764 };
    events_agree(&FrequencyResponse::of(&model).from(0.7795).to(1.4889));
}

crate::oscillator! {
    /// Two masses that hardly touch their stops.
    Light(x, y) {
        param stiffness;
        law stop(gap) { gap > 0 => stiffness*gap^1.5 + 0.3468*gap*dot(gap), else => 0 }
        ddot(x) + 0.1*dot(x) + 0.5*x + 1.8853*(x - y) + stop(x - 0.0937) - stop(-x - 0.0937) = 0.5257*cos(omega*t);
        ddot(y) + 0.1*dot(y) + 0.4243*y - 1.8853*(x - y) + stop(y - 0.0937) - stop(-y - 0.0937) = 0;
    }
}

/// Where the last stretch in contact vanishes a tangent in other unknowns is a difference across the touch: the walk goes on all the same.
#[test]
fn a_walk_goes_on_where_the_last_stretch_vanishes() {
    for stiffness in [1.2, 1.3659, 1.5] {
        let model = Light { stiffness };
        for [from, to] in [[0.68, 1.478], [1.478, 0.68]] {
            events_agree(&FrequencyResponse::of(&model).from(from).to(to));
        }
    }
}

crate::oscillator! {
    /// Two coordinates on a contact that turns with two fifths of the frequency.
    Turning(x, y) {
        let turn = 2/5*omega*t;
        law stop(gap) { gap > 0 => 85335*gap^1.5*(1 + 21.75*dot(gap)), else => 0 }
        2040*ddot(x) + 606*dot(x) + 10610*(x - y) + 79*(dot(x) - dot(y)) + cos(turn)*stop(x*cos(turn) + y*sin(turn) + 0.00076) = 0;
        4242*ddot(y) + 87*dot(y) + 8787*y + 10610*(y - x) + 79*(dot(y) - dot(x)) + sin(turn)*stop(x*cos(turn) + y*sin(turn) + 0.00076)
            = 3.258*cos(omega*t) - 36;
    }
}

/// While a contact comes to be closed through, the two extremes between which it opened touch one after the other, in a small part of a step. They are far
/// nearer to each other than samples of a motion.
#[test]
fn touches_that_are_near_to_each_other_are_told_apart() {
    let system = Turning {};
    let request = |from, to| FrequencyResponse::of(&system).from(from).to(to);
    let near = |branch: Branch| {
        assert_eq!(branch.turns, []);
        let values = touches(&branch).into_iter().map(|event| event.point.value);
        let mut values: Vec<f64> = values.filter(|x| (1.5..1.51).contains(x)).collect();
        values.sort_by(f64::total_cmp);
        values
    };
    let moved = |from, to| {
        let shooting = Shooting::new().tolerance(1e-12);
        near(request(from, to).by(shooting).run().unwrap())
    };
    let solved = |from, to| near(request(from, to).by(ContactEquation::new()).run().unwrap());
    let exact = moved(1.505, 1.507);
    let [a, b] = exact[..] else {
        panic!("{exact:?}");
    };
    assert!(b - a < 2e-5, "{exact:?}");
    let found = [moved(1.507, 1.505), solved(1.44, 2.56), solved(2.56, 1.44)];
    for touches in found {
        assert_eq!(touches.len(), 2, "{touches:?}");
        assert!(
            (touches[0] - a).abs().max((touches[1] - b).abs()) < 1e-10,
            "{touches:?} {exact:?}"
        );
    }
}

crate::oscillator! {
    /// Three masses, one of them between two flanks that move, two joined by a spring of three lines.
    Flanks(x, y, z) {
        law flank(gap) {
            gap > 0.9038030656617028 => 12.350517943356545*(gap - 0.9038030656617028)^1.5,
            -0.9038030656617028 <= gap <= 0.9038030656617028 => 0,
            gap < -0.9038030656617028 => -(3.1748465488184947*((-gap - 0.9038030656617028)^3.1211295498719087))
        }
        law spring(gap) {
            gap > 0.8271100136934411 => 7.575097653870356*0.8271100136934411 + 6.707848251597633*(gap - 0.8271100136934411),
            0 <= gap <= 0.8271100136934411 => 7.575097653870356*gap,
            gap < 0 => 1.7045894800376322*gap
        }
        2.209338173721469*ddot(x) + 0.23891101919135743*dot(x) + 1.0085651539798755*x + 1.2097704435785714*(x - y)
            + 0.04988341044687202*(dot(x) - dot(y)) + spring(x - y) = 0.3222036702815316*cos(omega*t);
        0.6344573272564455*ddot(y) + 0.08481334429194187*dot(y) + 1.2097704435785714*(y - x) + 0.04988341044687202*(dot(y) - dot(x))
            + 1.4730185158336617*(y - z) + 0.03139801812746711*(dot(y) - dot(z))
            + flank(y + 0.446673305975302 - 0.43776925754225643*sin(1/2*omega*t)) - spring(x - y) = 0;
        ddot(z) + 0.06217188410761927*dot(z) + 1.639711172172471*z + 1.4730185158336617*(z - y) + 0.03139801812746711*(dot(z) - dot(y)) = 0;
    }
}

/// Both touches are there both ways, and nothing else: no multiplier is near one, and branches cross nowhere.
#[test]
fn no_branch_point_is_invented_beside_touches() {
    let (low, high) = (0.358_763_381_522_035_6, 0.521_843_903_118_525_9);
    for [from, to] in [[low, high], [high, low]] {
        let request = FrequencyResponse::of(&Flanks {}).from(from).to(to);
        let branch = request.by(ContactEquation::new()).run().unwrap();
        let found = touches(&branch);
        assert_eq!(found.len(), branch.events.len(), "{:?}", branch.events);
        assert_eq!(found.len(), 2);
    }
}
