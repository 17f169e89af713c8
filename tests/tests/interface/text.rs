//! A declaration read from text is the one that the macro compiles.

use hertzian::generic::{Declaration, interpreted};
use hertzian::law::{Law, On};
use hertzian::system::{System, Variable};

/// Declares a model by macro, and the text of it.
macro_rules! both {
    ($text:ident: $($declaration:tt)*) => {
        hertzian::oscillator! { $($declaration)* }
        const $text: &str = stringify!($($declaration)*);
    };
}

both! { HUNT_CROSSLEY:
    HuntCrossley(x) {
        param k > 0;
        param c in 0.0..;
        param alpha > 0;
        law contact(gap) {
            gap > 0 => k*gap^alpha*(1 + c*dot(gap)),
            else => 0,
        }
        ddot(x) + 0.1*omega*dot(x) + contact(x) = k*omega^2*cos(omega*t) + 1;
    }
}

both! { STOP:
    Stop(x, y) {
        param k > 0;
        param play = 0.25 in 0.0..1.0;
        law stop(gap) {
            gap > play => k*(gap - play),
            else => 0,
        }
        ddot(x) + 0.03*(dot(x) - dot(y)) + x - y + stop(x) = 0;
        ddot(y) + 0.03*(2*dot(y) - dot(x)) + 2*y - x = 0.1*cos(omega*t);
    }
}

#[test]
fn text_and_macro_are_one_model() {
    let hunt_crossley = HuntCrossley {
        k: 3.0,
        c: 0.2,
        alpha: 1.7,
    };
    compare(&hunt_crossley, HUNT_CROSSLEY);
    compare(&Stop { k: 30.0, play: 0.5 }, STOP);
}

fn compare(model: &dyn System, text: &str) {
    let mut declared = Declaration::parse(text).expect("the macro has accepted it");
    // A macro cannot keep the layout of the equation apart from its tokens; the rest is the same to the letter.
    let facts = declared.facts().clone();
    let facts = facts.equation(model.facts().equation.clone());
    assert_eq!(&facts, model.facts());
    let mut values = vec![0.0; facts.parameters.len()];
    model.values(&mut values);
    for (parameter, &value) in facts.parameters.iter().zip(&values) {
        declared
            .set(&parameter.name, value)
            .expect("the parameter is there");
    }
    let mut set = vec![0.0; values.len()];
    declared.values(&mut set);
    assert_eq!(set, values);

    let variables = [Variable::Omega]
        .into_iter()
        .chain((0..values.len()).map(Variable::Parameter));
    let [mut expected, mut found] = [(); 2].map(|()| vec![0.0; facts.places.len()]);
    model.coefficients(&values, 0.7, &mut expected);
    declared.coefficients(&values, 0.7, &mut found);
    assert_close(&found, &expected);
    for variable in variables {
        model.coefficients_by(variable, &values, 0.7, &mut expected);
        declared.coefficients_by(variable, &values, 0.7, &mut found);
        assert_close(&found, &expected);
    }

    let interpreted = interpreted(model);
    for index in 0..facts.laws {
        same_law(declared.law(index), interpreted.law(index));
    }
}

fn same_law(declared: &dyn Law, interpreted: &dyn Law) {
    assert_eq!(declared.facts(), interpreted.facts());
    assert_eq!(declared.data(), interpreted.data());
    let arguments = vec![0.75; declared.facts().arguments.len()];
    let gap: Vec<f64> = (-100..100).map(|i| f64::from(i) / 40.0).collect();
    let rate: Vec<f64> = gap.iter().map(|gap| gap.sin()).collect();
    let [mut found, mut expected] = [(); 2].map(|()| vec![f64::NAN; gap.len()]);
    declared.force(On::AllPieces, &arguments, &gap, &rate, &mut found);
    interpreted.force(On::AllPieces, &arguments, &gap, &rate, &mut expected);
    assert_eq!(found, expected);
    match (declared.parts(), interpreted.parts()) {
        (Some(a), Some(b)) => {
            same_law(a.spring, b.spring);
            same_law(a.primitive, b.primitive);
        }
        (None, None) => {}
        _ => panic!("only one of the two has parts"),
    }
}

/// Generated coefficients may round differently, by an operation or two.
fn assert_close(found: &[f64], expected: &[f64]) {
    for (found, expected) in found.iter().zip(expected) {
        let bound = 4.0 * f64::EPSILON * expected.abs();
        assert!((found - expected).abs() <= bound, "{found}, not {expected}");
    }
}

#[test]
fn every_fault_has_its_place() {
    let text = "Oscillator(x) {
    param k > 0;
    ddot(x) + q*x =
        k*cos(omega*t) + z;
}";
    let error = Declaration::parse(text).expect_err("there are faults");
    let places: Vec<(usize, usize)> = error.faults.iter().map(|f| (f.line, f.column)).collect();
    assert_eq!(places, [(3, 15), (4, 26)], "{error}");
    assert!(error.to_string().starts_with("3:15: "), "{error}");

    let error = Declaration::parse("Oscillator(x) {\n  x'' = 1").expect_err("it is no Rust");
    assert_eq!(
        error.to_string(),
        "2:3: a second derivative by time is written `ddot(x)`, not `x''`"
    );
    let error = Declaration::parse("Oscillator(x) {\n  ddot(x)").expect_err("it has no end");
    assert_eq!(error.faults.len(), 1);
    assert!(error.faults[0].line >= 1);
    assert!(Declaration::parse("").is_err());
}

#[test]
fn the_macro_may_stand_around_a_text() {
    let bare = Declaration::parse(STOP).expect("the macro has accepted it");
    let text = format!("hertzian::oscillator! {{\n{STOP}\n}}");
    let wrapped = Declaration::parse(&text).expect("it is the same");
    assert_eq!(wrapped.facts(), bare.facts());
}

#[test]
fn parameters_are_set_by_name() {
    let mut model = Declaration::parse(STOP).expect("the macro has accepted it");
    let mut values = [0.0; 2];
    model.values(&mut values);
    assert!(values[0].is_nan());
    assert_eq!(values[1], 0.25);
    let error = model.set("K", 1.0).expect_err("no such parameter");
    assert_eq!(
        error.to_string(),
        "there is no parameter K; there are k, play"
    );
}
