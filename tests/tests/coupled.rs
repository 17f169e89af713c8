//! Several coordinates and several contacts: two masses with an elastic stop, and a rotor among eight rolling elements.

use hertzian::{Branch, FrequencyResponse, Stop, Verdict};

hertzian::oscillator! {
    /// Two masses in a row, the second held to the ground, the first with an elastic stop at distance one.
    /// Stiffness and clearance as in example 03 of NLvib (Krack and Gross 2019); damping is 0.03 of the stiffness matrix.
    TwoMasses(x1, x2) {
        param stop > 0;
        param drive;
        law stop_spring(gap) { gap > 1 => stop*(gap - 1), else => 0 }
        ddot(x1) + 0.03*(dot(x1) - dot(x2)) + x1 - x2 + stop_spring(x1) = 0;
        ddot(x2) + 0.03*(2*dot(x2) - dot(x1)) + 2*x2 - x1 = drive*cos(omega*t);
    }
}

/// Values of omega between which the verdict changes between stable and unstable; undecided points are passed over.
fn changes(branch: &Branch<'_>) -> Vec<[f64; 2]> {
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
        let (input, dissipated) = (point.observed.input_power, point.observed.dissipated_power);
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
