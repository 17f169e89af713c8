//! Outputs of structures by vectors: displacements, rates, accelerations, forces.

use hertzian::observe::Reading;
use hertzian::structure::{Builder, Contact, DMatrix, Structure, parameter};
use hertzian::{FrequencyResponse, HarmonicBalance, OrbitMethod, Shooting};

use super::{at, close};

/// Amplitudes of an output and of its first two derivatives are `a`, `w a` and `w^2 a`; each runs ahead of the last by a quarter of a
/// period. `a` is a complex amplitude, of `re cos(wt) - im sin(wt)`.
fn are_of<M: OrbitMethod>(structure: &Structure, by: M, omega: f64, [re, im]: [f64; 2]) {
    let request = FrequencyResponse::of(structure).by(by);
    let point = request.orbit(omega).expect("an orbit");
    let mut exact = [re, im];
    for name in ["place", "speed", "shaking"] {
        let reading = request.reading(name, &point).expect(name);
        let amplitude = exact[0].hypot(exact[1]);
        close(reading.motion.peak_to_peak(), 2.0 * amplitude, 1e-8);
        close(reading.motion.maximum, amplitude, 1e-8);
        let line = &reading.spectrum()[1];
        close(line.amplitude, amplitude, 1e-8);
        let off = line.phase - (-exact[1]).atan2(exact[0]);
        close(off.cos(), 1.0, 1e-12);
        exact = [-omega * exact[1], omega * exact[0]];
    }
}

/// `m x'' + c x' + k x = F cos(wt)` has the complex amplitude `F/(k - m w^2 + i w c)`.
#[test]
fn derivatives_of_one_mass_are_those_of_its_formula() {
    let (m, c, k, force) = (2.0, 0.3, 5.0, 0.7);
    let one = |x: f64| DMatrix::from_element(1, 1, x);
    let structure = Structure::of(&one(m), &one(c), &one(k))
        .cosine(0, 1, force)
        .output("place", [3.0])
        .unit("mm")
        .rate_output("speed", [3.0])
        .unit("mm/s")
        .about("speed of the mass\n\nas a vibrometer shows it")
        .acceleration_output("shaking", [3.0])
        .build()
        .expect("it is sound");
    for omega in [0.4, 1.5, 3.0] {
        let (re, im) = (k - m * omega * omega, c * omega);
        let exact = [re, -im].map(|part| 3.0 * force * part / (re * re + im * im));
        are_of(&structure, HarmonicBalance::new(), omega, exact);
        are_of(&structure, Shooting::new(), omega, exact);
    }
    let (branch, _) = at(&structure, 0.4);
    let outputs = &branch.model.outputs;
    let units: Vec<_> = outputs.iter().map(|own| own.unit.as_str()).collect();
    assert_eq!(units, ["mm", "mm/s", ""]);
    assert!(outputs[1].documentation.starts_with("speed of the mass"));
}

/// Two masses without symmetry: complex amplitudes by Cramer's rule.
#[test]
fn derivatives_along_a_vector_are_those_of_two_masses() {
    let two = |x: [f64; 4]| DMatrix::from_row_slice(2, 2, &x);
    let (m, c, k) = (
        [2.0, 0.3, 0.3, 1.0],
        [0.2, -0.1, -0.1, 0.3],
        [5.0, -2.0, -2.0, 3.0],
    );
    let (force, weights) = (0.7, [1.0, -0.5]);
    let structure = Structure::of(&two(m), &two(c), &two(k))
        .cosine(1, 1, force)
        .output("place", weights)
        .rate_output("speed", weights)
        .acceleration_output("shaking", weights)
        .build()
        .expect("it is sound");
    for omega in [0.5, 1.3, 2.4] {
        let entry = |i: usize| [k[i] - omega * omega * m[i], omega * c[i]];
        let times =
            |a: [f64; 2], b: [f64; 2]| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
        let [a, b, c, d] = [0, 1, 2, 3].map(entry);
        let (ad, bc) = (times(a, d), times(b, c));
        let determinant = [ad[0] - bc[0], ad[1] - bc[1]];
        // The second column of the inverse is (-b, a) over the determinant.
        let read = [0, 1].map(|part| force * (weights[1] * a[part] - weights[0] * b[part]));
        let size = determinant[0].powi(2) + determinant[1].powi(2);
        let exact = times(read, [determinant[0], -determinant[1]]).map(|part| part / size);
        are_of(&structure, HarmonicBalance::new(), omega, exact);
        are_of(&structure, Shooting::new(), omega, exact);
    }
}

