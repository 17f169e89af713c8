//! Integration in time: steps across switches, and perturbations that do not jump there.

use hertzian::stability::Method;
use hertzian::{FrequencyResponse, HarmonicBalance};

use super::models::{OneSided, answer, distance, first, linear};
use super::oracle::{Contact, EXACT, Switches, pair, paper};

/// Fourth order in name: a step that does not know of the switch errs by its own length there.
#[test]
fn steps_across_switches_are_of_first_order() {
    let exact = pair(EXACT[0].1);
    println!("steps, across switches, from switch to switch");
    let mut errors = Vec::new();
    for steps in [128, 1024, 8192, 65536] {
        let [ignored, located] = [Switches::Ignored, Switches::Exact].map(|switches| {
            let found = paper(1.0).multipliers(EXACT[0].0, 1, steps, switches);
            distance(&found, &exact)
        });
        println!("{steps}, {ignored:.1e}, {located:.1e}");
        assert!(located < 1e-6 && ignored > 1e-5);
        errors.push(ignored);
    }
    // 512 times the steps.
    let order = (errors[0] / errors[3]).ln() / 512_f64.ln();
    assert!((0.5..1.5).contains(&order), "{order}");
    let model = linear(1.0);
    let request = FrequencyResponse::of(&model).by(HarmonicBalance::new());
    let request = request.vary("drive").omega(1.0);
    let answer = answer(&first(&request.from(1.0).to(1.01)), Method::Default).stability;
    let error = distance(&answer.multipliers, &exact);
    println!("default {error:.1e}, estimate {:.1e}", answer.error);
    assert!(error < answer.error && answer.error < 2e-5);
}

/// Wang et al. (2021), Fig. 5b, where contact is lost: with exponent 3/2 the multipliers notice that a perturbation jumps with the
/// damping force.
#[test]
fn without_saltation_an_error_stays() {
    let oracle = Contact {
        alpha: 1.5,
        omega: 0.8,
        ..paper(0.1)
    };
    let model = OneSided {
        zeta: oracle.zeta,
        alpha: oracle.alpha,
        load: oracle.load,
        drive: oracle.drive,
    };
    let request = FrequencyResponse::of(&model).by(HarmonicBalance::new());
    let request = request.from(1.6).to(0.6);
    let branch = request.run().unwrap();
    let orbits = branch.at(oracle.omega).unwrap();
    let largest = orbits
        .iter()
        .max_by(|a, b| a.peak_to_peak().total_cmp(&b.peak_to_peak()));
    let point = largest.unwrap();
    let (x, v) = point.orbit.state_at(0, 0.0).unwrap();
    let state = oracle.orbit([x, v], 1, 64000);
    let exact = oracle.multipliers(state, 1, 64000, Switches::Exact);
    println!("steps, without saltation, with it");
    for steps in [4000, 16000] {
        let error = |switches| distance(&oracle.multipliers(state, 1, steps, switches), &exact);
        let [without, with] = [Switches::WithoutSaltation, Switches::Exact].map(error);
        println!("{steps}, {without:.2e}, {with:.1e}");
        assert!((2.6e-3..2.9e-3).contains(&without), "{without:e}");
        assert!(with < 1e-4, "{with:e}");
    }
    let error = distance(&point.stability.multipliers, &exact);
    println!(
        "default {error:.1e}, estimate {:.1e}",
        point.stability.error
    );
    assert!(error < point.stability.error && point.stability.error < 1e-4);
}
