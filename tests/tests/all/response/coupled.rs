//! Several coordinates and several contacts: two masses with an elastic stop, and a rotor among eight rolling elements.

use hertzian::{Branch, FrequencyResponse, Stop, Verdict};
use hertzian_tests::TwoMasses;

/// Values of omega between which the verdict changes between stable and unstable; undecided points are passed over.
fn changes(branch: &Branch) -> Vec<[f64; 2]> {
    let decided: Vec<_> = branch
        .points
        .iter()
        .filter(|point| point.stability.verdict != Verdict::Undecided)
        .collect();
    decided
        .windows(2)
        .filter(|pair| pair[0].stability.verdict != pair[1].stability.verdict)
        .map(|pair| [pair[0].omega(), pair[1].omega()])
        .collect()
}

/// The Neimark-Sacker bifurcation at omega 0.61861 and the period doubling at 0.73878, from an independent computation,
/// lie between verdicts of the branch. The stop is a hundred times stiffer than the springs, so few harmonics do not tell.
#[test]
fn two_masses_lose_stability_where_they_should() {
    let model = TwoMasses {
        stop: 100.0,
        drive: 0.1,
    };
    let branch = FrequencyResponse::of(&model)
        .from(0.5)
        .to(1.0)
        .harmonics(80)
        .samples(8192)
        .run()
        .unwrap();
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    let changes = changes(&branch);
    for omega in [0.61861, 0.73878] {
        let bracketed = changes
            .iter()
            .any(|[a, b]| *a < omega && omega < *b && b - a < 0.01);
        assert!(bracketed, "{omega}: {changes:?}");
    }
    for point in &branch.points {
        let (input, dissipated) = (
            point.observed.input_power.unwrap(),
            point.observed.dissipated_power.unwrap(),
        );
        assert!((input - dissipated).abs() < 1e-12, "{input} {dissipated}");
    }
}

/// With few harmonics the multipliers of the same orbits are wrong, and the estimate says so: no verdict is false.
#[test]
fn few_harmonics_give_no_false_verdict() {
    let model = TwoMasses {
        stop: 100.0,
        drive: 0.1,
    };
    let request = FrequencyResponse::of(&model).from(0.5).to(1.0);
    let fine = request.clone().harmonics(80).samples(8192).run().unwrap();
    let coarse = request.harmonics(20).run().unwrap();
    let mut compared = 0;
    for omega in [0.55, 0.6, 0.63, 0.7, 0.72, 0.75, 0.8] {
        let (a, b) = (coarse.at(omega).unwrap(), fine.at(omega).unwrap());
        if a.len() != b.len() {
            continue;
        }
        for (p, q) in a.iter().zip(&b) {
            let opposite = [
                (Verdict::Stable, Verdict::Unstable),
                (Verdict::Unstable, Verdict::Stable),
            ];
            let verdicts = (p.stability.verdict, q.stability.verdict);
            assert!(
                !opposite.contains(&verdicts),
                "{omega}: {:?} {:?}",
                p.stability,
                q.stability
            );
            compared += 1;
        }
    }
    assert!(compared >= 8, "{compared}");
}

hertzian::oscillator! {
    /// A rotor with unbalance on eight balls that move with the cage: contacts whose directions turn.
    Bearing(x, y) {
        param k > 0;
        param clearance;
        param eccentricity;
        param load;
        let cage = 2/5*omega*t;
        law ball(gap) { gap > 0 => k*gap^1.5, else => 0 }
        ddot(x) + 0.4*dot(x) + for j in 0..8 {
            let angle = cage + 2*pi*j/8;
            cos(angle)*ball(x*cos(angle) + y*sin(angle) - clearance)
        } = eccentricity*omega^2*cos(omega*t);
        ddot(y) + 0.4*dot(y) + for j in 0..8 {
            let angle = cage + 2*pi*j/8;
            sin(angle)*ball(x*cos(angle) + y*sin(angle) - clearance)
        } = eccentricity*omega^2*sin(omega*t) - load;
    }
}

/// `(x, y, x', y')` of the bearing after one period of an orbit, by a classical Runge-Kutta method on the equations written
/// out by hand.
fn bearing_after(model: &Bearing, omega: f64, period: f64, mut state: [f64; 4]) -> [f64; 4] {
    let field = |t: f64, s: &[f64; 4]| {
        let unbalance = model.eccentricity * omega * omega;
        let mut force = [
            unbalance * (omega * t).cos(),
            unbalance * (omega * t).sin() - model.load,
        ];
        for j in 0..8 {
            let angle = 0.4 * omega * t + std::f64::consts::TAU * f64::from(j) / 8.0;
            let gap = s[0] * angle.cos() + s[1] * angle.sin() - model.clearance;
            let push = model.k * gap.max(0.0).powf(1.5);
            force[0] -= angle.cos() * push;
            force[1] -= angle.sin() * push;
        }
        [s[2], s[3], force[0] - 0.4 * s[2], force[1] - 0.4 * s[3]]
    };
    let steps = 20_000;
    let h = period / f64::from(steps);
    let moved = |s: &[f64; 4], k: &[f64; 4], h: f64| std::array::from_fn(|i| s[i] + h * k[i]);
    for step in 0..steps {
        let t = h * f64::from(step);
        let k1 = field(t, &state);
        let k2 = field(t + 0.5 * h, &moved(&state, &k1, 0.5 * h));
        let k3 = field(t + 0.5 * h, &moved(&state, &k2, 0.5 * h));
        let k4 = field(t + h, &moved(&state, &k3, h));
        state =
            std::array::from_fn(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    state
}

/// Clearance lets every ball lose contact as it leaves the loaded zone. Orbits close when they are integrated in time, and
/// the work of the turning contacts is in the balance of power.
#[test]
fn a_rotor_on_eight_moving_contacts_traces_its_branch() {
    let model = Bearing {
        k: 10.0,
        clearance: 0.05,
        eccentricity: 0.02,
        load: 1.0,
    };
    let branch = FrequencyResponse::of(&model)
        .from(1.0)
        .to(3.0)
        .harmonics(48)
        .samples(1024)
        .run()
        .unwrap();
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    for point in &branch.points {
        assert_eq!(point.observed.contacts.len(), 8);
        let (input, dissipated) = (
            point.observed.input_power.unwrap(),
            point.observed.dissipated_power.unwrap(),
        );
        assert!((input - dissipated).abs() < 1e-12, "{input} {dissipated}");
        for contact in &point.observed.contacts {
            assert!(
                contact.fraction > 0.0 && contact.fraction < 1.0,
                "{contact:?}"
            );
        }
    }
    for point in branch.points.iter().step_by(10) {
        let orbit = &point.orbit;
        let ((x, u), (y, v)) = (
            orbit.state_at(0, 0.0).unwrap(),
            orbit.state_at(1, 0.0).unwrap(),
        );
        let period = std::f64::consts::TAU / orbit.base;
        let after = bearing_after(&model, point.omega(), period, [x, y, u, v]);
        // The error of the orbit, carried around by the flow.
        let growth = 1.0 + point.stability.multipliers[0].norm();
        for (a, b) in after.iter().zip([x, y, u, v]) {
            assert!(
                (a - b).abs() < 1e-4 * growth,
                "{}: {after:?} {:?}",
                point.omega(),
                [x, y, u, v]
            );
        }
    }
}
