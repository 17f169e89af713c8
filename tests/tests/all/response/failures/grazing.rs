//! Orbits that touch the level of a contact, and a fold that this makes.

use std::f64::consts::TAU;

use hertzian::stability::Method;
use hertzian::{Aft, Complex, FrequencyResponse, HarmonicBalance, Shooting, Verdict};

use super::models::{answer, distance, first, linear};
use super::oracle::{Switches, paper};

/// At drive `2 zeta load` the linear motion `load + sin t` just touches the level. Beyond, contact is lost for a time that grows
/// with the root of the drive's excess, and so does the change of the multipliers: steps and samples miss it at first.
#[test]
fn touching_a_level_and_just_beside() {
    let zeta = paper(0.0).zeta;
    let touch = 2.0 * zeta;
    let linear_motion = Complex::new(-zeta * TAU, TAU * (1.0 - zeta * zeta).sqrt()).exp();
    println!(
        "excess, change of the trace, error of 1024 steps, of Hill from 1024 samples, default, its estimate"
    );
    let mut changes = Vec::new();
    for excess in [0.0, 1e-6, 1e-4, 1e-2] {
        let drive = touch * (1.0 + excess);
        let model = linear(drive);
        let request = FrequencyResponse::of(&model).by(HarmonicBalance::new());
        let request = request.vary("drive").omega(1.0).from(drive).to(2.0 * drive);
        let branch = first(&request);
        let (x, v) = branch.points[0].orbit.state_at(0, 0.0).unwrap();
        let oracle = paper(drive);
        let (state, exact) = if excess == 0.0 {
            ([x, v], [linear_motion, linear_motion.conj()])
        } else {
            let state = oracle.orbit([x, v], 1, 8192);
            (state, oracle.multipliers(state, 1, 8192, Switches::Exact))
        };
        let steps = oracle.multipliers(state, 1, 1024, Switches::Ignored);
        let sampled = first(&request.harmonics(20).aft(Aft::Sampled).samples(1024));
        let sampled = answer(&sampled, Method::Hill).uncorrected;
        let [steps, sampled] = [&steps[..], &sampled].map(|found| distance(found, &exact));
        let found = &branch.points[0].stability;
        let error = distance(&found.multipliers, &exact);
        let change = (exact[0] + exact[1] - 2.0 * linear_motion.re).norm();
        println!(
            "{excess:e}, {change:.1e}, {steps:.1e}, {sampled:.1e}, {error:.1e}, {:.1e}",
            found.error
        );
        assert!(
            error < found.error + 1e-12,
            "{excess}: {error:e} {:e}",
            found.error
        );
        assert!(found.verdict == Verdict::Stable && steps > 1e-4);
        if excess > 0.0 {
            assert!(steps.min(sampled) > 50.0 * error);
            changes.push(change);
        }
    }
    // A root: a hundred times the excess, ten times the change.
    for pair in changes.windows(2) {
        assert!((pair[1] / pair[0] - 10.0).abs() < 1.0, "{changes:?}");
    }
}

/// Where an orbit of period 4 touches the level, its branch turns twice within 7e-7 of the drive: at A = 1.53267, by the reference
/// values. Steps of the usual size may pass both turns unseen; shorter ones find them.
#[test]
fn a_fold_born_of_a_touch() {
    let model = linear(1.5325);
    let request = FrequencyResponse::of(&model).vary("drive").omega(1.0);
    let request = request.period(4).from(1.5325).to(1.54).stability(false);
    let start = first(&request).points.remove(0).orbit;
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .vary("drive")
        .omega(1.0);
    let shooting = shooting.near_orbit(&start).from(1.5325).to(1.54);
    // Whether a usual step ends between both turns is chance.
    println!(
        "usual steps: {} folds by the balance, {} by shooting",
        request.run().unwrap().folds().count(),
        shooting.clone().run().unwrap().folds().count()
    );
    let exact = shooting.largest_step(0.003).max_points(250).run().unwrap();
    let folds: Vec<_> = exact.folds().map(|fold| fold.point.value).collect();
    println!("by shooting, step 0.003: {folds:.12?}");
    let [touch, fold] = folds[..] else {
        panic!("{:?}", exact.events);
    };
    assert!((fold - 1.53267).abs() < 5e-6 && (touch - fold).abs() < 1e-6);
}
