//! Contacts whose direction turns with time: the bearing of the reference values, from its matrices and from a file.

use std::f64::consts::TAU;
use std::fs;
use std::sync::Arc;

use hertzian::observe::Measure;
use hertzian::structure::{Turn, parameter};
use hertzian::{Branch, Complex, ContactEquation, FrequencyResponse, Shooting, System};
use hertzian_structure::{
    Damping, Direction, Load, LoadKind, Reduced, Reduction, SparseContact, SparseMatrix,
    SparseStructure, file,
};
use hertzian_tests::reference::{Accuracy, Case};

hertzian::law! {
    /// Ball between its rings.
    Ball(gap) { gap > 0 => gap^1.5, else => 0 }
}

fn diagonal(of: &[f64]) -> SparseMatrix {
    let entries = of.iter().enumerate().map(|(i, x)| (i, i, *x));
    SparseMatrix::from_triplets(of.len(), of.len(), entries).unwrap()
}

/// Balls in a structure that go round between two of its coordinates.
fn balls(structure: SparseStructure, [down, across]: [usize; 2]) -> SparseStructure {
    (0..8).fold(structure, |structure, ball| {
        let turn = Turn::by(2, 5).from(TAU / 8.0 * f64::from(ball));
        let contact =
            SparseContact::new(&format!("ball{ball}"), Arc::new(Ball), Direction::at(down));
        let contact = contact.turning(Direction::at(across), turn);
        structure.contact(contact.offset(parameter("clearance", 0.1)))
    })
}

/// `E1` of the reference values: a shaft without stiffness of its own.
fn bearing() -> SparseStructure {
    let shaft = SparseStructure::new(diagonal(&[1.0; 2]), diagonal(&[0.0; 2]));
    let shaft = shaft.damping(Damping::Matrix(diagonal(&[0.05; 2])));
    let load = Load::new(LoadKind::Force, Direction::at(0), 1.0).harmonic(0);
    balls(shaft.load(load), [0, 1])
        .output("x", Direction::at(0))
        .output("y", Direction::at(1))
}

fn whole(structure: &SparseStructure, to: f64) -> Reduced {
    let reduction = Reduction::to(to).modes(structure.coordinates());
    reduction.steps(0).run(structure).unwrap()
}

const ACCURACY: Accuracy = Accuracy {
    of_peaks: 1e-8,
    of_multipliers: 1e-8,
};

/// Orbits at the frequencies of the reference, by every method.
#[test]
fn a_bearing_has_the_orbits_that_are_known() {
    let structure = bearing();
    let model = whole(&structure, 1.1).structure(&structure).unwrap();
    assert_eq!(model.facts().divisor, 5);
    for [from, to] in [[0.6995, 0.7005], [0.9995, 1.0005]] {
        let mut case = Case::of("E1").within([from, to]);
        for orbit in &mut case.orbits {
            // Over all passages every ball has the largest force of all; multipliers are known of one passage.
            let largest = orbit.max_contact_force.iter().copied().reduce(f64::max);
            orbit.max_contact_force = vec![largest.unwrap(); 2];
            for multiplier in &mut orbit.multipliers {
                let all = Complex::new(multiplier[0], multiplier[1]).powi(16);
                *multiplier = [all.re, all.im];
            }
        }
        let request = FrequencyResponse::of(&model).accuracy_of("y");
        let request = request.from(from).to(to).tolerance(1e-9);
        let branches: [Branch; 2] = [
            request.clone().by(Shooting::new()).run().unwrap(),
            request.by(ContactEquation::new()).run().unwrap(),
        ];
        for branch in branches {
            case.assert_orbits(&branch, &["ball0", "ball3"], ACCURACY);
        }
    }
}

/// What a structure has at a frequency: its orbit of period one.
fn at(structure: &SparseStructure, reduced: &Reduced, omega: f64) -> Branch {
    let model = reduced.structure(structure).unwrap();
    let request = FrequencyResponse::of(&model).by(ContactEquation::new());
    let request = request.accuracy_of("middle").stability(false);
    request
        .from(omega)
        .to(1.0001 * omega)
        .max_points(2)
        .run()
        .unwrap()
}

/// A shaft of masses in two planes, held at one end, in the bearing at the other one.
fn shaft(masses: usize) -> SparseStructure {
    let springs = (0..2).flat_map(|plane| {
        (0..masses).flat_map(move |i| {
            let own = if i == 0 { 1.0 } else { 2.0 };
            let first = plane * masses + i;
            let beside = (i > 0).then(|| [(first, first - 1, -1.0), (first - 1, first, -1.0)]);
            let all = beside.into_iter().flatten().chain([(first, first, own)]);
            all.map(|(i, j, k)| (i, j, 20.0 * k))
        })
    });
    let stiffness = SparseMatrix::from_triplets(2 * masses, 2 * masses, springs).unwrap();
    let shaft = SparseStructure::new(diagonal(&vec![0.2; 2 * masses]), stiffness);
    let shaft = shaft.damping(Damping::Rayleigh {
        mass: 0.05,
        stiffness: 0.02,
    });
    let weight = Load::new(LoadKind::Force, Direction::at(0), 1.0).harmonic(0);
    let middle = masses / 2;
    balls(shaft.load(weight), [0, masses])
        .output("middle", Direction::at(middle))
        .output("aside", Direction::at(masses + middle))
}

