//! A structure: matrices, damping, loads, contacts, outputs.

use std::sync::Arc;

use hertzian::law::Law;
use hertzian::structure::{Turn, Value};
use hertzian::system::ParameterFacts;

use crate::error::StructureError;
use crate::matrix::SparseMatrix;

/// What differs from symmetry by more than this part of the largest entry is no rounding.
const ROUNDING: f64 = 1e-9;

/// A linear combination of coordinates: what a gap, a force or an output is along.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Direction {
    pub(crate) entries: Vec<(usize, f64)>,
}

impl Direction {
    /// One coordinate, counted from zero.
    pub fn at(coordinate: usize) -> Self {
        Self::weighted([(coordinate, 1.0)])
    }

    /// The mean of several coordinates. A force along it is shared between them in equal parts.
    pub fn mean(coordinates: &[usize]) -> Self {
        let share = 1.0 / coordinates.len().max(1) as f64;
        Self::weighted(coordinates.iter().map(|&coordinate| (coordinate, share)))
    }

    /// Coordinates with their factors. Several factors of one coordinate add up.
    pub fn weighted(entries: impl IntoIterator<Item = (usize, f64)>) -> Self {
        Self {
            entries: entries.into_iter().collect(),
        }
    }

    /// Of all coordinates their factors.
    pub(crate) fn full(&self, coordinates: usize) -> Vec<f64> {
        let mut full = vec![0.0; coordinates];
        for &(coordinate, factor) in &self.entries {
            full[coordinate] += factor;
        }
        full
    }
}

/// Damping ratios, parts of the critical one.
#[derive(Debug, Clone, PartialEq)]
pub enum Ratios {
    /// One for all modes.
    One(f64),
    /// Of each mode, the lowest first; those beyond the list have its last one. Rigid modes count.
    PerMode(Vec<f64>),
    /// Angular frequencies in ascending order with their ratios; linear between, constant beyond.
    Table(Vec<[f64; 2]>),
}

impl Ratios {
    /// Of a mode.
    pub(crate) fn of(&self, mode: usize, frequency: f64) -> f64 {
        match self {
            Self::One(ratio) => *ratio,
            Self::PerMode(ratios) => ratios.get(mode).or(ratios.last()).copied().unwrap_or(0.0),
            Self::Table(table) => between(table, frequency),
        }
    }

    /// By which part those from a mode or a frequency on differ at most.
    pub(crate) fn spread(&self, mode: usize, frequency: f64) -> f64 {
        let beyond: Vec<f64> = match self {
            Self::One(_) => Vec::new(),
            Self::PerMode(ratios) => {
                let beyond = ratios.iter().skip(mode).chain(ratios.last());
                beyond.copied().collect()
            }
            Self::Table(table) => {
                let beyond = table.iter().filter(|[at, _]| *at > frequency);
                let here = between(table, frequency);
                beyond.map(|[_, ratio]| *ratio).chain([here]).collect()
            }
        };
        let [least, most] = beyond
            .iter()
            .fold([f64::INFINITY, 0.0], |[least, most], x| {
                [x.min(least), x.max(most)]
            });
        if most > 0.0 {
            (most - least) / most
        } else {
            0.0
        }
    }

    fn numbers(&self) -> Vec<f64> {
        match self {
            Self::One(ratio) => vec![*ratio],
            Self::PerMode(ratios) => ratios.clone(),
            Self::Table(table) => table.concat(),
        }
    }
}

fn between(table: &[[f64; 2]], frequency: f64) -> f64 {
    let after = table.partition_point(|[at, _]| *at < frequency);
    match (
        after.checked_sub(1).map(|i| table[i]),
        table.get(after).copied(),
    ) {
        (Some([a, low]), Some([b, high])) => low + (high - low) * (frequency - a) / (b - a),
        (Some([_, ratio]), None) | (None, Some([_, ratio])) => ratio,
        (None, None) => 0.0,
    }
}

