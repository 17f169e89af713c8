//! A structure: its matrices with all that acts on it and all that it is read by.

use hertzian::system::ParameterFacts;

use super::contact::SparseContact;
use super::damping::{Damping, Gyroscopic};
use super::direction::Direction;
use super::load::Load;
use super::output::{Output, OutputKind};
use crate::matrix::SparseMatrix;

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
}
