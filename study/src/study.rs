//! What a study is made of, put together step by step, and checked before anything is computed.

use std::sync::Arc;

use hertzian::observe::Wanted;
use hertzian::power::Instructions;
use hertzian::{EventKind, System, with_values};

use crate::checks::{at_key, check_request, kinds, signals, within};
use crate::design::{Designed, List};
use crate::error::StudyError;
use crate::folder::described;
use crate::names::Names;
use crate::pictures;
use crate::plan::{Format, InstructionSet, Keep, Picture, Plan, Request, Variants, What};
use crate::spread::Spread;
use crate::table::{Column, columns};

/// A study: a model, its variants, and what is computed of each.
///
/// ```
/// use hertzian_study::{Keep, Request, Spread, Study, Variants};
///
/// hertzian::oscillator! {
///     Stopped(x) {
///         param stop = 10 > 0;
///         param drive = 0.3;
///         law stop_force(gap) { gap > 0 => stop*gap, else => 0 }
///         ddot(x) + 0.1*dot(x) + x + stop_force(x - 1) = drive*cos(omega*t);
///     }
/// }
///
/// let variants = Variants::latin_hypercube(4).over("stop", Spread::normal(10.0, 1.0));
/// let study = Study::of(&Stopped::default())
///     .variants(variants)
///     .request(Request::response(0.8, 1.6))
///     .prepare()?;
/// for index in 0..study.count() {
///     for row in study.rows(index) {
///         println!("{row:?}");
///     }
/// }
/// # Ok::<(), hertzian_study::StudyError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Study {
    pub(crate) system: Arc<dyn System>,
    plan: Plan,
    model: String,
    table: Option<String>,
    pub(crate) constants: Vec<String>,
}

impl Study {
    /// Of this system: parameters that do not vary have the values that they have now.
    pub fn of(system: &dyn System) -> Self {
        let facts = system.facts();
        Self {
            plan: Plan {
                model: facts.name.to_string(),
                ..Plan::default()
            },
            model: format!("{}\n", facts.equation),
            system: system.shared(),
            table: None,
            constants: Vec::new(),
        }
    }

    /// Of a system, with everything that a study file says. `model` is the text of the declaration, and `table` that of the variants where
    /// the file has a list: both are kept with the results.
    pub fn planned(system: &dyn System, plan: Plan, model: &str, table: Option<String>) -> Self {
        Self {
            system: system.shared(),
            plan,
            model: model.to_owned(),
            table,
            constants: Vec::new(),
        }
    }

    /// Parameters of the study file that are written into the system already, and that it has not.
    #[must_use]
    pub fn constants(mut self, names: &[&str]) -> Self {
        self.constants = names.iter().map(|name| (*name).to_owned()).collect();
        self
    }

    /// The variants.
    #[must_use]
    pub fn variants(mut self, variants: Variants) -> Self {
        self.plan.variants = variants;
        self
    }

    /// The variants as the rows of a table with commas, whose first line has the names of the parameters.
    #[must_use]
    pub fn table(mut self, text: impl Into<String>) -> Self {
        self.plan.variants = Variants::list();
        self.table = Some(text.into());
        self
    }

    /// What is computed of each.
    #[must_use]
    pub fn request(mut self, request: Request) -> Self {
        self.plan.request = request;
        self
    }

    /// What is kept of that.
    #[must_use]
    pub fn keep(mut self, keep: Keep) -> Self {
        self.plan.keep = keep;
        self
    }

    /// Pictures of the table.
    #[must_use]
    pub fn pictures(mut self, pictures: impl IntoIterator<Item = Picture>) -> Self {
        self.plan.pictures = pictures.into_iter().collect();
        self
    }

    /// Forms in which the table is written. Default: with commas.
    #[must_use]
    pub fn formats(mut self, formats: impl IntoIterator<Item = Format>) -> Self {
        self.plan.formats = formats.into_iter().collect();
        self
    }

