//! What is the same for all orbits of a branch: the system, what is varied, and what unknowns count from.

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use crate::cancel::Cancel;
use crate::contact_equation::linear_part::configuration::Configuration;
use crate::contact_equation::linear_part::contact::Contact;
use crate::contact_equation::linear_part::moving_stiffness::as_contacts;
use crate::contact_equation::linear_part::values::Values;
use crate::contact_equation::skeleton::Skeleton;
use crate::contact_equation::skeleton::placement::Resolution;
use crate::laws::generic::scales::Scales;
use crate::model::layout::Layout;
use crate::system::{System, Variable};

/// Frequencies at which coefficients are compared, in parts of the one where they are known.
const OTHERS: [f64; 2] = [0.618, 1.414];

/// What is the same for all orbits of a branch.
#[derive(Clone)]
pub(in crate::contact_equation) struct Setting {
    pub(in crate::contact_equation) system: Arc<dyn System>,
    pub(in crate::contact_equation) layout: Arc<Layout>,
    pub(in crate::contact_equation) variable: Variable,
    pub(in crate::contact_equation) parameters: Vec<f64>,
    /// Unless it is varied.
    pub(in crate::contact_equation) omega: f64,
    pub(in crate::contact_equation) cancel: Cancel,
    /// Nothing but the time depends on the frequency that is varied.
    pub(in crate::contact_equation) plain: bool,
    /// Operands of the laws whose functions may be sharp, and, per contact, whether its law may have narrow places, where nothing that its arguments
    /// depend on is varied.
    scales: Arc<[Option<Scales>]>,
    narrow: Arc<OnceLock<Vec<bool>>>,
    /// The system at one frequency, if so.
    known: Arc<OnceLock<Option<Values>>>,
}

impl Setting {
    pub(in crate::contact_equation) fn new(
        system: &Arc<dyn System>,
        variable: Variable,
        parameters: Vec<f64>,
        omega: f64,
        cancel: &Cancel,
    ) -> Self {
        let mut layout = Layout::of(system.as_ref());
        let system = as_contacts(system, &mut layout);
        let mut by = vec![0.0; layout.coefficients];
        system.coefficients_by(Variable::Omega, &parameters, omega, &mut by);
        let at = |omega: f64| {
            let mut coefficients = vec![0.0; layout.coefficients];
            system.coefficients(&parameters, omega, &mut coefficients);
            coefficients
        };
        // One may be flat at this frequency alone.
        let same = OTHERS.iter().all(|part| at(part * omega) == at(omega));
        let scales = (0..system.facts().laws).map(|law| Scales::of(system.law(law)));
        Self {
            scales: scales.collect(),
            narrow: Arc::default(),
            system,
            layout: Arc::new(layout),
            variable,
            plain: variable == Variable::Omega && same && by.iter().all(|x| *x == 0.0),
            parameters,
            omega,
            cancel: cancel.clone(),
            known: Arc::default(),
        }
    }

    /// Whether panels may have to end between switches: where slopes of forces jump on pieces, or turn sharply.
    pub(in crate::contact_equation) fn may_have_ends(&self, values: &Values) -> bool {
        let mut known = self.scales.iter().flatten();
        known.any(Scales::bends_anywhere) || self.are_narrow(values).iter().any(|is| *is)
    }

    /// The operands of a law whose force has kinks on a piece.
    pub(in crate::contact_equation) fn kinked(&self, law: usize, piece: usize) -> Option<Scales> {
        let scales = self.scales.get(law)?.as_ref();
        scales.filter(|scales| scales.bends(piece)).cloned()
    }

    /// The operands of the law of a contact that may have narrow places.
    pub(in crate::contact_equation) fn sharp(
        &self,
        values: &Values,
        contact: usize,
    ) -> Option<Scales> {
        let is_narrow = self.is_narrow(values, contact);
        let law = values.contacts.get(contact).filter(|_| is_narrow)?.law;
        self.scales.get(law)?.clone()
    }

    /// Whether that of a contact may have some.
    pub(in crate::contact_equation) fn is_narrow(&self, values: &Values, contact: usize) -> bool {
        self.are_narrow(values).get(contact) == Some(&true)
    }

    fn are_narrow(&self, values: &Values) -> Cow<'_, [bool]> {
        let found = || -> Vec<bool> {
            let is_narrow = |contact: &Contact| {
                let scales = self.scales.get(contact.law).and_then(Option::as_ref);
                scales.cloned().is_some_and(|mut scales| {
                    scales.set(&contact.arguments, &contact.levels);
                    scales.may_be_narrow()
                })
            };
            values.contacts.iter().map(is_narrow).collect()
        };
        if self.plain {
            Cow::Borrowed(self.narrow.get_or_init(found))
        } else {
            Cow::Owned(found())
        }
    }

    /// Parameters and frequency where what is varied has a value.
    pub(in crate::contact_equation) fn at(&self, value: f64) -> (Vec<f64>, f64) {
        let mut parameters = self.parameters.clone();
        match self.variable {
            Variable::Omega => (parameters, value),
            Variable::Parameter(index) => {
                parameters[index] = value;
                (parameters, self.omega)
            }
        }
    }

    /// The system there.
    pub(in crate::contact_equation) fn values(&self, value: f64) -> Option<Values> {
        if !self.plain {
            return self.made(value);
        }
        let known = self.known.get_or_init(|| {
            let mut values = self.made(value)?;
            values.changes = false;
            Some(values)
        });
        let mut values = known.clone()?;
        values.set_omega(value, f64::from(self.system.facts().divisor));
        Some(values)
    }

    fn made(&self, value: f64) -> Option<Values> {
        let (parameters, omega) = self.at(value);
        Values::new(self.system.as_ref(), &self.layout, &parameters, omega)
    }

    /// The configurations of a skeleton at values; `None` where one has dependent eigenvectors.
    pub(in crate::contact_equation) fn configurations(
        &self,
        values: &Values,
        skeleton: &Skeleton,
    ) -> Option<Vec<Configuration>> {
        let pieces = skeleton.configurations.iter();
        let of = |pieces: &Vec<usize>| Configuration::new(self.system.as_ref(), values, pieces);
        pieces.map(of).collect()
    }

    pub(super) fn at_omega(&self, value: f64) -> f64 {
        match self.variable {
            Variable::Omega => value,
            Variable::Parameter(_) => self.omega,
        }
    }
}

/// What the unknowns of a branch count from.
#[derive(Debug, Clone)]
pub(in crate::contact_equation) struct Frame {
    /// Positions and velocities.
    pub(in crate::contact_equation) reference: Vec<f64>,
    pub(in crate::contact_equation) size: f64,
    pub(in crate::contact_equation) resolution: Resolution,
}

#[cfg(test)]
mod tests {
    use super::*;

    crate::oscillator! {
        /// A spring that is softest at the frequency one.
        Flat(x) {
            law stop(gap) { gap > 0 => 2*gap, else => 0 }
            ddot(x) + 0.1*dot(x) + (1 + (omega - 1)^2)*x + stop(x - 0.3) = cos(omega*t);
        }
    }

    #[test]
    fn a_coefficient_that_is_flat_at_one_frequency_changes() {
        let system = Flat {}.shared();
        let setting = Setting::new(&system, Variable::Omega, vec![], 1.0, &Cancel::new());
        assert!(!setting.plain);
    }
}
