//! The methods to find the harmonics of a force agree where samples are many.

use hertzian::Aft;

use super::models::{FIGURE_2A, FIGURE_5A};

/// The continuous spring: folds of the sampled balance tend to those of the exact one.
#[test]
fn folds_of_the_sampled_methods_tend_to_the_exact_ones() {
    let folds = |aft, samples| {
        let found = FIGURE_2A.folds(|request| request.harmonics(10).aft(aft).samples(samples));
        assert_eq!(found.len(), 2);
        [found[0].point.value, found[1].point.value]
    };
    let exact = folds(Aft::Switched, 8192);
    let far = |aft, samples| {
        let sampled = folds(aft, samples);
        (sampled[0] - exact[0])
            .abs()
            .max((sampled[1] - exact[1]).abs())
    };
    for aft in [Aft::Sampled, Aft::Primitive] {
        let (few, many) = (far(aft, 1024), far(aft, 8192));
        assert!(many < 1e-7, "{aft}: {many:e}");
        assert!(many < 0.01 * few, "{aft}: {few:e} {many:e}");
    }
}

/// A force that jumps: orbits of the sampled balances tend to those of the exact one, slowly, and faster where the jump
/// has been integrated.
#[test]
fn orbits_of_the_sampled_methods_tend_to_the_exact_ones() {
    let model = FIGURE_5A.model();
    let size = |aft, samples| {
        let request = FIGURE_5A.request(&*model).from(1.02).to(1.03);
        let request = request.stability(false).harmonics(10);
        let branch = request.aft(aft).samples(samples).run().unwrap();
        branch.points[0].peak_to_peak()
    };
    let exact = size(Aft::Switched, 1024);
    // Larger than any orbit that stays in contact.
    assert!(exact > 2.2, "{exact}");
    let far = |aft, samples| (size(aft, samples) / exact - 1.0).abs();
    let [few, many] = [1024, 8192].map(|samples| {
        let far = [Aft::Sampled, Aft::Primitive].map(|aft| far(aft, samples));
        println!(
            "{samples}: sampled {:.1e}, primitive {:.1e}",
            far[0], far[1]
        );
        far
    });
    assert!(many[0] < 1e-3 && many[1] < 1e-6, "{few:?} {many:?}");
}