/// Modes alone: peak-to-peaks, means, roots of mean squares and harmonics of the whole shaft are within what is stated, 2e-3 of the mean. What balls
/// do together to a peak-to-peak is much less than what each may do by itself.
#[test]
fn the_error_of_a_reduced_rotor_is_stated() {
    let structure = shaft(5);
    let exact = whole(&structure, 1.0);
    let few = Reduction::to(1.0)
        .modes(6)
        .steps(0)
        .run(&structure)
        .unwrap();
    for omega in [0.6, 1.0] {
        let (whole, reduced) = (at(&structure, &exact, omega), at(&structure, &few, omega));
        let stated = few
            .errors_at(&structure, &reduced, &reduced.points[0])
            .unwrap();
        for of in &stated {
            let mut measures = vec![Measure::PeakToPeak, Measure::Mean, Measure::Rms];
            measures.extend([16, 32].map(Measure::Amplitude));
            for measure in measures {
                let [a, b] = [&whole, &reduced].map(|branch| {
                    let reading = branch.reading(&of.name, &branch.points[0]).unwrap();
                    reading.measured(measure).unwrap()
                });
                let (error, stated) = ((a - b).abs(), of.of(measure).unwrap());
                println!(
                    "{omega} {} {measure}: {error:.2e}, stated {stated:.2e}",
                    of.name
                );
                assert!(
                    error < 1.2 * stated + 1e-8,
                    "{} {measure}: {error:e} {stated:e}",
                    of.name
                );
            }
            let mean = of.of(Measure::Mean).unwrap();
            assert!(of.name != "middle" || mean < 5e-3, "{of:?}");
        }
    }
}

/// Derivatives by a parameter of a contact that turns are those of two orbits beside each other.
#[test]
fn derivatives_are_those_of_differences() {
    let structure = shaft(5);
    let reduced = whole(&structure, 1.0);
    let size = |clearance: f64| {
        let mut model = reduced.structure(&structure).unwrap();
        model.set("clearance", clearance).unwrap();
        let request = FrequencyResponse::of(&model)
            .tolerance(1e-10)
            .accuracy_of("middle");
        let branch = request.from(0.8).to(0.801).max_points(2).run().unwrap();
        let wanted = ["middle:mean".parse().unwrap()];
        let mean = branch
            .measured(&wanted[0], &branch.points[0])
            .unwrap()
            .unwrap();
        let all = branch.sensitivities_of(&branch.points[0], &wanted).unwrap();
        (mean, all)
    };
    let (_, all) = size(0.1);
    let by = all.of("middle:mean", "clearance").unwrap().value;
    let step = 1e-4;
    let difference = (size(0.1 + step).0 - size(0.1 - step).0) / (2.0 * step);
    assert!((by / difference - 1.0).abs() < 1e-4, "{by} {difference}");
}

const BALL: &str = r#"
[[contact]]
name = "ball"
law = "Ball(gap) { gap > 0 => gap^1.5, else => 0 }"
direction = { coordinates = [0] }
turning = { towards = { coordinates = [1] }, by = [2, 5], from = 0.5 }
offset = 0.1
"#;

/// A description has what the library has, and faults have their lines.
#[test]
fn a_file_says_how_a_direction_turns() {
    let folder = std::env::temp_dir().join(format!("hertzian-turning-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let matrix = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 1\n2 2 1\n";
    fs::write(folder.join("one.mtx"), matrix).unwrap();
    let read = |contact: &str| {
        let text = format!("[matrices]\nmass = \"one.mtx\"\nstiffness = \"one.mtx\"\n{contact}");
        let path = folder.join("bearing.toml");
        fs::write(&path, text).unwrap();
        file::read(&path)
    };
    let one = || diagonal(&[1.0; 2]);
    let turn = Turn::by(2, 5).from(0.5);
    let law =
        hertzian::generic::law_from_text("Ball(gap) { gap > 0 => gap^1.5, else => 0 }").unwrap();
    let ball = SparseContact::new("ball", law, Direction::at(0));
    let ball = ball.turning(Direction::at(1), turn).offset(0.1);
    let expected = SparseStructure::new(one(), one()).contact(ball);
    let found = read(BALL).unwrap();
    let reduced = whole(&expected, 1.0);
    reduced.is_of(&found).unwrap();
    let places = |structure: &SparseStructure| {
        let model = reduced.structure(structure).unwrap();
        let mut coefficients = vec![0.0; model.facts().places.len()];
        model.coefficients(&[], 1.3, &mut coefficients);
        (model.facts().places.clone(), coefficients)
    };
    assert_eq!(places(&found), places(&expected));
    for (from, to, said) in [
        ("by = [2, 5]", "by = [2, 0]", "turns `by` a fraction"),
        (
            "offset = 0.1",
            "force_direction = { coordinates = [1] }",
            "has no `force_direction`",
        ),
        ("from = 0.5", "from = inf", "inf is no number"),
        (
            "coordinates = [1] }, by",
            "coordinates = [7] }, by",
            "coordinate 7",
        ),
    ] {
        let error = read(&BALL.replace(from, to)).unwrap_err().to_string();
        assert!(
            error.contains(said) && error.contains("bearing.toml:9: "),
            "{error}"
        );
    }
    let many = read(&BALL.replace("by = [2, 5]", "by = [2, 4099]")).unwrap();
    let error = reduced.structure(&many).unwrap_err().to_string();
    assert!(
        error.contains("turns by 2/4099 of the frequency"),
        "{error}"
    );
    fs::remove_dir_all(folder).unwrap();
}
