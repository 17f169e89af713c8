//! Koopman-Hill projection at a stiff stop.

use hertzian::stability::Method;
use hertzian::{FrequencyResponse, Shooting, Verdict};
use hertzian_tests::TwoMasses;

use super::models::distance;

/// A stop a hundred times as stiff as the springs, 20 harmonics: entries of the Hill matrix fall slowly, and its exponential
/// magnifies what is missing. The bound of Bayer and Leine (2025) needs coefficients that fall exponentially; there is none.
#[test]
fn projection_at_a_stiff_stop() {
    let model = TwoMasses {
        stop: 100.0,
        drive: 0.1,
    };
    let request = FrequencyResponse::of(&model).from(0.6).to(0.75);
    let coarse = request.clone().harmonics(20).run().unwrap();
    let default = request.run().unwrap();
    println!("omega, projection with 20 harmonics, default with 20, default, its estimate");
    let mut worst = 0.0_f64;
    for omega in [0.63, 0.65, 0.67, 0.7] {
        for point in default.at(omega).unwrap() {
            let shooting = FrequencyResponse::of(&model)
                .by(Shooting::new())
                .near_orbit(&point.orbit);
            let exact = shooting.orbit(omega).unwrap().stability;
            let error = distance(&point.stability.multipliers, &exact.multipliers);
            let estimate = point.stability.error;
            assert!(error < 3.0 * estimate, "{error:e} {estimate:e}");
            let verdict = point.stability.verdict;
            assert!(verdict == Verdict::Undecided || verdict == exact.verdict);
            let alike = coarse.at(omega).unwrap();
            let nearest = alike.into_iter().min_by(|a, b| {
                let far = |p: &hertzian::Point| (p.peak_to_peak() - point.peak_to_peak()).abs();
                far(a).total_cmp(&far(b))
            });
            let Some(alike) = nearest else { continue };
            let method = Method::KoopmanHill;
            let projected = coarse.multipliers(&alike, method).unwrap();
            let by_projection = distance(&projected.uncorrected, &exact.multipliers);
            assert!(projected.bound.is_none());
            println!(
                "{omega}, {by_projection:.1e}, {}, {error:.1e}, {estimate:.1e} {verdict}",
                alike.stability.verdict
            );
            worst = worst.max(by_projection);
            let verdicts = [alike.stability.verdict, exact.verdict];
            assert!(verdicts[0] == Verdict::Undecided || verdicts[0] == verdicts[1]);
        }
    }
    assert!(worst > 1.0, "{worst}");
}
