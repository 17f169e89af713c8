//! Corners of a branch: touches of levels at which the force jumps.

use hertzian::{Branch, Event, EventKind, FrequencyResponse, Shooting, Stop, System};

hertzian::oscillator! {
    /// A Hertzian contact with adhesion.
    Adhesive(x) {
        law contact(gap) { gap > 0 => gap^1.5 - 0.3, else => 0 }
        ddot(x) + 0.04*dot(x) + 0.05*x + contact(x) = 1 + 0.2*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// A linear contact with adhesion.
    Sticky(x) {
        law contact(gap) { gap > 0 => 2*gap - 0.3, else => 0 }
        ddot(x) + 0.1*dot(x) + 0.6*x + contact(x) = 1 + 0.15*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// A spring between two stops whose forces begin with a jump.
    BetweenStops(x) {
        law stops(gap) {
            gap > 0.5 => 2*(gap - 0.5) + 0.1,
            gap < -0.5 => 2*(gap + 0.5) - 0.1,
            else => 0,
        }
        ddot(x) + 0.08*dot(x) + x + stops(x) = 0.15*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// A spring beside an attracting wall.
    Attracted(x) {
        law wall(gap) { gap > 0 => 5*gap - 0.3, else => 0 }
        ddot(x) + 0.06*dot(x) + x + wall(x - 0.4) = 0.2*cos(omega*t);
    }
}

fn touches(branch: &Branch) -> Vec<&Event> {
    let grazing = |event: &&Event| matches!(event.kind, EventKind::Grazing { .. });
    branch.events.iter().filter(grazing).collect()
}

/// Both ways, by both methods: the branch goes on behind its corners, and each is one event where it is expected.
fn assert_passes(system: &dyn System, [low, high]: [f64; 2], expected: [f64; 2]) {
    for [from, to] in [[low, high], [high, low]] {
        let request = FrequencyResponse::of(system).from(from).to(to);
        let shooting = request.clone().by(Shooting::new());
        let branches = [(request.run(), 1e-5), (shooting.run(), 1e-9)];
        for (branch, least) in branches {
            let branch = branch.unwrap();
            assert_eq!(branch.stopped, Stop::ReachedEnd);
            assert!(branch.turns.is_empty(), "{:?}", branch.turns);
            let mut found = touches(&branch);
            found.sort_by(|a, b| a.point.value.total_cmp(&b.point.value));
            assert_eq!(found.len(), 2, "{:?}", branch.events);
            for (event, expected) in found.iter().zip(expected) {
                let error = (event.point.value - expected).abs();
                assert!(error <= event.error, "{event}: {error:.1e}");
                assert!(event.error < least, "{event}");
            }
        }
    }
}

/// Where the orbit that stays in contact has its minimum at zero, by Runge and Kutta's method with 4000 steps a period and Newton's
/// method on its state and its frequency: `1.157024142096` and `1.302715120203`, the same to twelve digits with half as many steps.
#[test]
fn a_hertzian_contact_with_adhesion_is_left_and_met_again() {
    assert_passes(
        &Adhesive {},
        [0.5, 1.6],
        [1.157_024_142_096, 1.302_715_120_203],
    );
}

/// In contact the motion is linear, about `1.3 / 2.6` with the amplitude `0.15 / |2.6 - w^2 + 0.1 i w|`: it touches
/// zero where both are equal.
#[test]
fn a_linear_contact_with_adhesion_is_left_where_the_linear_motion_leaves_it() {
    assert_passes(&Sticky {}, [0.8, 2.2], linear(2.6, 0.1, 0.3));
}

/// Both stops are touched at once.
#[test]
fn two_stops_are_met_where_the_linear_motion_meets_them() {
    assert_passes(&BetweenStops {}, [0.5, 1.6], linear(1.0, 0.08, 0.3));
}

/// Where `|k - w^2 + i c w| = r`.
fn linear(k: f64, c: f64, r: f64) -> [f64; 2] {
    let middle = k - 0.5 * c * c;
    let root = (middle * middle - k * k + r * r).sqrt();
    [middle - root, middle + root].map(f64::sqrt)
}

/// Below the wall the linear motion turns with the acceleration `-0.4 w^2`, so that the attraction 0.3 wins: what passes the level is
/// pulled on. The motion meets the wall where its amplitude is 0.4, from both sides, and its branch ends there by shooting, for that reason.
#[test]
fn a_branch_ends_where_motions_are_pulled_on() {
    let [low, _] = linear(1.0, 0.06, 0.5);
    let request = FrequencyResponse::of(&Attracted {}).from(0.3).to(0.9);
    let branch = request.by(Shooting::new()).run().unwrap();
    let Stop::PulledOn { value } = branch.stopped else {
        panic!("{}", branch.stopped);
    };
    assert!((value - low).abs() < 1e-4, "{value} {low}");
}

/// Behind a touch at which the force jumps a multiplier comes from minus infinity: the period doubles close by. The value is from the motion
/// in closed form from switch to switch, and its derivatives with their jumps: the trace of the map is `-1 - exp(-0.1 T)` there.
#[test]
fn the_period_doubles_close_to_a_corner() {
    hertzian::oscillator! {
        Preloaded(x) {
            law stop(gap) { gap >= 1 => 0.05 + 5*(gap - 1), else => 0 }
            ddot(x) + 0.1*dot(x) + x + stop(x) = 0.15*cos(omega*t);
        }
    }
    for [from, to] in [[0.6, 1.0], [1.0, 0.6]] {
        let request = FrequencyResponse::of(&Preloaded {}).from(from).to(to);
        let shooting = request.by(Shooting::new()).run().unwrap();
        let [doubling] = shooting
            .events(EventKind::PeriodDoubling)
            .collect::<Vec<_>>()[..]
        else {
            panic!("{:?}", shooting.events);
        };
        let error = (doubling.point.value - 0.939_885_292_226_7).abs();
        assert!(error < 1e-11, "{doubling}: {error:.1e}");
    }
}
