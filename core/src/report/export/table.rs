//! Orbits as a table: one row of cells for each, numbers as short as they read back to the same bits. A form of export makes its file of them.

use crate::branches::branch::{Branch, Model};
use crate::branches::observed::Motion;
use crate::branches::point::Point;
use crate::orbit::observe::Measure;
use crate::report::unit::in_unit;

/// Names of the columns that every table begins with; after them come the parameters of the system, by name, and then for each
/// contact by its name, that of its law with a number from one on where the law acts in several (the next one where an output, a
/// coordinate or another law has that name), as of one called `stop`, `stop_min_force` and `stop_max_force`, the extremes of its law with their signs, and `stop_piece_1` and so on, the part of the period on each piece of its
/// law, from the lowest gaps to the highest.
///
/// | column | what it is |
/// |---|---|
/// | `omega` | frequency of the excitation, radians per unit of time |
/// | `peak_to_peak`, `max`, `min`, `mean`, `rms` | of the first coordinate; the mean counts in `rms` |
/// | `stability` | `stable`, `unstable` or `undecided` |
/// | `multiplier_1_re` to `multiplier_2_im` | the two Floquet multipliers of largest modulus, over the period of the orbit |
/// | `contact_fraction` | part of the period on pieces of the law of the first contact that are not zero: 1 for a law that acts everywhere |
/// | `contacts` | intervals of contact in a period |
/// | `peak_force` | largest value of the law of the first contact, by size, without factors outside of it: see [`ContactMotion`](crate::orbit::observe::ContactMotion) |
/// | `dissipated_power` | mean over the period |
/// | `harmonics` | of the base frequency `omega/period` |
/// | `error` | estimated error of `peak_to_peak`, relative; `error_of_tip` where [accuracy was asked of](crate::FrequencyResponse::accuracy_of) one called `tip` |
/// | `branch` | number of the branch; 0 is the one that was asked for |
/// | `period` | periods of the declaration in the period of the orbit |
/// | `value` | of what varies along the branch |
///
/// Where a model has outputs or several coordinates, there follow for each output and each coordinate, by its name, as of one called `tip`,
/// `tip_p2p`, `tip_max`, `tip_min`, `tip_mean`, `tip_rms` and `tip_crest`, the [measures](Measure) of these names; then for each contact
/// `stop_impulse` and `stop_impacts`, over the period of the orbit.
///
/// In a model with units what has one says so: `omega [rad/s]`, `tip_rms [um]`, `stop_max_force [N]`.
///
/// What is not known, or is not there, is empty, as much is of an orbit by shooting until it is
/// [completed](crate::Branch::complete); a number that is not finite is `inf` or `NaN`.
pub const COLUMNS: [&str; 20] = [
    "omega",
    "peak_to_peak",
    "max",
    "min",
    "mean",
    "rms",
    "stability",
    "multiplier_1_re",
    "multiplier_1_im",
    "multiplier_2_re",
    "multiplier_2_im",
    "contact_fraction",
    "contacts",
    "peak_force",
    "dissipated_power",
    "harmonics",
    "error",
    "branch",
    "period",
    "value",
];

/// A table of orbits of one system, perhaps of several branches.
///
/// ```
/// use hertzian::FrequencyResponse;
/// use hertzian::export::Table;
///
/// hertzian::oscillator! {
///     Duffing(x) {
///         param bend = 0.2;
///         ddot(x) + 0.1*dot(x) + x + bend*x^3 = 0.2*cos(omega*t);
///     }
/// }
///
/// let model = Duffing::default();
/// let branch = FrequencyResponse::of(&model).from(0.5).to(1.5).run()?;
/// let mut table = Table::of(&model);
/// branch.points.iter().for_each(|point| table.add(0, point));
/// assert_eq!(table.to_csv(), branch.to_csv());
/// assert!(table.to_csv().lines().next().unwrap().contains(",value,bend,force 1_min_force,"));
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Table {
    /// Names of the columns.
    names: Vec<String>,
    /// With a cell for each name.
    rows: Vec<Vec<String>>,
    parameters: usize,
    /// Pieces of the law of each contact.
    pieces: Vec<usize>,
    /// How many outputs and coordinates have columns of their names.
    named: [usize; 2],
}

