//! Laws that stand alone, and structures given as matrices.

use hertzian::FrequencyResponse;
use hertzian::error::ErrorKind;
use hertzian::law::{Law, On, RateDependence};
use hertzian::structure::{Contact, DMatrix, Structure, Value, parameter};
use hertzian::system::{Bound, System, Variable};

hertzian::law! {
    /// Force of a spring that is touched at gap zero.
    Spring(gap, k) { gap > 0 => k*gap, else => 0 }
}

hertzian::law! {
    /// Contact whose damping grows with the force.
    pub HuntCrossley(gap, k, c, alpha > 0) {
        gap > 0 => k*gap^alpha*(1 + c*dot(gap)),
        else => 0,
    }
}

hertzian::oscillator! {
    /// Two masses, the first with an elastic stop.
    TwoMasses(x1, x2) {
        param stop > 0;
        param drive;
        law stop_spring(gap) { gap > 1 => stop*(gap - 1), else => 0 }
        ddot(x1) + 0.03*(dot(x1) - dot(x2)) + x1 - x2 + stop_spring(x1) = 0;
        ddot(x2) + 0.03*(2*dot(x2) - dot(x1)) + 2*x2 - x1 = drive*cos(omega*t);
    }
}

fn stiffness() -> DMatrix<f64> {
    DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 2.0])
}

fn two_masses() -> hertzian::structure::Builder {
    let stiffness = stiffness();
    Structure::of(&DMatrix::identity(2, 2), &(0.03 * &stiffness), &stiffness).cosine(
        1,
        1,
        parameter("drive", 0.1),
    )
}

fn stop() -> Contact {
    Contact::new(Spring)
        .arguments([parameter("stop", 100.0)])
        .direction([1.0, 0.0])
        .offset(1.0)
}

#[test]
fn matrices_and_a_declaration_are_one_system() {
    let structure = two_masses().contact(stop()).build().expect("it is sound");
    let declared = TwoMasses {
        stop: 100.0,
        drive: 0.1,
    };
    let curve = |system: &dyn System| {
        let request = FrequencyResponse::of(system).from(0.8).to(0.9);
        let branch = request.harmonics(7).samples(128).run().expect("it runs");
        let points = branch.at(0.85).expect("it was passed");
        points.first().expect("a point").peak_to_peak()
    };
    let (a, b) = (curve(&structure), curve(&declared));
    assert!((a - b).abs() < 1e-9, "{a} {b}");
}

#[test]
fn parameters_are_varied_by_name() {
    let mut structure = two_masses()
        .constant(0, parameter("drive", 0.1).times(3.0))
        .contact(stop())
        .build()
        .expect("it is sound");
    let names: Vec<_> = structure
        .facts()
        .parameters
        .iter()
        .map(|p| p.name.to_string())
        .collect();
    assert_eq!(names, ["drive", "stop"]);
    let count = structure.facts().places.len();
    let [mut low, mut high, mut by] = [(); 3].map(|()| vec![0.0; count]);
    structure.coefficients(&[0.1, 100.0], 1.0, &mut low);
    structure.coefficients(&[0.2, 100.0], 1.0, &mut high);
    structure.coefficients_by(Variable::Parameter(0), &[0.1, 100.0], 1.0, &mut by);
    for ((low, high), by) in low.iter().zip(&high).zip(&by) {
        assert!((high - low - 0.1 * by).abs() < 1e-15);
    }
    assert_eq!(by.iter().sum::<f64>(), 4.0);
    structure.coefficients_by(Variable::Omega, &[0.1, 100.0], 1.0, &mut by);
    assert!(by.iter().all(|&by| by == 0.0));

    structure.set("stop", 50.0).expect("there is one");
    let mut values = [0.0; 2];
    structure.values(&mut values);
    assert_eq!(values, [0.1, 50.0]);
    assert!(structure.set("stopp", 50.0).is_err());
}

fn square(size: usize) -> DMatrix<f64> {
    DMatrix::identity(size, size)
}

