//! What is said of outputs: errors, columns, descriptions.

use super::*;

#[test]
fn what_cannot_be_read_is_said() {
    let (branch, point) = at(&Isolated::default(), 0.8);
    let failed = |text: &str| {
        let wanted = text.parse().expect(text);
        branch.measured(&wanted, &point).expect_err(text)
    };
    let unknown = failed("sped:max");
    assert!(
        matches!(unknown.downcast_ref(), Some(RequestError::UnknownSignal { name, known }) if name == "sped" && known[1] == "speed"),
    );
    let impulse = failed("speed:impulse");
    assert_eq!(
        impulse.to_string(),
        "impulse per period is one of contacts, and speed is none"
    );
    let (thrown, _) = at(&Thrown::default(), 0.9);
    let model = thrown.model.clone();
    let piece = model.check(&"ground:piece9".parse().expect("a measure"));
    let piece = piece.expect_err("there are two").to_string();
    assert_eq!(piece, "ground has no piece 9: its law has 2");
    {
        let view = hertzian::chart::View::new().of("x:h500".parse().expect("a measure"));
        let harmonic = thrown.chart_of(&view).expect_err("there are fewer");
        let highest = thrown.points.iter().map(|point| point.orbit.harmonics());
        let highest = highest.max().expect("orbits");
        let said =
            format!("harmonic 500 of x was not computed: these orbits have {highest} of them");
        assert_eq!(harmonic.to_string(), said);
    }
    let model = Isolated::default();
    let request = FrequencyResponse::of(&model).by(Shooting::new());
    let shot = request.from(0.8).to(0.81).run().expect("a branch");
    let bare = &shot.points[0];
    let complete = shot.complete(bare).expect("a series");
    let speed = shot.reading("speed", &complete).expect("an output");
    let expected = branch.reading("speed", &point).expect("an output");
    close(
        speed.motion.peak_to_peak(),
        expected.motion.peak_to_peak(),
        1e-7,
    );
}

#[test]
fn tables_have_columns_by_name_and_unit() {
    let (branch, point) = at(&Thrown::default(), 0.9);
    let text = branch.to_csv();
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let (names, cells) = (
        lines.next().expect("names"),
        lines.next().expect("an orbit"),
    );
    let cell = |name: &str| {
        let column = names.iter().position(|own| *own == name);
        cells[column.unwrap_or_else(|| panic!("{name} in {names:?}"))]
    };
    let value = |name: &str| cell(name).parse::<f64>().expect("a number");
    for (name, wanted) in [
        ("tooth_max [mN]", "tooth:max"),
        ("speed_rms [m/s]", "speed:rms"),
        ("shaking_p2p [mm/s^2]", "shaking:p2p"),
        ("carried_crest", "carried:crest"),
        ("x_min [mm]", "x:min"),
        ("ground_impulse [N*s]", "ground:impulse"),
        ("ground_impacts", "ground:impacts"),
    ] {
        let expected = branch.measured(&wanted.parse().expect(wanted), &point);
        assert_eq!(Some(value(name)), expected.expect(wanted), "{name}");
    }
    assert_eq!(value("omega [rad/s]"), 0.9);
    assert_eq!(value("k [N/mm^1.5]"), 1.0);
    assert_eq!(cell("peak_to_peak [mm]"), cell("x_p2p [mm]"));
    let widths = text.lines().map(|line| line.split(',').count());
    assert!(widths.into_iter().all(|width| width == names.len()));
}

/// What is said of an event names what leads, with units, and has no more digits than its error bears.
#[test]
fn events_are_described_by_what_leads() {
    let (branch, point) = at(&Thrown::default(), 0.9);
    let said = branch.describe_size(&point);
    assert!(
        said.starts_with("peak-to-peak of tooth ") && said.ends_with(" mN"),
        "{said}"
    );
    let request = FrequencyResponse::of(&Thrown::default()).from(0.6).to(1.2);
    let branch = request.run().expect("a branch");
    let fold = branch.folds().next().expect("a fold");
    let said = branch.describe(fold);
    let number = said.strip_prefix("fold at ").expect(&said);
    let number = number.split(' ').next().expect("a number");
    assert!(said.contains(&format!("{number} rad/s (error ")), "{said}");
    let last = 10.0_f64.powi(-(number.split('.').nth(1).map_or(0, str::len) as i32));
    assert!(last <= fold.error && fold.error < 10.0 * last, "{said}");
    let value: f64 = number.parse().expect("a number");
    assert!((value - fold.point.value).abs() <= 0.5 * last, "{said}");
    assert!(
        said.contains(" peak-to-peak of tooth ") && said.ends_with(" mN"),
        "{said}"
    );
}

/// What is not a number is not larger than one, wherever it stands.
#[test]
fn the_largest_orbit_is_one_of_those_with_a_number() {
    let (branch, _) = super::at(&super::Isolated::default(), 0.9);
    let largest = |branch: &hertzian::Branch| {
        let found = branch.largest("x:p2p").expect("a measure");
        found.map(|point| point.value)
    };
    // Below its resonance a linear oscillator moves the more the higher the frequency.
    assert_eq!(largest(&branch), Some(0.9 * 1.001));
    let mut unknown = branch;
    unknown.points[0].observed.motions[0].maximum = f64::NAN;
    assert_eq!(largest(&unknown), Some(0.9 * 1.001));
    for point in &mut unknown.points {
        point.observed.motions[0].maximum = f64::NAN;
    }
    assert_eq!(largest(&unknown), None);
}
