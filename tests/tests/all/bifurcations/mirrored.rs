//! Odd symmetry of two contacts that are images of each other: the springs of `symmetry`, and a mass between two stops, written with
//! one law of one gap and with two contacts.

use hertzian::{Branch, EventKind, FrequencyResponse, HarmonicBalance, Shooting, System};

use crate::bifurcations::symmetry::{HARDENING, Hardening};

hertzian::oscillator! {
    /// One law on both sides of a gap.
    OneGap(x) {
        param drive;
        param distance >= 0;
        law stops(gap) {
            gap > distance  => 0.2*dot(gap) + 3*(gap - distance)^1.5,
            gap < -distance => 0.2*dot(gap) - 3*(-distance - gap)^1.5,
            else            => 0,
        }
        ddot(x) + 0.04*dot(x) + 0.5*x + stops(x) = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// The same with two contacts of one law, whose gaps are mirrored.
    TwoGaps(x) {
        param drive;
        param left;
        param right;
        param weaker;
        param load;
        law stop(gap) { gap > 0 => 0.2*dot(gap) + 3*gap^1.5, else => 0 }
        ddot(x) + 0.04*dot(x) + 0.5*x + stop(x - right) - weaker*stop(-x - left) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// The same with two laws, which are mirrored.
    TwoLaws(x) {
        param drive;
        param distance >= 0;
        param stiffness;
        param damping;
        law above(gap) { gap > distance => 0.2*dot(gap) + 3*(gap - distance)^1.5, else => 0 }
        law below(gap) { gap < -distance => damping*dot(gap) - stiffness*(-distance - gap)^1.5, else => 0 }
        ddot(x) + 0.04*dot(x) + 0.5*x + above(x) + below(x) = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// Stops that move together with the excitation, and apart from each other at three times its frequency.
    Moving(x) {
        param together;
        param apart;
        law stop(gap) { gap > 0 => 0.2*dot(gap) + 3*gap^1.5, else => 0 }
        let shift = together*cos(omega*t);
        let breath = apart*cos(3*omega*t);
        ddot(x) + 0.04*dot(x) + 0.5*x + stop(x - 0.3 - shift - breath) - stop(-x - 0.3 + shift - breath) = 0;
    }
}

hertzian::oscillator! {
    /// Figure 2a with two contacts.
    HardeningPair(x) {
        param zeta >= 0;
        param drive;
        law half(gap) { gap > 0 => gap^1.5, else => 0 }
        ddot(x) + 2*zeta*dot(x) + half(x) - half(-x) = drive*cos(omega*t);
    }
}

const DRIVE: f64 = 0.3;

const PAIR: TwoGaps = TwoGaps {
    drive: DRIVE,
    left: 0.3,
    right: 0.3,
    weaker: 1.0,
    load: 0.0,
};

const LAWS: TwoLaws = TwoLaws {
    drive: DRIVE,
    distance: 0.3,
    stiffness: 3.0,
    damping: 0.2,
};

fn branch(system: &dyn System) -> Branch {
    let request = FrequencyResponse::of(system).harmonics(21).from(0.8);
    request.to(1.6).run().unwrap()
}

/// Mean and even harmonics are no unknowns of symmetric orbits, and so exactly zero.
fn is_symmetric(branch: &Branch) -> bool {
    branch.points.iter().all(|point| {
        let series = point.orbit.series(0).unwrap();
        let mut even = (0..series.len()).filter(|i| i.div_ceil(2).is_multiple_of(2));
        even.all(|i| series[i] == 0.0)
    })
}

#[test]
fn mirrored_contacts_are_as_good_as_one_odd_law() {
    let one = OneGap {
        drive: DRIVE,
        distance: 0.3,
    };
    let expected = branch(&one);
    assert!(is_symmetric(&expected));
    let systems: [&dyn System; 2] = [&PAIR, &LAWS];
    for system in systems {
        let found = branch(system);
        assert!(is_symmetric(&found));
        assert_eq!(found.points.len(), expected.points.len());
        for (a, b) in found.points.iter().zip(&expected.points) {
            assert!((a.value - b.value).abs() < 1e-12, "{} {}", a.value, b.value);
            for (x, y) in a
                .orbit
                .series(0)
                .unwrap()
                .iter()
                .zip(b.orbit.series(0).unwrap())
            {
                assert!(
                    (x - y).abs() < 1e-12 * b.peak_to_peak(),
                    "{} {x} {y}",
                    a.value
                );
            }
        }
        let shooting = FrequencyResponse::of(system)
            .by(Shooting::new())
            .from(0.8)
            .to(0.9)
            .run()
            .unwrap();
        assert!(shooting.points.iter().all(|cycle| cycle.orbit.symmetric));
    }
}

#[test]
fn unequal_contacts_have_no_symmetry() {
    let unequal: [&dyn System; 7] = [
        &TwoGaps {
            weaker: 1.000_001,
            ..PAIR
        },
        &TwoGaps {
            left: 0.300_000_1,
            ..PAIR
        },
        &TwoGaps { load: 1e-9, ..PAIR },
        &TwoGaps {
            weaker: 0.0,
            ..PAIR
        },
        &TwoGaps {
            weaker: -1.0,
            ..PAIR
        },
        &TwoLaws {
            stiffness: 3.000_001,
            ..LAWS
        },
        &TwoLaws {
            damping: 0.200_000_1,
            ..LAWS
        },
    ];
    for (index, system) in unequal.into_iter().enumerate() {
        assert!(!is_symmetric(&branch(system)), "{index}");
        let shooting = FrequencyResponse::of(system)
            .by(Shooting::new())
            .from(0.8)
            .to(0.81)
            .run()
            .unwrap();
        assert!(
            shooting.points.iter().all(|cycle| !cycle.orbit.symmetric),
            "{index}"
        );
    }
}

/// What is varied may be equal on both sides at one value only.
#[test]
fn a_symmetry_at_one_value_is_none_of_a_branch() {
    let request = FrequencyResponse::of(&PAIR).harmonics(21).omega(1.0);
    let by_drive = request.clone().vary("drive").from(0.3).to(0.5).run();
    assert!(is_symmetric(&by_drive.unwrap()));
    let by_stiffness = request.vary("weaker").from(1.0).to(1.2).run();
    assert!(!is_symmetric(&by_stiffness.unwrap()));
}

/// Two stops that move together change places half a period later; two that move apart do not.
#[test]
fn moving_contacts_have_it_where_they_change_places() {
    let moving = |together, apart| {
        let model = Moving { together, apart };
        let request = FrequencyResponse::of(&model).harmonics(21).from(0.8);
        is_symmetric(&request.to(1.0).run().unwrap())
    };
    assert!(moving(0.4, 0.0));
    assert!(!moving(0.4, 0.05));
}

/// Figure 2a: where the symmetry breaks, exact values as in `symmetry`.
#[test]
fn the_symmetry_of_two_contacts_breaks_where_it_should() {
    let (zeta, drive) = (0.01, 0.1);
    let pair = HardeningPair { zeta, drive };
    let request = FrequencyResponse::of(&pair).from(0.45).to(0.3);
    let branch = request.clone().by(HarmonicBalance::new()).run().unwrap();
    let found: Vec<_> = branch.events(EventKind::SymmetryBreaking).collect();
    let one = Hardening { zeta, drive };
    let one = FrequencyResponse::of(&one)
        .by(HarmonicBalance::new())
        .from(0.45)
        .to(0.3)
        .run()
        .unwrap();
    let expected: Vec<_> = one.events(EventKind::SymmetryBreaking).collect();
    assert_eq!((found.len(), expected.len()), (2, 2));
    for ((event, same), exact) in found.iter().zip(&expected).zip(HARDENING) {
        let error = (event.point.value - exact).abs();
        assert!(error < 1e-6 && error <= event.error, "{event} {error:.1e}");
        let apart = (event.point.value - same.point.value).abs();
        assert!(apart < 1e-11, "{event} {same}");
    }
    let shooting = request.clone().by(Shooting::new()).run().unwrap();
    for branch in [shooting, request.run().unwrap()] {
        let breaks: Vec<_> = branch.events(EventKind::SymmetryBreaking).collect();
        assert_eq!(breaks.len(), 2);
        for (event, exact) in breaks.iter().zip(HARDENING) {
            let error = (event.point.value - exact).abs();
            assert!(error < 1e-9 && error <= event.error, "{event} {error:.1e}");
        }
    }
}
