//! `--structure`: a structure of many coordinates from files, by few vectors.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use hertzian::System;
use hertzian::law::LawFacts;
use serde::Serialize;

use super::options::{By, Options};
use super::run::Failure;

/// A structure of many coordinates, and how it is reduced.
#[derive(Debug, Clone, PartialEq, Default, Args)]
pub struct StructureOptions {
    /// A structure of many coordinates, described by this file, which names its matrices, loads, contacts and outputs; it is reduced to
    /// few vectors, and what that changes is said
    #[arg(
        id = "structure",
        long = "structure",
        value_name = "FILE",
        conflicts_with_all = ["file", "one_sided", "continuous", "alpha", "zeta", "load", "drive", "search"]
    )]
    pub file: Option<PathBuf>,

    /// Keep so many modes of it [default: all up to sixteen times the highest frequency]
    #[arg(long, value_name = "COUNT", requires = "structure", value_parser = crate::misplaced::count)]
    pub modes: Option<usize>,

    /// And static vectors of so many steps; none are modes alone [default: as many as the compliance needs, to a millionth]
    #[arg(long, value_name = "COUNT", requires = "structure")]
    pub steps: Option<usize>,

    /// Keep the reduced structure in this file, and take it from there if it is one of the same structure
    #[arg(long, value_name = "FILE", requires = "structure")]
    pub reduced: Option<PathBuf>,
}

/// What the reduction has made of a structure, and what it changes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reduction {
    /// Coordinates of the structure.
    pub coordinates: usize,
    /// Modes that are kept.
    pub modes: usize,
    /// Static vectors besides.
    pub static_vectors: usize,
    /// Angular frequencies of all of them.
    pub frequencies: Vec<f64>,
    /// Angular frequencies with the error of the compliance there, relative to the largest one.
    pub compliance: Vec<[f64; 2]>,
    /// Of each output the largest change of a peak-to-peak along the branches, as a part of it.
    pub outputs: Vec<(String, f64)>,
    /// Of what `--plot` names of outputs the largest change along the branches, in its unit.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub measured: Vec<(String, f64)>,
    /// Of each output the largest change of a peak-to-peak at an event, as a part of it: errors that events state are those of the reduced structure.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<(String, f64)>,
    /// Verdicts on the whole structure.
    pub verdicts: Verdicts,
    /// The same of backbones.
    #[serde(skip_serializing_if = "OfBackbone::is_empty")]
    pub backbone: OfBackbone,
}

/// What the reduction changes of backbones.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct OfBackbone {
    /// The frequency of each orbit of free oscillation, as a part of it, at equal action.
    pub frequencies: Vec<f64>,
    /// Of each output the largest change of a peak-to-peak along phase resonance, as a part of it.
    pub outputs: Vec<(String, f64)>,
}

impl OfBackbone {
    fn is_empty(&self) -> bool {
        self.frequencies.is_empty() && self.outputs.is_empty()
    }
}

/// Orbits along branches by what is known of the stability of those of the whole structure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Verdicts {
    /// How many were looked at.
    pub looked_at: usize,
    /// How many of them are stable or unstable, whatever the reduction changes.
    pub decided: usize,
}

/// A structure as it is used.
pub struct Reduced {
    #[cfg(feature = "sparse")]
    whole: hertzian_structure::SparseStructure,
    #[cfg(feature = "sparse")]
    reduced: hertzian_structure::Reduced,
}

/// The options for whoever knows an oscillator from a file: a structure is one.
pub fn resolved(options: &Options) -> Options {
    let mut options = options.clone();
    if let Some(path) = &options.structure.file {
        options.model.file = Some(path.clone());
    }
    options
}

/// How orbits are computed where nothing was asked for: by shooting where all motions are known in closed form between switches, or where a force
/// jumps at a level, at which the contact equation may end a branch of many modes; else by the contact equation.
fn method(model: &dyn System) -> By {
    let laws = (0..model.facts().laws).map(|law| model.law(law).facts());
    let jumps = |law: &LawFacts| law.levels.iter().any(|level| level.force_jumps);
    let is_affine = |law: &LawFacts| law.pieces.iter().all(|piece| piece.affine);
    if laws.clone().all(is_affine) || laws.clone().any(jumps) {
        By::Shooting
    } else {
        By::ContactEquation
    }
}