    /// What random numbers follow from. Default: 1.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.plan.seed = seed;
        self
    }

    /// So many variants are kept in one file. Default: a quarter of the root of their number.
    #[must_use]
    pub fn block(mut self, variants: usize) -> Self {
        self.plan.block = Some(variants);
        self
    }

    /// The instruction set that the numbers belong to. Default: the last that the processor has.
    #[must_use]
    pub fn instructions(mut self, set: Instructions) -> Self {
        self.plan.instructions = Some(set.into());
        self
    }

    /// Checks everything that can be checked before a variant is computed.
    ///
    /// # Errors
    /// What cannot be used.
    pub fn prepare(&self) -> Result<Prepared, StudyError> {
        Prepared::new(self)
    }
}

/// A study that has been checked: what its variants are, and what is computed of each.
#[derive(Debug, Clone)]
pub struct Prepared {
    pub(crate) plan: Plan,
    pub(crate) model: String,
    /// The plan as the study file of its folder.
    pub(crate) described: String,
    pub(crate) table: Option<String>,
    pub(crate) designed: Designed,
    pub(crate) columns: Vec<Column>,
    /// Values of what varies along a branch that have rows.
    pub(crate) at: Vec<f64>,
    pub(crate) signals: Vec<Wanted>,
    pub(crate) largest: Vec<Wanted>,
    /// What places of events are differentiated by.
    pub(crate) by: Vec<String>,
    kinds: Option<Vec<EventKind>>,
    /// With the values that do not vary.
    pub(crate) system: Arc<dyn System>,
    values: Vec<f64>,
    /// The place of what varies among the parameters; that of the frequency is beyond them.
    places: Vec<usize>,
    block: usize,
}

impl Prepared {
    fn new(study: &Study) -> Result<Self, StudyError> {
        let mut plan = study.plan.clone();
        let names = Names::of(&*study.system, &plan);
        let list = study.table.as_deref().map(List::parse).transpose()?;
        let values = names.held(study, &plan)?;
        let order = |name: &str| names.place(name).unwrap_or(usize::MAX);
        for name in plan.variants.over.keys() {
            names.varies(&format!("variants.over.{name}"), name, &plan)?;
        }
        for name in list.iter().flat_map(|list| &list.names) {
            names.varies("variants.file", name, &plan)?;
        }
        let designed = Designed::new(&plan.variants, plan.seed, order, list)?;
        for (name, value) in designed.known(&plan.variants) {
            names.admits(&format!("variants.over.{name}"), name, value)?;
        }
        names.complete(&values, &designed.names, &plan)?;
        plan.instructions = Some(pinned(plan.instructions)?);
        let block = block(&plan, designed.count)?;
        plan.block = Some(block);
        check_request(&plan)?;
        if plan.request.what == What::Solutions && !names.has_another(&plan.request.vary) {
            let message =
                "solutions need a model with a parameter that does not vary along a branch";
            return Err(StudyError::value("request.what", message));
        }
        let at = match plan.request.what {
            What::Solutions => plan.request.at.as_ref(),
            _ => plan.keep.at.as_ref(),
        };
        let at = at.map(Spread::side).transpose();
        let at = at.map_err(|message| StudyError::value(at_key(plan.request.what), message))?;
        let at = within(at.unwrap_or_default(), &plan)?;
        let [signals, largest] = signals(&study.system, &plan)?;
        plan.keep.signals = Some(signals.iter().map(ToString::to_string).collect());
        let shown: Vec<String> = signals.iter().map(ToString::to_string).collect();
        let places = designed.names.iter().map(|name| order(name)).collect();
        let by = if plan.keep.sensitivities {
            names.besides(&plan.request.vary)
        } else {
            Vec::new()
        };
        let prepared = Self {
            columns: columns(plan.request.what, &designed.names, &shown, &by),
            by,
            kinds: kinds(&plan.keep)?,
            system: Arc::clone(&study.system),
            model: study.model.clone(),
            described: described(&plan, study.table.is_some())?,
            table: study.table.clone(),
            plan,
            designed,
            at,
            signals,
            largest,
            values,
            places,
            block,
        };
        pictures::check(&prepared)?;
        Ok(prepared)
    }

    /// How many variants there are.
    pub fn count(&self) -> usize {
        self.designed.count
    }

