//! Results through serde: what JSON has is what the result has.

use hertzian::bifurcation::Bifurcations;
use hertzian::{EventKind, FrequencyResponse};
use serde_json::{Value, json, to_value};

hertzian::oscillator! {
    OneSided(x) {
        param drive;
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

#[test]
fn a_branch_by_harmonic_balance() {
    let model = OneSided { drive: 0.1 };
    let branch = FrequencyResponse::of(&model)
        .from(0.6)
        .to(1.2)
        .run()
        .unwrap();
    let all = to_value(&branch).unwrap();
    assert_eq!(all["varied"], "omega");
    assert_eq!(all["stopped"], "reached the end of the range");
    assert_eq!(all["elapsed"], json!(branch.elapsed.as_secs_f64()));
    assert_eq!(
        all["statistics"]["jacobians"],
        json!(branch.statistics.jacobians)
    );
    assert_eq!(all["points"].as_array().unwrap().len(), branch.points.len());
    for (written, point) in all["points"].as_array().unwrap().iter().zip(&branch.points) {
        assert_eq!(written["value"], json!(point.value));
        assert_eq!(
            written["orbit"]["series"],
            json!(point.orbit.series(0).unwrap())
        );
        let stability = &written["stability"];
        assert_eq!(stability["verdict"], point.stability.verdict.to_string());
        let first = point.stability.multipliers[0];
        assert_eq!(stability["multipliers"][0], json!([first.re, first.im]));
        let motion = &written["observed"]["motions"][0];
        assert_eq!(motion["maximum"], json!(point.motion().maximum));
    }
    let folds: Vec<_> = branch.folds().collect();
    let events = all["events"].as_array().unwrap();
    let written: Vec<&Value> = events.iter().filter(|e| e["kind"] == "fold").collect();
    assert_eq!(written.len(), folds.len());
    assert_eq!(written[0]["point"]["value"], json!(folds[0].point.value));
}

/// Numbers that are not finite have no JSON.
#[test]
fn what_is_not_known_is_null() {
    let model = OneSided { drive: 0.1 };
    let request = FrequencyResponse::of(&model).from(0.6).to(0.7);
    let branch = request.stability(false).run().unwrap();
    let all = to_value(&branch).unwrap();
    assert_eq!(all["points"][0]["stability"]["error"], Value::Null);
    assert_eq!(all["points"][0]["stability"]["verdict"], "undecided");
}

#[test]
fn a_diagram_of_bifurcations() {
    let model = OneSided { drive: 1.0 };
    let request = Bifurcations::of(&model).vary("drive").omega(1.0);
    let diagram = request.from(1.2).to(1.5).depth(1).run().unwrap();
    let all = to_value(&diagram).unwrap();
    let branches = all["branches"].as_array().unwrap();
    assert_eq!(branches.len(), diagram.branches.len());
    assert_eq!(branches[0]["origin"], "first");
    assert_eq!(branches[0]["branch"]["cycles"][0]["omega"], json!(1.0));
    let doublings = diagram.events(EventKind::PeriodDoubling).count();
    let written = branches
        .iter()
        .flat_map(|branch| branch["branch"]["events"].as_array().unwrap());
    assert_eq!(
        written
            .filter(|event| event["kind"] == "period-doubling")
            .count(),
        doublings
    );
}