hertzian::law! {
    /// A spring that is touched at gap zero.
    Spring(gap, k) { gap > 0 => k*gap, else => 0 }
}

hertzian::oscillator! {
    /// What [`stopped`] describes.
    Declared(x, y) {
        param drive = 0.1;
        law stop(gap) { gap > 0 => 100*gap, else => 0 }
        ddot(x) + 0.03*dot(x) - 0.03*dot(y) + x - y + stop(x - 0.2) = 0;
        ddot(y) - 0.03*dot(x) + 0.06*dot(y) - x + 2*y = drive*cos(omega*t);
        output apart = x - y;
        output closing = dot(x) - dot(y);
        output shaking = 2*ddot(x) + ddot(y);
        output push = force(stop);
    }
}

/// Two masses of which the first meets a stop.
fn stopped() -> Builder {
    let matrix = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 2.0]);
    let stop = Contact::new(Spring)
        .arguments([100.0])
        .direction([1.0, 0.0]);
    Structure::of(&DMatrix::identity(2, 2), &(0.03 * &matrix), &matrix)
        .cosine(1, 1, parameter("drive", 0.1))
        .contact(stop.offset(0.2))
        .output("apart", [1.0, -1.0])
        .rate_output("closing", [1.0, -1.0])
        .acceleration_output("shaking", [2.0, 1.0])
        .force_output("push", 0)
}

/// With a contact too, an acceleration is what the equations of motion give.
#[test]
fn outputs_with_a_contact_are_those_of_a_declaration() {
    let structure = stopped().build().expect("it is sound");
    let declared = Declared::default();
    let read = |system: &dyn hertzian::System| -> Vec<Reading> {
        let (branch, point) = at(system, 0.8);
        let names = ["apart", "closing", "shaking", "push"];
        names
            .map(|name| branch.reading(name, &point).expect(name))
            .into()
    };
    for (own, other) in read(&structure).iter().zip(read(&declared)) {
        let (own, other) = (&own.motion, &other.motion);
        close(own.maximum, other.maximum, 1e-10);
        close(own.minimum, other.minimum, 1e-10);
        let rms = [own, other].map(|motion| motion.rms.expect("a smooth motion"));
        close(rms[0], rms[1], 1e-10);
    }
}

#[test]
fn a_structure_has_outputs_by_vectors() {
    let structure = stopped().build().expect("it is sound");
    let (branch, point) = at(&structure, 0.8);
    let [apart, push] = ["apart", "push"].map(|name| branch.reading(name, &point).expect(name));
    let [x, y] = [0, 1].map(|index| point.orbit.series(index).expect("a series"));
    for (apart, (x, y)) in apart.series.iter().zip(x.iter().zip(y)) {
        close(*apart, x - y, 1e-14);
    }
    close(
        push.motion.maximum,
        point.observed.contacts[0].maximum_force,
        1e-12,
    );
    for builder in [
        stopped().output("apart", [1.0, 0.0]),
        stopped().rate_output("apart", [1.0, 0.0]),
        stopped().output("q1", [1.0, 0.0]),
        stopped().output("drive", [1.0, 0.0]),
        stopped().output("", [1.0, 0.0]),
        stopped().output("short", [1.0]),
        stopped().acceleration_output("short", [1.0]),
        stopped().rate_output("infinite", [1.0, f64::INFINITY]),
        stopped().force_output("other", 1),
    ] {
        assert!(builder.build().is_err());
    }
}