/// Viscous damping.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub enum Damping {
    /// None.
    #[default]
    None,
    /// A symmetric matrix.
    Matrix(SparseMatrix),
    /// A sum of multiples of mass and stiffness.
    Rayleigh {
        /// Times the mass matrix, in 1/time.
        mass: f64,
        /// Times the stiffness matrix, in time.
        stiffness: f64,
    },
    /// By modes. The vectors that a reduction keeps besides modes have the ratio of a mode of their frequency and place.
    Modal(Ratios),
}

impl Damping {
    /// One ratio for all modes.
    pub fn ratio(ratio: f64) -> Self {
        Self::Modal(Ratios::One(ratio))
    }
}

/// A skew-symmetric matrix beside the damping, times a value: `G` in `M q'' + (C + value G) q' + K q`.
#[derive(Debug, Clone, PartialEq)]
pub struct Gyroscopic {
    /// `G`
    pub matrix: SparseMatrix,
    /// The speed of rotation: a number, a parameter, or the frequency of the excitation.
    pub speed: Value,
}

/// What a load is proportional to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadKind {
    /// Its amplitude is a force.
    Force,
    /// Its amplitude is mass times eccentricity, and is multiplied by the square of the frequency of the excitation.
    Unbalance,
    /// The base moves with its amplitude along the direction, whose entries say how far coordinates move with the base; coordinates are
    /// relative to the base.
    Base,
    /// Its amplitude is an acceleration, as of gravity, along the direction.
    Acceleration,
}

/// A load.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    pub(crate) direction: Direction,
    pub(crate) kind: LoadKind,
    pub(crate) harmonic: u32,
    pub(crate) phase: f64,
    pub(crate) amplitude: Value,
}

impl Load {
    /// `amplitude * cos(omega t)` of this kind.
    pub fn new(kind: LoadKind, direction: Direction, amplitude: impl Into<Value>) -> Self {
        Self {
            direction,
            kind,
            harmonic: 1,
            phase: 0.0,
            amplitude: amplitude.into(),
        }
    }

    /// A force `amplitude * cos(omega t)`.
    pub fn force(direction: Direction, amplitude: impl Into<Value>) -> Self {
        Self::new(LoadKind::Force, direction, amplitude)
    }

    /// Of this multiple of the frequency of the excitation; zero does not change with time.
    #[must_use]
    pub fn harmonic(mut self, harmonic: u32) -> Self {
        self.harmonic = harmonic;
        self
    }

    /// A phase in radians: `amplitude * cos(harmonic omega t + phase)`.
    #[must_use]
    pub fn phase(mut self, phase: f64) -> Self {
        self.phase = phase;
        self
    }
}

/// A law at work in a structure, and where.
#[derive(Debug, Clone)]
pub struct SparseContact {
    pub(crate) name: String,
    pub(crate) law: Arc<dyn Law>,
    pub(crate) arguments: Vec<Value>,
    pub(crate) gap: Direction,
    pub(crate) force: Option<Direction>,
    /// Towards which direction, and how, that of gap and force turns.
    pub(crate) turning: Option<(Direction, Turn)>,
    pub(crate) offset: Value,
}

impl SparseContact {
    /// A law whose gap is along a direction. Its force is an output of this name.
    pub fn new(name: &str, law: Arc<dyn Law>, gap: Direction) -> Self {
        Self {
            name: name.to_owned(),
            law,
            arguments: Vec::new(),
            gap,
            force: None,
            turning: None,
            offset: 0.0.into(),
        }
    }

    /// The arguments of the law, in its order.
    #[must_use]
    pub fn arguments(mut self, arguments: impl IntoIterator<Item = impl Into<Value>>) -> Self {
        self.arguments = arguments.into_iter().map(Into::into).collect();
        self
    }

    /// A direction of the force that differs from that of the gap.
    #[must_use]
    pub fn force_direction(mut self, direction: Direction) -> Self {
        self.force = Some(direction);
        self
    }

