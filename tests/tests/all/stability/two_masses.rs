//! Where two masses with an elastic stop lose stability, by verdicts, and every method there.

use hertzian::stability::Method;
use hertzian::{Branch, FrequencyResponse, Point, Shooting, Verdict};
use hertzian_tests::{TwoMasses, distance, nearest};

const MODEL: TwoMasses = TwoMasses {
    stop: 100.0,
    drive: 0.1,
};

/// The Neimark-Sacker bifurcation and the period doubling, from an independent computation to five digits.
const BIFURCATIONS: [f64; 2] = [0.61861, 0.73878];

/// The orbit at a frequency whose size is nearest to a given one.
fn at(branch: &Branch, omega: f64, size: f64) -> Point {
    nearest(branch.at(omega).unwrap(), size, Point::peak_to_peak).unwrap()
}

/// Between two neighbours of the branch whose verdicts differ: up to where the first is said, and from where on the second, by
/// bisection.
fn change(branch: &Branch, [a, b]: [&Point; 2]) -> [f64; 2] {
    let size = 0.5 * (a.peak_to_peak() + b.peak_to_peak());
    let limit = |mut inside: f64, mut outside: f64, wanted: Verdict| {
        while (outside - inside).abs() > 1e-5 {
            let middle = 0.5 * (inside + outside);
            if at(branch, middle, size).stability.verdict == wanted {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        inside
    };
    let first = limit(a.value, b.value, a.stability.verdict);
    [first, limit(b.value, first, b.stability.verdict)]
}

/// At defaults, which here are 150 harmonics, verdicts are undecided for less than 1e-3 of the frequency. That takes minutes, so
/// that without `HERTZIAN_TWO_MASSES` it is done with 60 harmonics, and to 5e-3.
#[test]
fn verdicts_change_at_the_bifurcations() {
    let request = FrequencyResponse::of(&MODEL).from(0.6).to(0.76);
    let (request, width) = if std::env::var_os("HERTZIAN_TWO_MASSES").is_some() {
        (request, 1e-3)
    } else {
        (request.harmonics(60), 5e-3)
    };
    let branch = request.run().unwrap();
    let decided = |point: &&Point| point.stability.verdict != Verdict::Undecided;
    let points: Vec<_> = branch.points.iter().filter(decided).collect();
    let mut found = [0; 2];
    for pair in points.windows(2) {
        let [before, behind] = [pair[0], pair[1]];
        let between = |omega: &f64| (before.value - omega) * (behind.value - omega) < 0.0;
        let changes = before.stability.verdict != behind.stability.verdict;
        let Some(index) = BIFURCATIONS.iter().position(between).filter(|_| changes) else {
            continue;
        };
        let [a, b] = change(&branch, [before, behind]);
        let verdicts = [before, behind].map(|point| point.stability.verdict);
        println!("{} until {a:.6}, {} from {b:.6}", verdicts[0], verdicts[1]);
        // The value is known to half a unit of its last digit.
        let omega = BIFURCATIONS[index];
        assert!(a.min(b) - 5e-6 < omega && omega < a.max(b) + 5e-6);
        assert!((b - a).abs() < width, "{a} {b}");
        found[index] += 1;
    }
    assert_eq!(found, [1, 1]);
}

/// With 30 harmonics, beside both bifurcations: no method states less than a third of its error, and none of the verdicts is wrong.
#[test]
fn every_method_beside_the_bifurcations() {
    let request = FrequencyResponse::of(&MODEL).from(0.6).to(0.76);
    let branch = request.harmonics(30).stability(false).run().unwrap();
    for omega in BIFURCATIONS
        .map(|omega| [omega - 2e-3, omega + 2e-3])
        .concat()
    {
        let orbits = branch.at(omega).unwrap().into_iter();
        for point in orbits.filter(|point| point.observed.contacts[0].fraction > 0.0) {
            let shooting = FrequencyResponse::of(&MODEL)
                .by(Shooting::new())
                .near_orbit(&point.orbit);
            let Ok(cycle) = shooting.orbit(omega) else {
                continue;
            };
            let exact = &cycle.stability;
            println!(
                "omega {omega:.5}, exactly {:.6} {}",
                exact.multipliers[0].norm(),
                exact.verdict
            );
            for method in [
                Method::Default,
                Method::Monodromy,
                Method::HillImaginaryPart,
                Method::HillWeightedMean,
                Method::Hill,
                Method::KoopmanHill,
                Method::KoopmanHillSubharmonic,
            ] {
                let answer = branch.multipliers(&point, method).unwrap();
                let [plain, given] = [&answer.uncorrected, &answer.stability.multipliers]
                    .map(|found| distance(found, &exact.multipliers));
                let (estimate, verdict) = (answer.stability.error, answer.stability.verdict);
                println!(
                    "    {method}: {plain:.1e}, corrected {given:.1e}, estimate {estimate:.1e}, {verdict}"
                );
                if method == Method::Default || method == Method::Monodromy {
                    assert!(given < 3.0 * estimate, "{given:e} {estimate:e}");
                    assert!(verdict == Verdict::Undecided || verdict == exact.verdict);
                }
            }
        }
    }
}
