//! Stated errors of what harmonics that were left out do, where they do more than a first step of the correction tells.

use hertzian::{Branch, FrequencyResponse, Point, Shooting};

hertzian::oscillator! {
    /// A mass that is held by a contact alone, 700 times as stiff as what drives it is fast.
    Held(x) {
        law hold(gap) { 700*gap*exp(-(gap/0.00137)^2) }
        2.27*ddot(x) + 0.024*dot(x) + 0.93*x + hold(x) = 0.317*cos(omega*t);
    }
}

/// The stiffness of a contact is that of a mode among the harmonics left out: at 0.65, of the 27th. Its amplitude in the first
/// step of the correction, which knows the linear stiffness alone, is smaller by far.
#[test]
fn a_mode_by_a_contact_among_the_harmonics_left_out_is_in_the_stated_error() {
    let model = Held {};
    let branch = |harmonics| {
        let request = FrequencyResponse::of(&model).from(0.72).to(0.56);
        request.harmonics(harmonics).run().unwrap()
    };
    let (few, many) = (branch(20), branch(90));
    let mut largest = 0.0_f64;
    for step in 0..40 {
        let omega = 0.57 + 0.0035 * f64::from(step);
        let [few, many] = [&few, &many].map(|branch| branch.at(omega).unwrap().remove(0));
        let error = (few.peak_to_peak() / many.peak_to_peak() - 1.0).abs();
        let stated = few.error.unwrap() + many.error.unwrap();
        assert!(error <= stated, "{omega}: {error:e} {stated:e}");
        largest = largest.max(error);
    }
    assert!(largest > 1e-7, "{largest:e}");
}

hertzian::oscillator! {
    /// An oscillator that meets a stop of its own stiffness.
    Stop(x) {
        law stop(gap) { gap > 0 => gap, else => 0 }
        ddot(x) + 0.03*dot(x) + x + stop(x - 0.3) = 0.1*cos(omega*t);
    }
}

/// Beside a fold multipliers change as the root of the distance from it, and few harmonics put the fold where it is to its error only. By
/// shooting they are exact.
#[test]
fn multipliers_beside_a_fold_are_within_their_error() {
    let request = FrequencyResponse::of(&Stop {}).from(0.9).to(1.6);
    let exact = request.clone().by(Shooting::new()).run().unwrap();
    assert_eq!(exact.folds().count(), 2);
    let mut looked = 0;
    for harmonics in [5, 8, 12] {
        let few = request.clone().harmonics(harmonics).run().unwrap();
        for (fold, exact_fold) in few.folds().zip(exact.folds()) {
            for times in [-100.0, -30.0, -10.0, -3.0, 3.0, 10.0, 30.0, 100.0] {
                let value = exact_fold.point.value + times * fold.error;
                let of = |branch: &Branch| branch.at(value).unwrap();
                let (few, exact) = (of(&few), exact.at(value).unwrap());
                for point in few.iter().filter(|_| few.len() == exact.len()) {
                    let apart =
                        |other: &&Point| (other.peak_to_peak() - point.peak_to_peak()).abs();
                    let nearest = exact
                        .iter()
                        .min_by(|a, b| apart(a).total_cmp(&apart(b)))
                        .unwrap();
                    let [one, other] = [point, nearest].map(|point| &point.stability);
                    let error = hertzian_tests::distance(&one.multipliers, &other.multipliers);
                    let stated = one.error + other.error;
                    assert!(
                        error <= stated,
                        "{harmonics}, {times} of {fold}: {error:.1e} {stated:.1e}"
                    );
                    looked += 1;
                }
            }
        }
    }
    assert!(looked >= 50, "{looked}");
}