    /// The direction of gap and force turns from that of the gap towards this one: it is `cos(angle) gap + sin(angle) across`, with the angle that
    /// a [`Turn`] has. No other direction of the force can be given then.
    ///
    /// ```
    /// use std::sync::Arc;
    ///
    /// use hertzian::structure::Turn;
    /// use hertzian_structure::{Direction, SparseContact};
    ///
    /// hertzian::law! {
    ///     Ball(gap) { gap > 0 => gap^1.5, else => 0 }
    /// }
    ///
    /// // The balls of a bearing between the coordinates 0, downwards, and 1, across.
    /// let balls = (0..8).map(|ball| {
    ///     let turn = Turn::by(2, 5).from(std::f64::consts::TAU / 8.0 * f64::from(ball));
    ///     let contact = SparseContact::new(&format!("ball{ball}"), Arc::new(Ball), Direction::at(0));
    ///     contact.turning(Direction::at(1), turn).offset(0.1)
    /// });
    /// assert_eq!(balls.count(), 8);
    /// ```
    #[must_use]
    pub fn turning(mut self, across: Direction, turn: Turn) -> Self {
        self.turning = Some((across, turn));
        self
    }

    /// The direction of the force; of one that turns that towards which it does.
    pub(crate) fn second(&self) -> &Direction {
        let across = self.turning.as_ref().map(|(across, _)| across);
        across.or(self.force.as_ref()).unwrap_or(&self.gap)
    }

    /// What is subtracted from the gap.
    #[must_use]
    pub fn offset(mut self, offset: impl Into<Value>) -> Self {
        self.offset = offset.into();
        self
    }
}

/// What an output takes along its direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OutputKind {
    /// Coordinates.
    #[default]
    Displacement,
    /// Their first derivatives by time.
    Rate,
    /// Their second derivatives by time, as the equations of motion give them: they jump where the force of a contact does.
    Acceleration,
}

impl OutputKind {
    /// How many derivatives by time it takes.
    pub(crate) fn derivatives(self) -> i32 {
        match self {
            Self::Displacement => 0,
            Self::Rate => 1,
            Self::Acceleration => 2,
        }
    }
}

/// An output: a linear combination of coordinates, of rates or of accelerations, by its name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Output {
    pub(crate) name: String,
    pub(crate) kind: OutputKind,
    pub(crate) direction: Direction,
    pub(crate) unit: String,
    pub(crate) documentation: String,
}

/// A linear structure of many coordinates with contacts.
///
/// ```text
/// M q'' + (C + sum_g s_g G_g) q' + K q + sum_c e_c phi_c(d_c . q - delta_c, (d_c . q)') = sum_l b_l              (1)
/// ```
///
/// where the directions `e_c = d_c` of a contact may turn.
#[derive(Debug, Clone)]
pub struct SparseStructure {
    pub(crate) name: String,
    pub(crate) mass: SparseMatrix,
    pub(crate) stiffness: SparseMatrix,
    pub(crate) damping: Damping,
    pub(crate) gyroscopic: Vec<Gyroscopic>,
    pub(crate) loads: Vec<Load>,
    pub(crate) contacts: Vec<SparseContact>,
    pub(crate) outputs: Vec<Output>,
    pub(crate) parameters: Vec<ParameterFacts>,
    pub(crate) force_unit: String,
}

impl SparseStructure {
    /// A structure of given mass and stiffness; nothing is checked before [`SparseStructure::check`].
    pub fn new(mass: SparseMatrix, stiffness: SparseMatrix) -> Self {
        Self {
            name: "structure".to_owned(),
            mass,
            stiffness,
            damping: Damping::None,
            gyroscopic: Vec::new(),
            loads: Vec::new(),
            contacts: Vec::new(),
            outputs: Vec::new(),
            parameters: Vec::new(),
            force_unit: String::new(),
        }
    }

