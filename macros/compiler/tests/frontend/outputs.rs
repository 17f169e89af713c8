//! Outputs: what they are lowered to, and what is refused.

use crate::{faults, model, summary};

const PAIR: &str = "Pair(x[2]: mm, y: mm) {
    param m: t > 0;
    param k: N/mm^1.5 > 0;
    param c: N*s/mm;
    param e: mm > 0;
    param a: 1;
    law mesh(gap) { gap > 0 => k*gap^1.5, else => 0 }
    law rest(gap) { gap > 0 => k*gap^1.5, else => 0 }
    let contact = mesh(x[0] - x[1] - e*cos(omega*t));
    m*ddot(x[0]) + c*dot(x[0]) + contact = 0;
    m*ddot(x[1]) + c*dot(x[1]) - contact + 2*rest(x[1]) = 0;
    m*ddot(y) + a*c*dot(y) + rest(y - e) = 0;
    OUTPUTS
}";

fn with(outputs: &str) -> String {
    PAIR.replace("OUTPUTS", outputs)
}

/// The coefficients of outputs.
fn terms(outputs: &str) -> Vec<String> {
    let lines = summary(&model(&with(outputs)));
    lines
        .into_iter()
        .filter(|line| line.starts_with('y'))
        .collect()
}

#[test]
fn terms_are_at_their_places() {
    for (outputs, expected) in [
        (
            "output slip = x[0] - x[1];",
            vec!["y0 Coordinate(0) = 1", "y0 Coordinate(1) = -1"],
        ),
        (
            "output path = a*(y + e*cos(omega*t)); output speed: m/s = dot(y + e*cos(omega*t));",
            vec![
                "y0 Coordinate(2) = a",
                "y0 Constant cos1 = e*a",
                "y1 Rate(2) = 0.001",
                "y1 Constant sin1 = -0.001*e*omega",
            ],
        ),
        (
            "output a1 = ddot(x[1])/2;",
            vec!["y0 Acceleration(1) = 0.5"],
        ),
        ("output tooth = force(mesh);", vec!["y0 Force(0) = 1"]),
        ("output tooth: kN = contact;", vec!["y0 Force(0) = 0.001"]),
        (
            "output tooth = mesh(x[0] - x[1] - e*cos(omega*t)) + c*dot(x[0]) + 2*rest(x[1]);",
            vec!["y0 Force(0) = 1", "y0 Rate(0) = c", "y0 Force(1) = 2"],
        ),
        (
            "output all = for j in 0..2 { x[j] };",
            vec!["y0 Coordinate(0) = 1", "y0 Coordinate(1) = 1"],
        ),
    ] {
        assert_eq!(terms(outputs), expected, "{outputs}");
    }
}

#[test]
fn names_units_and_documentation_are_kept() {
    let text = with(
        "/// slip of the teeth
         output slip: um = x[0] - x[1];
         output tooth = force(mesh);
         output speed = dot(y);
         output ratio = y/e;",
    );
    let facts = model(&text).facts();
    let units: Vec<_> = facts.outputs.iter().map(|o| o.unit.as_ref()).collect();
    assert_eq!(units, ["um", "N", "mm/s", ""]);
    assert_eq!(facts.outputs[0].documentation, "slip of the teeth");
    assert_eq!(facts.outputs[0].name, "slip");
    assert_eq!(facts.units.as_ref(), ["mm", "mm", "mm"]);
    assert_eq!(facts.parameters[2].unit, "N*s/mm");
}

#[test]
fn a_law_that_is_linear_is_multiplied_out() {
    let lines = summary(&model(
        "M(x) { law spring(g) { 3*g + dot(g)/2 } ddot(x) + spring(x - cos(omega*t)) = 0; output f = force(spring); }",
    ));
    let terms: Vec<_> = lines.iter().filter(|l| l.starts_with('y')).collect();
    assert_eq!(
        terms,
        [
            "y0 Coordinate(0) = 3",
            "y0 Constant cos1 = -3",
            "y0 Rate(0) = 0.5",
            "y0 Constant sin1 = 0.5*omega",
        ]
    );
}

#[test]
fn the_word_is_a_name_elsewhere() {
    let lines = summary(&model(
        "M(output) { param force > 0; ddot(output) + output = force*cos(omega*t); output y = output/force; }",
    ));
    assert_eq!(
        lines.last().map(String::as_str),
        Some("y0 Coordinate(0) = 1/force")
    );
}

#[test]
fn what_is_no_output_is_refused() {
    for (outputs, message) in [
        ("output q = x[0]^2;", "an output is linear in coordinates"),
        ("output q = 3*e;", "holds neither a coordinate nor a force"),
        (
            "output q = cos(omega*t)*e;",
            "holds neither a coordinate nor a force",
        ),
        ("output q = x[0]*cos(omega*t/2);", "takes longer to repeat"),
        ("output q = x[0]*t;", "not harmonic in omega*t"),
        (
            "output q = mesh(x[0] - x[1]);",
            "acts at this gap in no equation",
        ),
        ("output q = force(rest);", "law `rest` acts in 2 contacts"),
        (
            "output q = force(mash);",
            "there is no law `mash`: did you mean `force(mesh)`?",
        ),
        ("output q = force(y);", "there is no law `y`"),
        ("output q: N = y;", "`y` is in mm, and is not measured in N"),
        ("output q: mn = y;", "unknown unit `mn`"),
        ("output q = y + m;", "they cannot be added"),
        (
            "output y = x[0];",
            "output `y` has the name of a coordinate",
        ),
        (
            "output q = y; output q = y;",
            "output `q` is declared twice",
        ),
        (
            "output q = y; output p = q;",
            "`q` is an output, which is only read",
        ),
        (
            "output q = dot(ddot(y));",
            "derivatives higher than the second",
        ),
        ("output q y;", "expected `=`"),
        ("output q = z;", "unknown name `z`"),
    ] {
        let found = faults(&with(outputs));
        assert!(found.contains(message), "{outputs}: {found}");
    }
    let alone = "M(x) { ddot(x) + x = 0; output y: mm = x; }";
    assert!(faults(alone).contains("while nothing else has one"));
    let idle = "M(x) { law f(g) { g^3 } ddot(x) + x = 0; output y = force(f); }";
    assert!(faults(idle).contains("law `f` acts in no equation"));
}