/// The same with the accuracy asked of the first output, where nothing else was asked for: coordinates of a reduced structure are
/// amplitudes of its vectors.
pub fn completed(options: &Options, model: &dyn System) -> Options {
    let mut options = options.clone();
    let first = model.facts().outputs.first();
    if options.structure.file.is_some() && options.accuracy_of.is_none() {
        options.accuracy_of = first.map(|output| output.name.to_string());
    }
    if options.structure.file.is_some() && options.by.is_none() {
        options.by = Some(method(model));
    }
    options
}

/// Without the feature `sparse` there are no structures.
#[cfg(not(feature = "sparse"))]
mod sparse {
    use super::{Failure, OfBackbone, Options, Reduced, Reduction, Verdicts};
    use crate::response::backbone::Backbone;
    use crate::response::progress::Seen;
    use hertzian::{Branch, Cancel, System};

    /// No structure.
    ///
    /// # Errors
    /// Always.
    pub fn read(_: &Options, _: &Cancel) -> Result<(Box<dyn System>, Reduced), Failure> {
        let message =
            "this program was built without the feature `sparse`, which --structure needs";
        Err(Failure::Option(message.to_owned()))
    }

    impl Reduced {
        /// Nothing: there is no such structure.
        ///
        /// # Errors
        /// Never.
        pub fn of(
            &self,
            _: &Options,
            _: &[Branch],
            _: &Backbone,
            _: &Cancel,
            _: &mut Seen<'_>,
        ) -> Result<Reduction, Failure> {
            Ok(Reduction {
                coordinates: 0,
                modes: 0,
                static_vectors: 0,
                frequencies: Vec::new(),
                compliance: Vec::new(),
                outputs: Vec::new(),
                measured: Vec::new(),
                events: Vec::new(),
                verdicts: Verdicts::default(),
                backbone: OfBackbone::default(),
            })
        }

        /// None: there is no such structure.
        pub fn drive(&self) -> Option<&str> {
            None
        }

        /// None: there is no such structure.
        pub fn advice(&self, _: &Options) -> Option<String> {
            None
        }
    }
}

#[cfg(feature = "sparse")]
mod sparse {
    use hertzian::{Branch, Cancel, System, Verdict};
    use hertzian_structure::{self as structures, SparseStructure, file};

    use super::{Failure, OfBackbone, Options, Reduced, Reduction, Verdicts};
    use crate::response::backbone::Backbone;
    use crate::response::progress::Seen;

    /// Orbits of a branch at which the error of the reduction is looked at, besides its events.
    const LOOKED_AT: usize = 16;

    /// The structure, reduced, with its parameters set.
    ///
    /// # Errors
    /// If a file is at fault, or the structure cannot be reduced.
    pub fn read(options: &Options, cancel: &Cancel) -> Result<(Box<dyn System>, Reduced), Failure> {
        let path = options.structure.file.clone().unwrap_or_default();
        let whole = file::read(path).map_err(failure)?;
        let reduced = reduced(options, &whole, cancel)?;
        let mut model = reduced.structure(&whole)?;
        if !options.over_frequency() {
            // An unknown name is reported by the run itself.
            let _ = model.set(options.varied(), options.range.from);
        }
        for (name, value) in &options.model.set {
            model.set(name, *value)?;
        }
        Ok((Box::new(model), Reduced { whole, reduced }))
    }

    fn failure(error: impl std::fmt::Display) -> Failure {
        Failure::Option(error.to_string())
    }

