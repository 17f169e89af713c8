//! Crossings of branches without a symmetry: beside a driven oscillator, another one has equilibria that are known.

use hertzian::bifurcation::{Bifurcations, Diagram, DiagramBranch, Origin, Reason};
use hertzian::{EventKind, FrequencyResponse, OrbitError, Point, Shooting, Side, System};

hertzian::oscillator! {
    /// `y = 0`, or `y^2 = omega - at`.
    pub Pitchfork(x, y) {
        param at;
        law contact(gap) { gap > 0 => 0.1*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
        ddot(y) + 0.5*dot(y) + (at - omega)*y + y^3 = 0;
    }
}

hertzian::oscillator! {
    /// `y = 0`, or `y = at - omega`.
    pub Transcritical(x, y) {
        param at;
        law contact(gap) { gap > 0 => 0.1*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
        ddot(y) + 0.5*dot(y) + (at - omega)*y - y^2 = 0;
    }
}

pub const AT: f64 = 2.3;

fn diagram(system: &dyn System) -> Diagram {
    let request = Bifurcations::of(system).from(2.0).to(2.6).depth(2);
    request.run().unwrap()
}

/// Both directions of the other branch, from a crossing whose place is known.
fn of_crossing(diagram: &Diagram, kind: EventKind) -> [&DiagramBranch; 2] {
    let crossings: Vec<_> = diagram.branches[0].branch.events(kind).collect();
    let [crossing] = crossings[..] else {
        panic!(
            "{:?} {:?}",
            diagram.branches[0].branch.events, diagram.branches[0].branch.turns
        );
    };
    let error = (crossing.point.value - AT).abs();
    assert!(
        error < 1e-9 && error <= crossing.error,
        "{crossing} {error:.1e}"
    );
    let [_, one, other] = &diagram.branches[..] else {
        panic!("{} branches, {:?}", diagram.branches.len(), diagram.omitted);
    };
    for (branch, expected) in [(one, Side::One), (other, Side::Other)] {
        let Origin::Event {
            branch: 0, side, ..
        } = branch.origin
        else {
            panic!("{:?}", branch.origin);
        };
        assert_eq!(side, expected);
        // Those without a symmetry are images of each other.
        let image = kind == EventKind::SymmetryBreaking && side == Side::Other;
        assert_eq!(branch.mirrored, image);
    }
    [one, other]
}

fn assert_near(cycle: &Point, expected: f64) {
    let y = cycle.observed.motions[1];
    for found in [y.minimum, y.maximum] {
        assert!(
            (found - expected).abs() < 1e-8,
            "{} {found} {expected}",
            cycle.value
        );
    }
}

#[test]
fn both_directions_of_a_pitchfork() {
    let diagram = diagram(&Pitchfork { at: AT });
    let branches = of_crossing(&diagram, EventKind::SymmetryBreaking);
    let signs = branches.map(|branch| branch.branch.points[0].observed.motions[1].maximum.signum());
    assert_eq!(signs[0], -signs[1]);
    for (branch, sign) in branches.into_iter().zip(signs) {
        let cycles = &branch.branch.points;
        assert!(cycles.len() > 3 && (cycles[cycles.len() - 1].value - 2.66).abs() < 1e-12);
        for cycle in cycles {
            assert_near(cycle, sign * (cycle.value - AT).sqrt());
        }
    }
}

#[test]
fn both_directions_of_a_transcritical_crossing() {
    let diagram = diagram(&Transcritical { at: AT });
    let branches = of_crossing(&diagram, EventKind::BranchPoint);
    let ends = branches.map(|branch| branch.branch.points.last().unwrap().value);
    assert!((ends[0] - ends[1]).abs() > 0.6, "{ends:?}");
    for branch in branches {
        for cycle in &branch.branch.points {
            assert_near(cycle, AT - cycle.value);
        }
    }
}

#[test]
fn what_is_not_followed_is_said() {
    let model = Transcritical { at: AT };
    let request = Bifurcations::of(&model).from(2.0).to(2.6);
    let diagram = request.depth(0).run().unwrap();
    let reasons: Vec<_> = diagram.omitted.iter().map(|o| &o.reason).collect();
    assert_eq!(reasons, [&Reason::Depth]);
}

/// Where nothing begins, there is nothing to switch to.
#[test]
fn at_a_fold_nothing_begins() {
    let model = crate::bifurcations::symmetry::Hardening {
        zeta: 0.01,
        drive: 0.1,
    };
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .from(0.7)
        .to(1.7);
    let branch = shooting.run().unwrap();
    let fold = branch.folds().next().unwrap();
    let error = shooting.switch(fold, Side::One).unwrap_err();
    assert!(
        matches!(error.downcast_ref(), Some(OrbitError::NoBranch { .. })),
        "{error}"
    );
}