impl Table {
    /// A table without rows. A parameter whose name is that of another column gets an underscore after it.
    pub fn of(system: &dyn crate::system::System) -> Self {
        Self::of_model(&Model::of(system))
    }

    /// The same where the system itself is not at hand.
    pub fn of_model(model: &Model) -> Self {
        let pieces = model.pieces.clone();
        let mut others = of_contacts(model);
        let named = named(model);
        if named != [0; 2] {
            others.extend(of_signals(model));
            others.extend(contacts(model).flat_map(|(contact, _)| {
                ["impulse", "impacts"].map(|what| format!("{contact}_{what}"))
            }));
        }
        let parameters = model.parameters.iter().map(|own| own.name.clone());
        let mut names = without_repetition(&others, parameters);
        names.extend(others);
        with_units(model, &mut names);
        Self {
            names,
            rows: Vec::new(),
            parameters: model.parameters.len(),
            pieces,
            named,
        }
    }

    /// The orbits of a branch.
    pub(super) fn of_branch(branch: &Branch) -> Self {
        let mut table = Self::of_model(&branch.model).with_errors_of(branch.accuracy_of());
        for point in &branch.points {
            table.add(0, point);
        }
        table
    }

    /// The names of the columns.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// The rows, with a cell for each column: a text, or a number as one. What is not known is empty.
    pub(super) fn rows(&self) -> &[Vec<String>] {
        &self.rows
    }

    /// The same where errors are of an output or a coordinate of this name, as of [`Branch::accuracy_of`](crate::Branch::accuracy_of).
    #[must_use]
    pub fn with_errors_of(mut self, name: Option<&str>) -> Self {
        let error = self.names.iter().position(|own| own == "error");
        if let (Some(error), Some(name)) = (error, name) {
            let mut of_name = format!("error_of_{name}");
            while self.names.contains(&of_name) {
                of_name.push('_');
            }
            self.names[error] = of_name;
        }
        self
    }

    /// Adds a row: an orbit, and the number of its branch.
    pub fn add(&mut self, branch: usize, point: &Point) {
        let parameters = point.parameters.iter().take(self.parameters);
        let mut row = Vec::with_capacity(self.names.len());
        row.extend(cells(branch, point));
        row.extend(parameters.map(|&value| number(value)));
        let observed = &point.observed;
        for (index, &pieces) in self.pieces.iter().enumerate() {
            let contact = observed.contacts.get(index);
            let on_pieces = observed.on_pieces.get(index);
            let forces = contact.map(|contact| [contact.minimum_force, contact.maximum_force]);
            let values = forces
                .iter()
                .flatten()
                .chain(on_pieces.into_iter().flatten());
            let cells = values.map(|&value| number(value));
            row.extend(
                cells
                    .chain(std::iter::repeat(String::new()))
                    .take(2 + pieces),
            );
        }
        row.extend(self.signals(point));
        self.rows.push(row);
    }

    /// The columns of named signals, and what follows them.
    fn signals(&self, point: &Point) -> Vec<String> {
        let observed = &point.observed;
        let [outputs, coordinates] = self.named;
        let motion = |motions: &[Motion], index: usize| motions.get(index).copied();
        let outputs = (0..outputs).map(|index| motion(&observed.outputs, index));
        let coordinates = (0..coordinates).map(|index| motion(observed.read(), index));
        let mut cells: Vec<String> = outputs
            .chain(coordinates)
            .flat_map(|motion| {
                Measure::USUAL.map(|measure| maybe(motion.and_then(|motion| measure.of(&motion))))
            })
            .collect();
        if self.named != [0; 2] {
            for index in 0..self.pieces.len() {
                let contact = observed.contacts.get(index);
                cells.push(maybe(contact.and_then(|contact| contact.impulse)));
                let impacts = contact.map(|contact| contact.impacts().to_string());
                cells.push(impacts.unwrap_or_default());
            }
        }
        cells
    }
}

/// [`COLUMNS`] and the parameters: one whose name is another column's gets an underscore after it, or as many as it takes.
fn without_repetition(others: &[String], parameters: impl Iterator<Item = String>) -> Vec<String> {
    let mut names: Vec<String> = COLUMNS.map(str::to_owned).to_vec();
    for mut name in parameters {
        while names.contains(&name) || others.contains(&name) {
            name.push('_');
        }
        names.push(name);
    }
    names
}