    /// How many variants are kept in one file.
    pub fn block(&self) -> usize {
        self.block
    }

    /// How many of these there are.
    pub fn blocks(&self) -> usize {
        self.count().div_ceil(self.block)
    }

    /// Names of what varies from variant to variant, in the order of the declaration.
    pub fn names(&self) -> &[String] {
        &self.designed.names
    }

    /// The values of a variant, by its number from zero on; empty of one that is not there.
    pub fn values(&self, index: usize) -> Vec<f64> {
        if index < self.count() {
            self.designed.values(index)
        } else {
            Vec::new()
        }
    }

    /// The columns of the table.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// What was asked for, with all defaults.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The system of a variant, and the frequency where a parameter is followed.
    pub(crate) fn variant(&self, index: usize) -> (Arc<dyn System>, Option<f64>) {
        self.with(self.designed.values(index))
    }

    /// The same, with its frequency, at values of what varies along the branches and of the only thing that varies besides.
    pub(crate) fn at_both(&self, [along, other]: [f64; 2]) -> (Arc<dyn System>, f64) {
        let (system, omega) = self.with(vec![other]);
        let mut values = vec![0.0; self.values.len()];
        system.values(&mut values);
        let mut parameters = self.system.facts().parameters.iter();
        match parameters.position(|facts| facts.name == self.plan.request.vary) {
            Some(place) => {
                values[place] = along;
                let system = with_values(&self.system, values);
                (system, omega.unwrap_or(f64::NAN))
            }
            None => (system, along),
        }
    }

    /// The same at values of what varies from variant to variant.
    fn with(&self, varying: Vec<f64>) -> (Arc<dyn System>, Option<f64>) {
        let mut values = self.values.clone();
        let mut omega = self.plan.request.omega;
        for (place, value) in self.places.iter().zip(varying) {
            match values.get_mut(*place) {
                Some(of_parameter) => *of_parameter = value,
                None => omega = Some(value),
            }
        }
        (with_values(&self.system, values), omega)
    }

    /// The name and the value of something besides what varies along a branch: with the frequency, or without a parameter, that.
    pub(crate) fn second(&self, system: &dyn System) -> (&str, f64) {
        let along = &self.plan.request.vary;
        let mut values = vec![0.0; self.values.len()];
        system.values(&mut values);
        let parameters = self.system.facts().parameters.iter().zip(values);
        let mut others = parameters.filter(|(facts, _)| facts.name != *along);
        others.next().map_or(("omega", f64::NAN), |(facts, value)| {
            (facts.name.as_ref(), value)
        })
    }

    /// The study of one variant, with these values, and of how its events move with them; nothing else is kept.
    pub(crate) fn middle(&self, values: Vec<f64>) -> Self {
        let by = self.designed.names.clone();
        Self {
            columns: columns(self.plan.request.what, &by, &[], &by),
            designed: self.designed.one(values),
            at: Vec::new(),
            signals: Vec::new(),
            largest: Vec::new(),
            by,
            ..self.clone()
        }
    }

    /// Whether an event has a row.
    pub(crate) fn keeps(&self, kind: EventKind) -> bool {
        let kinds = self.kinds.as_ref();
        kinds.is_none_or(|kinds| kinds.iter().any(|kept| kept.is_like(kind)))
    }
}

/// The instruction set, which is in use from now on.
fn pinned(asked: Option<InstructionSet>) -> Result<InstructionSet, StudyError> {
    let Some(set) = asked else {
        return Ok(Instructions::in_use().into());
    };
    let pinned = Instructions::from(set);
    match pinned.initialise() {
        Ok(found) if found == pinned => Ok(set),
        Ok(found) | Err(found) => Err(StudyError::Instructions { pinned, found }),
    }
}

/// Variants of a block.
fn block(plan: &Plan, count: usize) -> Result<usize, StudyError> {
    match plan.block {
        Some(0) => Err(StudyError::value(
            "block",
            "a block has at least one variant",
        )),
        Some(block) => Ok(block.min(count)),
        None => Ok((((count as f64).sqrt() / 4.0).round() as usize).max(1)),
    }
}