    /// A name, for reports and pictures.
    #[must_use]
    pub fn name(mut self, name: &str) -> Self {
        name.clone_into(&mut self.name);
        self
    }

    /// Viscous damping.
    #[must_use]
    pub fn damping(mut self, damping: Damping) -> Self {
        self.damping = damping;
        self
    }

    /// A gyroscopic matrix and the speed that it is multiplied by.
    #[must_use]
    pub fn gyroscopic(mut self, gyroscopic: Gyroscopic) -> Self {
        self.gyroscopic.push(gyroscopic);
        self
    }

    /// A load.
    #[must_use]
    pub fn load(mut self, load: Load) -> Self {
        self.loads.push(load);
        self
    }

    /// A contact.
    #[must_use]
    pub fn contact(mut self, contact: SparseContact) -> Self {
        self.contacts.push(contact);
        self
    }

    /// An output of this name: the displacement along a direction.
    #[must_use]
    pub fn output(self, name: &str, direction: Direction) -> Self {
        self.output_of(name, OutputKind::Displacement, direction)
    }

    /// An output of this name: the displacement, the rate or the acceleration along a direction.
    ///
    /// ```
    /// use hertzian_structure::{Direction, OutputKind, SparseMatrix, SparseStructure};
    ///
    /// let one = || SparseMatrix::from_triplets(2, 2, [(0, 0, 1.0), (1, 1, 1.0)]);
    /// let apart = Direction::weighted([(1, 1.0), (0, -1.0)]);
    /// let structure = SparseStructure::new(one()?, one()?)
    ///     .output_of("closing", OutputKind::Rate, apart)
    ///     .unit("mm/s")
    ///     .about("how fast the masses part");
    /// # structure.check()?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn output_of(mut self, name: &str, kind: OutputKind, direction: Direction) -> Self {
        self.outputs.push(Output {
            name: name.to_owned(),
            kind,
            direction,
            unit: String::new(),
            documentation: String::new(),
        });
        self
    }

    /// What the output that was added last is; the first line is what charts say of it.
    #[must_use]
    pub fn about(mut self, documentation: &str) -> Self {
        if let Some(output) = self.outputs.last_mut() {
            documentation.clone_into(&mut output.documentation);
        }
        self
    }

    /// The unit of the output that was added last.
    #[must_use]
    pub fn unit(mut self, unit: &str) -> Self {
        if let Some(output) = self.outputs.last_mut() {
            unit.clone_into(&mut output.unit);
        }
        self
    }

    /// The unit of the forces of contacts.
    #[must_use]
    pub fn force_unit(mut self, unit: &str) -> Self {
        unit.clone_into(&mut self.force_unit);
        self
    }

    /// What is known of a parameter.
    #[must_use]
    pub fn parameter(mut self, facts: ParameterFacts) -> Self {
        self.parameters.push(facts);
        self
    }

    /// `M`
    pub fn mass(&self) -> &SparseMatrix {
        &self.mass
    }

    /// `K`
    pub fn stiffness(&self) -> &SparseMatrix {
        &self.stiffness
    }

    /// The parameter that all loads which change with time are proportional to; none where there is no such load, or they have others.
    pub fn drive(&self) -> Option<&str> {
        let changing = self.loads.iter().filter(|load| load.harmonic > 0);
        let mut names = changing.map(|load| load.amplitude.name());
        let first = names.next()??;
        names.all(|name| name == Some(first)).then_some(first)
    }

    /// How many coordinates it has.
    pub fn coordinates(&self) -> usize {
        self.mass.rows()
    }

    /// Whether matrices fit each other, are symmetric as they must be, and directions stand at coordinates that there are.
    ///
    /// # Errors
    /// The first thing that is wrong, with its numbers.
    pub fn check(&self) -> Result<(), StructureError> {
        let coordinates = self.coordinates();
        if coordinates == 0 {
            return Err(StructureError::Empty);
        }
        self.sized("mass", &self.mass)?;
        self.sized("stiffness", &self.stiffness)?;
        symmetric("mass", &self.mass, 1.0)?;
        symmetric("stiffness", &self.stiffness, 1.0)?;
        for coordinate in 0..coordinates {
            let mass = self.mass.get(coordinate, coordinate);
            if mass < 0.0 {
                return Err(StructureError::NegativeMass { coordinate, mass });
            }
        }
        self.check_damping()?;
        for gyroscopic in &self.gyroscopic {
            self.sized("gyroscopic", &gyroscopic.matrix)?;
            symmetric("gyroscopic", &gyroscopic.matrix, -1.0)?;
        }
        for (index, load) in self.loads.iter().enumerate() {
            self.directed(&load.direction, || format!("load {index}"))?;
            if !load.phase.is_finite() {
                return Err(StructureError::NotFinite {
                    what: format!("the phase of load {index}"),
                    value: load.phase,
                });
            }
        }
        for contact in &self.contacts {
            let of = || format!("contact `{}`", contact.name);
            self.directed(&contact.gap, of)?;
            self.directed(contact.second(), of)?;
            if contact.turning.is_some() && contact.force.is_some() {
                return Err(StructureError::TurningForce { what: of() });
            }
        }
        for output in &self.outputs {
            self.directed(&output.direction, || format!("output `{}`", output.name))?;
        }
        Ok(())
    }

    fn sized(&self, name: &'static str, matrix: &SparseMatrix) -> Result<(), StructureError> {
        let (rows, columns) = (matrix.rows(), matrix.columns());
        let coordinates = self.coordinates();
        if rows == coordinates && columns == coordinates {
            return Ok(());
        }
        Err(StructureError::Size {
            matrix: name,
            rows,
            columns,
            coordinates,
        })
    }

    fn check_damping(&self) -> Result<(), StructureError> {
        let numbers = match &self.damping {
            Damping::None => Vec::new(),
            Damping::Matrix(matrix) => {
                self.sized("damping", matrix)?;
                symmetric("damping", matrix, 1.0)?;
                Vec::new()
            }
            Damping::Rayleigh { mass, stiffness } => vec![*mass, *stiffness],
            Damping::Modal(ratios) => {
                if let Ratios::Table(table) = ratios
                    && !table.is_sorted_by(|a, b| a[0] < b[0])
                {
                    return Err(StructureError::Table);
                }
                ratios.numbers()
            }
        };
        let faulty = numbers.into_iter().find(|x| !(x.is_finite() && *x >= 0.0));
        faulty.map_or(Ok(()), |value| Err(StructureError::Damping { value }))
    }

    fn directed(
        &self,
        direction: &Direction,
        of: impl Fn() -> String,
    ) -> Result<(), StructureError> {
        let coordinates = self.coordinates();
        for &(coordinate, factor) in &direction.entries {
            if coordinate >= coordinates {
                return Err(StructureError::NoCoordinate {
                    what: of(),
                    coordinate,
                    coordinates,
                });
            }
            if !factor.is_finite() {
                return Err(StructureError::NotFinite {
                    what: format!("a factor of {}", of()),
                    value: factor,
                });
            }
        }
        if direction.entries.iter().all(|(_, factor)| *factor == 0.0) {
            return Err(StructureError::NoDirection { what: of() });
        }
        Ok(())
    }
}

fn symmetric(name: &'static str, matrix: &SparseMatrix, sign: f64) -> Result<(), StructureError> {
    let (row, column, off) = matrix.asymmetry(sign);
    let largest = matrix.largest();
    if off <= ROUNDING * largest {
        return Ok(());
    }
    Err(StructureError::Symmetry {
        matrix: name,
        kind: if sign > 0.0 {
            "symmetric"
        } else {
            "skew-symmetric"
        },
        row,
        column,
        value: matrix.get(row, column),
        mirrored: matrix.get(column, row),
    })
}
