//! Tables of measured values: what is read, and what is refused with its line.

use std::f64::consts::TAU;
use std::fmt::Write;

use hertzian_fit::{Fit, read};

hertzian::oscillator! {
    /// In units.
    pub Mount(x: m) {
        /// mass
        param m: kg = 2;
        /// damping
        param c: N*s/m = 4;
        /// stiffness
        param k: N/m = 800;
        /// amplitude of the excitation
        param drive: N = 3;
        m*ddot(x) + c*dot(x) + k*x = drive*cos(omega*t);
        output speed: m/s = dot(x);
    }
}

/// Amplitudes in micrometres over hertz, of a mount with other values.
fn table() -> String {
    let mut text = "# a comment\n\u{feff}".replace('\u{feff}', "")
        + "frequency [Hz]; x:p2p [um]; drive [mN]\n";
    for i in 0..12 {
        let frequency = 2.0 + 0.2 * f64::from(i);
        let omega = TAU * frequency;
        for drive in [1.0, 2.0] {
            let amplitude = drive / (900.0 - 2.0 * omega * omega).hypot(5.0 * omega);
            let (size, drive) = (2e6 * amplitude, 1e3 * drive);
            // Writing to a string does not fail.
            let _ = writeln!(text, "{frequency}; {size}; {drive}");
        }
    }
    text
}

#[test]
fn units_are_those_of_the_header() {
    let sets = read(&table(), &Mount::default(), None).expect("data sets");
    let names: Vec<&str> = sets.iter().map(hertzian_fit::DataSet::name).collect();
    assert_eq!(names, ["x:p2p drive=1", "x:p2p drive=2"]);
    let fit = sets.into_iter().fold(Fit::of(&Mount::default()), Fit::data);
    let fitted = fit.free("k").free("c").run().expect("a fit");
    for (name, value) in [("k", 900.0), ("c", 5.0)] {
        let estimate = fitted.estimate(name).expect(name);
        assert!((estimate.value / value - 1.0).abs() < 1e-6, "{fitted}");
    }
    assert_eq!(fitted.estimate("k").expect("k").unit, "N/m");
    assert_eq!(fitted.sets[0].unit, "m");
    let csv = fitted.to_csv();
    assert_eq!(csv.lines().count(), 25);
    let json: serde_json::Value = serde_json::from_str(&fitted.to_json()).expect("JSON");
    assert_eq!(json["estimates"][0]["name"], "k");
    assert!(fitted.picture().to_svg().contains("x:p2p ["));
}

#[test]
fn what_is_wrong_is_said_with_its_line() {
    let cases = [
        ("", "line 1: the table is empty"),
        ("\n\n", "line 1: the table is empty"),
        (
            "omega,x:p2p\n",
            "line 1: there are no rows below the header",
        ),
        (
            "omega,x:p2p\n1,2\n1,2,3\n",
            "line 3: 3 cells, and 2 columns in the header",
        ),
        (
            "omega,x:p2p\n1,2\n# note\n\n1,abc\n",
            "line 5: `abc` in column 2 is not a number",
        ),
        (
            "omega,x:p2p\n1,inf\n",
            "line 2: `inf` in column 2 is not a number",
        ),
        (
            "omega,x:p2p,sd\n1,2,0\n",
            "line 2: a standard deviation is 0: it must be positive",
        ),
        (
            "omega,x:p2p,sd\n1,2,\n",
            "line 2: x:p2p has no standard deviation here",
        ),
        (
            "omega,x:p2p,sweep\n1,2,sideways\n",
            "line 2: `sideways` is no sweep: rising, falling, settled or controlled",
        ),
        (
            "omega,x:p2p,x:p2p\n1,2,3\n",
            "line 1: column 3, `x:p2p`: there is another one like it",
        ),
        (
            "omega\n1\n",
            "line 1: no column says what was measured: name one as `x:p2p`, `x:rms` or `x:h1`",
        ),
        (
            "x:p2p\n1\n",
            "line 1: no column says where it was measured: name one `omega`, `frequency [Hz]`, or as the parameter that was varied",
        ),
        (
            "frequency,x:p2p\n1,2\n",
            "line 1: column 1, `frequency`: say its unit: [Hz], [rpm] or [rad/s]",
        ),
        (
            "frequency [V],x:p2p\n1,2\n",
            "line 1: column 1, `frequency [V]`: [V] is no unit of a frequency: take [Hz], [kHz], [rpm] or [rad/s]",
        ),
        (
            "omega,x:p2p [V]\n1,2\n",
            "line 1: column 2, `x:p2p [V]`: [V] is not what the model measures it in, which is m, nor that with another prefix",
        ),
        (
            "omega,y:p2p\n1,2\n",
            "line 1: column 2, `y:p2p`: no output, coordinate or contact is called y: there are speed, x",
        ),
        (
            "omega,x:p2p,mass\n1,2,3\n",
            "line 1: column 3, `mass`: it is neither `omega`, `frequency [Hz]`, something measured as `x:p2p`, `sd`, `sweep`, `set`, nor a parameter; parameters are m, c, k, drive",
        ),
        (
            "omega,x:p2p [um],sd [nm]\n1,2,3\n",
            "line 1: [nm]: standard deviations are in the unit of what was measured, as its column has it",
        ),
        (
            "omega,x:p2p,x:rms,sd\n1,2,3,1\n",
            "line 1: several columns are measured: say `sd of x:p2p` instead of `sd`",
        ),
    ];
    for (table, said) in cases {
        let error = read(table, &Mount::default(), None).expect_err(said);
        assert_eq!(error.to_string(), said, "{table:?}");
    }
}

/// What was not measured is left out, and a parameter may be what was varied.
#[test]
fn columns_are_told_by_their_names() {
    let table = "drive,speed:rms,sd of speed:rms,x:p2p,set\n1,0.1,0.01,,a\n2,0.2,0.01,0.5,a\n";
    let sets = read(table, &Mount::default(), Some(30.0)).expect("data sets");
    let sizes: Vec<(&str, usize)> = sets.iter().map(|set| (set.name(), set.len())).collect();
    assert_eq!(sizes, [("speed:rms a", 2), ("x:p2p a", 1)]);
    let fit = sets.into_iter().fold(Fit::of(&Mount::default()), Fit::data);
    // Without the frequency it is not known what was measured.
    assert!(fit.free("c").run().is_ok());
    let sets = read(table, &Mount::default(), None).expect("data sets");
    let fit = sets.into_iter().fold(Fit::of(&Mount::default()), Fit::data);
    let error = fit.free("c").run().expect_err("no frequency");
    assert_eq!(
        error.to_string(),
        "data set speed:rms a: drive varies: give the frequency, a positive number"
    );
}