    fn reduced(
        options: &Options,
        whole: &SparseStructure,
        cancel: &Cancel,
    ) -> Result<structures::Reduced, Failure> {
        let to = if options.over_frequency() {
            options.range.from.max(options.range.to)
        } else {
            options.model.frequency()
        };
        let own = &options.structure;
        let mut reduction = structures::Reduction::to(to).cancel(cancel);
        if let Some(modes) = own.modes {
            reduction = reduction.modes(modes);
        }
        if let Some(steps) = own.steps {
            reduction = reduction.steps(steps);
        }
        if let Some(path) = own.reduced.as_ref().filter(|path| path.exists()) {
            let at = |error| failure(format!("{}: {error}", path.display()));
            let kept = structures::Reduced::read(path).map_err(at)?;
            kept.is_of(whole)
                .and_then(|()| reduction.accepts(&kept))
                .map_err(at)?;
            return Ok(kept);
        }
        let described = own.file.clone().unwrap_or_default();
        let reduced = reduction
            .run(whole)
            .map_err(|error| failure(format!("{}: {error}", described.display())))?;
        if let Some(path) = &own.reduced {
            reduced.write(path).map_err(failure)?;
        }
        Ok(reduced)
    }

    /// The library says what is wrong with an orbit.
    fn unreadable(error: structures::ReducedError) -> Failure {
        match error {
            structures::ReducedError::Orbit(error) => Failure::Library(error),
            other => failure(other),
        }
    }

    /// What was found before it was cancelled is kept.
    fn kept<T>(found: Result<T, structures::ReducedError>) -> Result<Option<T>, Failure> {
        match found {
            Err(structures::ReducedError::Cancelled) => Ok(None),
            other => other.map(Some).map_err(unreadable),
        }
    }

    /// Largest errors of what has a name.
    #[derive(Default)]
    struct Largest(Vec<(String, f64)>);

    impl Largest {
        fn take(&mut self, name: &str, error: f64) {
            match self.0.iter_mut().find(|(known, _)| known == name) {
                Some((_, worst)) => *worst = worst.max(error),
                None => self.0.push((name.to_owned(), error)),
            }
        }
    }

    impl Reduced {
        /// What the reduction changes along branches, as far as it was not cancelled.
        ///
        /// # Errors
        /// If an orbit cannot be read.
        pub fn of(
            &self,
            options: &Options,
            branches: &[Branch],
            backbone: &Backbone,
            cancel: &Cancel,
            seen: &mut Seen<'_>,
        ) -> Result<Reduction, Failure> {
            let (mut outputs, mut measured) = (Largest::default(), Largest::default());
            let mut at_events = Largest::default();
            let mut verdicts = Verdicts::default();
            let step = |branch: &Branch| branch.points.len().div_ceil(LOOKED_AT).max(1);
            let all = branches
                .iter()
                .map(|branch| branch.points.len().div_ceil(step(branch)) + branch.events.len());
            let (all, mut done) = (all.sum(), 0);
            for branch in branches {
                let effects = self.reduced.effects(&self.whole, branch).cancel(cancel);
                let points = branch.points.iter().step_by(step(branch));
                let points = points.map(|point| (point, true));
                let events = branch.events.iter().map(|event| (&event.point, false));
                for (point, judged) in points.chain(events) {
                    let Some(at) = kept(effects.at(point))? else {
                        break;
                    };
                    if judged && let Some(stability) = kept(at.stability())? {
                        verdicts.looked_at += 1;
                        verdicts.decided += usize::from(stability.verdict != Verdict::Undecided);
                    }
                    let found = kept(at.errors())?.unwrap_or_default();
                    for found in found {
                        outputs.take(&found.name, found.error);
                        if !judged {
                            at_events.take(&found.name, found.error);
                        }
                        let asked = options.plot.iter();
                        for wanted in asked.filter(|wanted| wanted.name == found.name) {
                            if let Some(error) = found.of(wanted.measure) {
                                measured.take(&wanted.to_string(), error);
                            }
                        }
                    }
                    done += 1;
                    seen.reduced(done, all);
                }
            }
            let reduced = &self.reduced;
            Ok(Reduction {
                coordinates: reduced.coordinates(),
                modes: reduced.modes(),
                static_vectors: reduced.vectors() - reduced.modes(),
                frequencies: reduced.frequencies(),
                compliance: reduced.compliance_errors(),
                outputs: outputs.0,
                measured: measured.0,
                events: at_events.0,
                verdicts,
                backbone: self.of_backbone(backbone, cancel)?,
            })
        }