/// How many outputs and coordinates have columns of their names: none where one coordinate is all there is.
fn named(model: &Model) -> [usize; 2] {
    match [model.outputs.len(), model.coordinates.len()] {
        [0, 1] => [0, 0],
        counts => counts,
    }
}

/// Names of the columns of outputs and coordinates.
fn of_signals(model: &Model) -> impl Iterator<Item = String> {
    let outputs = model.outputs.iter().map(|output| &output.name);
    let names = outputs.chain(&model.coordinates);
    names.flat_map(|name| Measure::USUAL.map(|measure| format!("{name}_{measure}")))
}

/// Adds units to the names of columns, in the order in which [`Table::of_model`] has them.
fn with_units(model: &Model, names: &mut [String]) {
    let Some(first) = model.units.first().map(String::as_str) else {
        return;
    };
    let force = |contact: usize| model.force_units.get(contact).map_or("", String::as_str);
    let own = COLUMNS.map(|name| match name {
        "omega" => "rad/s",
        "peak_to_peak" | "max" | "min" | "mean" | "rms" => first,
        "peak_force" => force(0),
        _ => "",
    });
    let parameters = model.parameters.iter().map(|own| own.unit.as_str());
    let of_contacts = model.pieces.iter().enumerate();
    let of_contacts = of_contacts.flat_map(|(contact, &pieces)| {
        let on_pieces = std::iter::repeat_n("", pieces);
        std::iter::repeat_n(force(contact), 2).chain(on_pieces)
    });
    let own = own.into_iter().chain(parameters).chain(of_contacts);
    let mut units: Vec<String> = own.map(str::to_owned).collect();
    if named(model) != [0; 2] {
        let outputs = model.outputs.iter().map(|output| &output.unit);
        let signals = outputs.chain(&model.units);
        units.extend(signals.flat_map(|unit| Measure::USUAL.map(|measure| measure.unit(unit))));
        let contacts = 0..model.pieces.len();
        units.extend(contacts.flat_map(|contact| {
            [Measure::Impulse, Measure::Impacts].map(|measure| measure.unit(force(contact)))
        }));
    }
    for (name, unit) in names.iter_mut().zip(units) {
        *name = in_unit(name, &unit);
    }
}

/// Names of the contacts, as [`Model::contacts`] has them, with the number of pieces of each law; numbers where a file has no names.
fn contacts(model: &Model) -> impl Iterator<Item = (String, usize)> {
    let pieces = model.pieces.iter().copied().enumerate();
    pieces.map(|(index, pieces)| {
        let name = model.contacts.get(index).cloned();
        let name = name.unwrap_or_else(|| format!("contact_{}", index + 1));
        (name, pieces)
    })
}

/// Names of the columns of contacts.
fn of_contacts(model: &Model) -> Vec<String> {
    let names = contacts(model).flat_map(|(contact, pieces)| {
        let forces = ["min", "max"].map(|which| format!("{contact}_{which}_force"));
        let pieces = (1..=pieces).map(move |piece| format!("{contact}_piece_{piece}"));
        forces.into_iter().chain(pieces)
    });
    names.collect()
}

/// An orbit of a branch with a number as the texts of [`COLUMNS`]: a row of a [`Table`] without its parameters and what is said of every contact.
pub fn cells(branch: usize, point: &Point) -> [String; 20] {
    let motion = point.motion();
    let part = |index: usize, imaginary: bool| {
        let multiplier = point.stability.multipliers.get(index);
        let part = multiplier.map(|m| if imaginary { m.im } else { m.re });
        part.map_or_else(String::new, number)
    };
    let contact = point.observed.contacts.first();
    [
        number(point.omega()),
        number(motion.peak_to_peak()),
        number(motion.maximum),
        number(motion.minimum),
        maybe(motion.mean),
        maybe(motion.rms),
        point.stability.verdict.to_string(),
        part(0, false),
        part(0, true),
        part(1, false),
        part(1, true),
        maybe(contact.map(|contact| contact.fraction)),
        contact.map_or_else(String::new, |contact| contact.count.to_string()),
        maybe(contact.map(|contact| contact.peak_force)),
        maybe(point.observed.dissipated_power),
        harmonics(point),
        maybe(point.error),
        branch.to_string(),
        point.orbit.period.to_string(),
        number(point.value),
    ]
}

