//! Results through serde: what JSON has is what the result has, and what is read is what was written.

use hertzian::bifurcation::{Bifurcations, Diagram, Reason};
use hertzian::shooting::BifurcationCurve;
use hertzian::time::FlowError;
use hertzian::{EventKind, FrequencyResponse, HarmonicBalance, NewtonError, Shooting, Stop};
use serde::Serialize;
use serde::de::DeserializeOwned;
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
        .by(HarmonicBalance::new())
        .from(0.6)
        .to(1.2)
        .run()
        .unwrap();
    let all = to_value(&branch).unwrap();
    assert_eq!(all["varied"], "omega");
    assert_eq!(all["stopped"], "reached-end");
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

/// The same by way of text.
fn again<T: Serialize + DeserializeOwned>(result: &T) -> T {
    let text = serde_json::to_string(result).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Names where that is all, and otherwise an object with the numbers.
#[test]
fn why_a_branch_ended() {
    let reason = NewtonError::NotConverged {
        iterations: 3,
        update: f64::INFINITY,
        residual: 0.1,
    };
    let flow = FlowError::TooManySteps {
        phase: 0.1,
        steps: 7,
    };
    let (step, value) = (1e-9, 1.1);
    let stops = [
        (Stop::Closed, json!("closed")),
        (Stop::JoinedDoublings, json!("joined-doublings")),
        (
            Stop::PointLimit { points: 7 },
            json!({"point-limit": {"points": 7}}),
        ),
        (
            Stop::Joined {
                period: 2,
                symmetric: true,
                value,
            },
            json!({"joined": {"period": 2, "symmetric": true, "value": 1.1}}),
        ),
        (
            Stop::StepTooShort {
                step,
                value,
                reason,
            },
            json!({"step-too-short": {"step": 1e-9, "value": 1.1,
                "reason": {"not-converged": {"iterations": 3, "update": "inf", "residual": 0.1}}}}),
        ),
        (
            Stop::Motion {
                value,
                reason: flow,
            },
            json!({"motion": {"value": 1.1, "reason": {"too-many-steps": {"phase": 0.1, "steps": 7}}}}),
        ),
    ];
    for (stop, written) in stops {
        assert_eq!(to_value(stop).unwrap(), written);
        assert_eq!(again(&stop), stop);
    }
    let touch = EventKind::Grazing { turns: true };
    assert_eq!(
        to_value(touch).unwrap(),
        json!({"grazing": {"turns": true}})
    );
    assert_eq!(again(&touch), touch);
}

#[test]
fn what_is_not_finite_is_named() {
    let model = OneSided { drive: 0.1 };
    let request = FrequencyResponse::of(&model).from(0.6).to(0.7);
    let branch = request.stability(false).run().unwrap();
    let all = to_value(&branch).unwrap();
    assert_eq!(all["points"][0]["stability"]["error"], "inf");
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
    assert_eq!(
        branches[0]["branch"]["points"][0]["orbit"]["omega"],
        json!(1.0)
    );
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
    let read: Diagram = again(&diagram);
    assert_eq!(read, diagram);
}

/// What was not found is said in the same words.
#[test]
fn a_diagram_with_an_error() {
    let error = FrequencyResponse::of(&OneSided { drive: 1.0 }).orbit(-1.0);
    let mut diagram = Diagram::default();
    let reason = Reason::Failed(error.unwrap_err());
    diagram.missed.push((f64::INFINITY, reason));
    let read = again(&diagram);
    assert_eq!(read, diagram);
    let said = |diagram: &Diagram| diagram.missed[0].1.to_string();
    assert_eq!(said(&read), said(&diagram));
}

#[test]
fn a_curve_in_two_parameters() {
    let model = OneSided { drive: 0.1 };
    let request = FrequencyResponse::of(&model).by(Shooting::new());
    let branch = request.from(0.8).to(1.2).run().unwrap();
    let fold = branch.folds().next().unwrap();
    let track: BifurcationCurve = branch.track(fold, "drive", [0.09, 0.11]).unwrap();
    assert!(track.points.len() > 2);
    assert_eq!(again(&track), track);
}