/// What is said of the fault.
fn fails(builder: hertzian::structure::Builder) -> String {
    let error = builder.build().expect_err("a fault");
    assert_eq!(error.kind(), ErrorKind::Model);
    error.to_string()
}

#[test]
fn matrices_that_do_not_fit_are_said_with_numbers() {
    assert_eq!(
        fails(Structure::of(&square(2), &square(3), &square(2))),
        "the damping matrix is 3 by 3; the mass matrix has 2 rows, and all must be square, of one size, and not empty"
    );
    let empty = square(0);
    let fault = fails(Structure::of(&empty, &empty, &empty));
    assert!(fault.contains("matrix is 0 by 0; "), "{fault}");
    let singular = DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 2.0, 4.0]);
    for mass in [singular, DMatrix::zeros(2, 2)] {
        let fault = fails(Structure::of(&mass, &square(2), &square(2)));
        assert_eq!(
            fault,
            "the mass matrix has no inverse: its smallest pivot is 0e0 of the largest"
        );
    }
    // In doubles the determinant of this is 1.4e-17, and its inverse finite.
    let nearly = DMatrix::from_row_slice(2, 2, &[0.1, 0.3, 0.3, 0.9]);
    let fault = fails(Structure::of(&nearly, &square(2), &square(2)));
    assert!(fault.starts_with("the mass matrix has no inverse"));
    let pivot = fault.split(' ').find_map(|word| word.parse::<f64>().ok());
    assert!(pivot.is_some_and(|pivot| pivot < 1e-15), "{fault}");
    // A mass and an inertia in other units.
    let units = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 1e-20]);
    assert!(
        Structure::of(&units, &square(2), &square(2))
            .build()
            .is_ok()
    );
    let mut holed = square(2);
    holed[(0, 1)] = f64::INFINITY;
    let fault = fails(Structure::of(&square(2), &square(2), &holed));
    assert!(fault.starts_with("inf in "), "{fault}");
}

#[test]
fn loads_and_contacts_that_do_not_fit_are_said_with_numbers() {
    for name in ["", "omega"] {
        let fault = fails(two_masses().constant(0, parameter(name, 1.0)));
        let said = format!("a parameter cannot be called `{name}`: ");
        assert!(fault.starts_with(&said), "{fault}");
    }
    assert_eq!(
        fails(two_masses().constant(2, 1.0)),
        "a load on coordinate 2, counted from zero; there are 2"
    );
    assert_eq!(
        fails(two_masses().contact(stop().direction([1.0]))),
        "a direction of contact 0 has 1 entries; there are 2 coordinates"
    );
    assert_eq!(
        fails(two_masses().contact(stop().arguments([1.0, 2.0]))),
        "law `Spring` has 1 arguments, and 2 were given"
    );
    let fault = fails(two_masses().contact(stop().offset(parameter("drive", 0.5))));
    assert_eq!(
        fault,
        "parameter `drive` is 0.1 in one place and 0.5 in another"
    );
}

hertzian::law! {
    /// Two flanks with play between them.
    Flanks(gap, play > 0, n in 1..=3) {
        gap > play => (gap - play)^n,
        -play <= gap <= play => 0,
        gap < -play => -(-gap - play)^n,
    }
}

/// A contact of the first mass with two flanks.
fn flanks(play: Value, n: f64) -> Contact {
    let arguments: [Value; 2] = [play, n.into()];
    Contact::new(Flanks)
        .arguments(arguments)
        .direction([1.0, 0.0])
}

#[test]
fn arguments_lie_in_the_ranges_of_the_law() {
    let build = |play: Value, n| two_masses().contact(flanks(play, n)).build();
    for n in [1.0, 3.0] {
        assert!(build(0.5.into(), n).is_ok());
    }
    let range = |argument: &str, value: f64, range: &str| {
        format!("argument `{argument}` of law `Flanks` is {value}, outside its range {range}")
    };
    for (play, n, expected) in [
        (0.5.into(), 3.5, range("n", 3.5, "[1, 3]")),
        (0.0.into(), 2.0, range("play", 0.0, "(0, inf)")),
        (
            parameter("play", 0.5).times(-2.0),
            2.0,
            range("play", -1.0, "(0, inf)"),
        ),
    ] {
        let fault = build(play, n).expect_err("a fault");
        assert_eq!(fault.to_string(), expected);
    }
    let fault = build(0.5.into(), 0.5).expect_err("a fault");
    assert_eq!(
        fault.to_string(),
        "argument `n` of law `Flanks` is 0.5, outside its range [1, 3]"
    );
}