        fn of_backbone(&self, backbone: &Backbone, cancel: &Cancel) -> Result<OfBackbone, Failure> {
            let mut of = OfBackbone::default();
            let effects = |curve| self.reduced.effects(&self.whole, curve).cancel(cancel);
            if let Some(free) = &backbone.free {
                of.frequencies = kept(effects(free).frequencies())?.unwrap_or_default();
            }
            if let Some(resonance) = &backbone.resonance {
                let step = resonance.points.len().div_ceil(LOOKED_AT).max(1);
                let mut outputs = Largest::default();
                for point in resonance.points.iter().step_by(step) {
                    let found = kept(effects(resonance).errors(point))?.unwrap_or_default();
                    for of in &found {
                        outputs.take(&of.name, of.error);
                    }
                }
                of.outputs = outputs.0;
            }
            Ok(of)
        }

        /// The parameter that all loads that change with time are proportional to.
        pub fn drive(&self) -> Option<&str> {
            self.whole.drive()
        }

        /// What to do where the first orbit takes long: with fewer vectors it takes less.
        pub fn advice(&self, options: &Options) -> Option<String> {
            let (vectors, modes) = (self.reduced.vectors(), self.reduced.modes());
            let own = &options.structure;
            let by = match (own.modes, own.steps) {
                (None, None) => "--modes with fewer, or --steps 1,",
                (Some(_), None) => "fewer --modes, or --steps 1,",
                (None, Some(_)) => "--modes with fewer, or fewer --steps,",
                (Some(_), Some(_)) => "fewer --modes or --steps",
            };
            Some(format!(
                "the first orbit of {vectors} vectors, {modes} of them modes, takes long: {by} leave fewer, and the summary says what that changes"
            ))
        }
    }
}

pub use sparse::read;

impl Reduction {
    /// For people.
    pub fn summary(&self) -> String {
        let up_to = |least: f64| {
            let below = self.compliance.iter().filter(|[_, error]| *error <= least);
            below.map(|[frequency, _]| *frequency).next_back()
        };
        let right = up_to(1e-6).map_or_else(String::new, |frequency| {
            format!("; compliances to a millionth up to {frequency:.4}")
        });
        let mut text = format!(
            "reduction  {} modes and {} static vectors of {} coordinates{right}\n",
            self.modes, self.static_vectors, self.coordinates
        );
        for (name, error) in &self.outputs {
            // Writing to a string does not fail.
            let _ = writeln!(
                text,
                "error      of {name} by the reduction: at most {error:.0e} of its peak-to-peak"
            );
        }
        for (wanted, error) in &self.measured {
            let _ = writeln!(
                text,
                "error      of {wanted} by the reduction: at most {error:.0e}"
            );
        }
        for (name, error) in &self.events {
            let _ = writeln!(
                text,
                "events     are those of the reduced structure, with its errors: there the reduction changes peak-to-peak of {name} by at most {error:.0e} of it"
            );
        }
        let mut frequencies = self.backbone.frequencies.clone();
        frequencies.sort_by(f64::total_cmp);
        if let Some(worst) = frequencies.last() {
            let middle = frequencies[frequencies.len() / 2];
            let _ = writeln!(
                text,
                "error      of the frequency of free oscillation by the reduction: {middle:.0e} of it at half of the orbits, at most {worst:.0e}"
            );
        }
        for (name, error) in &self.backbone.outputs {
            let _ = writeln!(
                text,
                "error      of {name} in phase resonance by the reduction: at most {error:.0e} of its peak-to-peak"
            );
        }
        let Verdicts { looked_at, decided } = self.verdicts;
        let _ = writeln!(
            text,
            "stability  of the whole structure: decided at {decided} of {looked_at} orbits that were looked at"
        );
        text
    }
}