/// Empty where the series are not known.
fn harmonics(point: &Point) -> String {
    match point.orbit.harmonics() {
        0 => String::new(),
        harmonics => harmonics.to_string(),
    }
}

/// Empty where it is not known.
pub(crate) fn maybe(value: Option<f64>) -> String {
    value.map_or_else(String::new, number)
}

/// As short as reads back to the same number.
pub(crate) fn number(value: f64) -> String {
    format!("{value:?}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::FrequencyResponse;

    crate::oscillator! {
        Named(x) {
            param mean = 0.5;
            param drive = 0.1;
            ddot(x) + 0.2*dot(x) + x = drive*cos(omega*t) + mean;
        }
    }

    #[test]
    fn rows_are_the_closed_form_under_their_names() {
        let model = Named::default();
        let branch = FrequencyResponse::of(&model).from(0.5).to(1.5).run();
        let text = branch.expect("a branch").to_csv();
        let mut lines = text.lines();
        let names: Vec<&str> = lines.next().expect("names").split(',').collect();
        assert_eq!(names[..20], COLUMNS);
        assert_eq!(names[20..], ["mean_", "drive"]);
        for line in lines {
            let cells: Vec<&str> = line.split(',').collect();
            let cell = |name: &str| {
                let column = names.iter().position(|&other| other == name);
                cells[column.expect("a column")]
            };
            let value = |name: &str| cell(name).parse::<f64>().expect("a number");
            let omega = value("omega");
            let stiffness = (1.0 - omega * omega).hypot(0.2 * omega);
            assert!((value("peak_to_peak") * stiffness - 0.2).abs() < 1e-9);
            assert!((value("mean") - 0.5).abs() < 1e-12);
            assert_eq!((value("mean_"), value("drive")), (0.5, 0.1));
            assert_eq!((cell("contacts"), cell("peak_force")), ("", ""));
            assert_eq!((cell("stability"), value("value")), ("stable", omega));
        }
    }

    crate::oscillator! {
        Taken(x, y) {
            param x_p2p = 0.5;
            param stop_3_impulse = 0.1;
            param error_of_x = 0.2;
            law stop(gap) { gap > 0 => gap, else => 0 }
            law stop_2(gap) { gap > 1 => 3*(gap - 1), else => 0 }
            ddot(x) + 0.2*dot(x) + x + stop(x - 9) + stop_2(x) = x_p2p*cos(omega*t);
            ddot(y) + error_of_x*dot(y) + y + stop(y - 8) = stop_3_impulse*cos(omega*t);
            output stop_1 = 2*x;
        }
    }

    #[test]
    fn names_of_columns_and_contacts_are_unique() {
        let model = Taken::default();
        let branch = FrequencyResponse::of(&model).from(0.5).to(0.52);
        let branch = branch.accuracy_of("x").run().expect("a branch");
        let contacts = &branch.model.contacts;
        assert_eq!(*contacts, ["stop_3", "stop_2", "stop_4"]);
        let text = branch.to_csv();
        let mut lines = text.lines();
        let names: Vec<&str> = lines.next().expect("names").split(',').collect();
        let unique: std::collections::HashSet<&&str> = names.iter().collect();
        assert_eq!(unique.len(), names.len(), "{names:?}");
        assert_eq!(names[20..23], ["x_p2p_", "stop_3_impulse_", "error_of_x"]);
        assert!(names.contains(&"error_of_x_") && names.contains(&"stop_4_impacts"));
        let cells: Vec<&str> = lines.next().expect("a row").split(',').collect();
        let cell = |name: &str| {
            let column = names.iter().position(|&other| other == name);
            cells[column.expect("a column")]
        };
        let value = |name: &str| cell(name).parse::<f64>().expect("a number");
        assert_eq!((value("x_p2p_"), value("error_of_x")), (0.5, 0.2));
        assert!((value("stop_1_p2p") - 2.0 * value("x_p2p")).abs() < 1e-9);
    }
}