#[test]
fn a_parameter_is_varied_within_the_ranges_of_what_it_is_passed_for() {
    let contact = |n: Value| {
        let arguments: [Value; 2] = [0.5.into(), n];
        Contact::new(Flanks)
            .arguments(arguments)
            .direction([1.0, 0.0])
    };
    let mut structure = two_masses()
        .contact(contact(parameter("n", 2.0)))
        .contact(contact(parameter("n", 2.0).times(0.5)))
        .contact(contact(parameter("m", -1.5).times(-1.0)))
        .build()
        .expect("it is sound");
    let parameters = structure.facts().parameters.iter();
    let ranges: Vec<_> = parameters.map(|p| (p.minimum, p.maximum)).collect();
    let within = |low, high| (Bound::Included(low), Bound::Included(high));
    let free = (Bound::Unbounded, Bound::Unbounded);
    assert_eq!(ranges, [free, within(2.0, 3.0), within(-3.0, -1.0)]);

    let vary = |structure: &Structure| {
        let request = FrequencyResponse::of(structure).vary("n").omega(0.8);
        request
            .from(2.5)
            .to(3.5)
            .run()
            .err()
            .map(|error| error.to_string())
    };
    let refused = Some("parameter n = 3.5 is outside its range [2, 3]".to_owned());
    assert_eq!(vary(&structure), refused);
    structure.set("n", 1.0).expect("there is one");
    let request = FrequencyResponse::of(&structure).from(0.8).to(0.9);
    let error = request.run().expect_err("`n` is too small");
    assert_eq!(
        error.to_string(),
        "parameter n = 1 is outside its range [2, 3]"
    );
}

#[test]
fn a_law_alone_takes_its_arguments_in_order() {
    let law: &dyn Law = &HuntCrossley;
    assert_eq!(law.facts().name, "HuntCrossley");
    let arguments = law.facts().arguments.iter();
    let (names, ranges): (Vec<_>, Vec<_>) = arguments
        .map(|argument| (argument.name.as_ref(), [argument.minimum, argument.maximum]))
        .unzip();
    let free = [Bound::Unbounded; 2];
    assert_eq!(names, ["k", "c", "alpha"]);
    assert_eq!(
        ranges,
        [free, free, [Bound::Excluded(0.0), Bound::Unbounded]]
    );
    assert_eq!(law.facts().rate, RateDependence::Linear);
    let (k, c, alpha) = (3.0, 0.2, 1.7);
    let (gap, rate) = ([-1.0, 0.0, 0.5, 2.0], [1.0, -1.0, 0.5, -0.25]);
    let mut force = [f64::NAN; 4];
    law.force(On::AllPieces, &[k, c, alpha], &gap, &rate, &mut force);
    for ((&g, &r), &force) in gap.iter().zip(&rate).zip(&force) {
        let expected = k * f64::max(g, 0.0).powf(alpha) * (1.0 + c * r);
        assert!((force - expected).abs() <= 1e-14 * expected.abs());
    }
    assert!(law.parts().is_some());
}

#[test]
fn a_model_whose_parameters_have_defaults_has_one() {
    hertzian::oscillator! {
        /// An oscillator with a cubic spring.
        Cubic(x) {
            param k = 2.5 in 0.0..;
            param drive = -1;
            ddot(x) + x + k*x^3 = drive*cos(omega*t);
        }
    }
    assert_eq!(
        Cubic::default(),
        Cubic {
            k: 2.5,
            drive: -1.0
        }
    );
}
