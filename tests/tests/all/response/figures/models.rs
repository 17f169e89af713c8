//! The two oscillators of the paper, and its figures: where each is swept, and what is known of it.

use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, OnceLock};

use hertzian::{Event, FrequencyResponse, Stop, System};
pub use hertzian_tests::{Continuous, OneSided};

use super::exact::{self, Exact};

/// A sweep of the frequency, with the folds that it passes in order of frequency.
#[derive(Debug, Clone, Copy)]
pub struct Figure {
    pub name: &'static str,
    pub one_sided: bool,
    pub alpha: f64,
    pub load: f64,
    pub from: f64,
    pub to: f64,
    pub folds: &'static [Exact],
}

pub const FIGURE_2A: Figure = Figure {
    name: "2a",
    one_sided: false,
    alpha: 1.5,
    load: 0.0,
    from: 0.6,
    to: 1.7,
    folds: &exact::FIGURE_2A,
};
/// Superharmonic resonances of 2a.
pub const FIGURE_2A_BELOW: Figure = Figure {
    name: "2a below",
    from: 0.2,
    to: 0.7,
    folds: &exact::FIGURE_2A_BELOW,
    ..FIGURE_2A
};
pub const FIGURE_2B: Figure = Figure {
    name: "2b",
    alpha: 0.6,
    from: 0.66,
    to: 1.4,
    folds: &exact::FIGURE_2B,
    ..FIGURE_2A
};
/// Superharmonic resonances of 2b.
pub const FIGURE_2B_BELOW: Figure = Figure {
    name: "2b below",
    from: 0.37,
    to: 0.7,
    folds: &exact::FIGURE_2B_BELOW,
    ..FIGURE_2B
};
pub const FIGURE_4A_LOAD_1: Figure = Figure {
    name: "4a, load 1",
    load: 1.0,
    from: 0.7,
    to: 1.7,
    folds: &exact::FIGURE_4A_LOAD_1,
    ..FIGURE_2A
};
pub const FIGURE_4A_LOAD_5: Figure = Figure {
    name: "4a, load 5",
    load: 5.0,
    from: 1.0,
    to: 2.2,
    folds: &exact::FIGURE_4A_LOAD_5,
    ..FIGURE_2A
};
pub const FIGURE_5A: Figure = Figure {
    name: "5a",
    one_sided: true,
    alpha: 1.0,
    load: 1.0,
    from: 0.6,
    to: 1.4,
    folds: &exact::FIGURE_5A,
};
pub const FIGURE_5B: Figure = Figure {
    name: "5b",
    alpha: 1.5,
    to: 1.6,
    folds: &exact::FIGURE_5B,
    ..FIGURE_5A
};
pub const FIGURE_5C: Figure = Figure {
    name: "5c",
    alpha: 0.6,
    from: 0.5,
    to: 1.2,
    folds: &exact::FIGURE_5C,
    ..FIGURE_5A
};

/// Folds that were found, by figure and harmonics.
type Found = Mutex<HashMap<String, Arc<OnceLock<Vec<Event>>>>>;

static FOUND: LazyLock<Found> = LazyLock::new(Found::default);

impl Figure {
    /// Damping ratio: the paper has one for each oscillator.
    pub fn zeta(&self) -> f64 {
        if self.one_sided { 0.032 } else { 0.01 }
    }

    pub fn model(&self) -> Box<dyn System> {
        let (zeta, alpha, load, drive) = (self.zeta(), self.alpha, self.load, 0.1);
        if self.one_sided {
            Box::new(OneSided {
                zeta,
                alpha,
                load,
                drive,
            })
        } else {
            Box::new(Continuous {
                zeta,
                alpha,
                load,
                drive,
            })
        }
    }

    pub fn request(&self, model: &dyn System) -> FrequencyResponse {
        FrequencyResponse::of(model).from(self.from).to(self.to)
    }

    /// The folds of a sweep that reaches its end and turns nowhere else, in order of frequency.
    pub fn folds(&self, set: impl FnOnce(FrequencyResponse) -> FrequencyResponse) -> Vec<Event> {
        let model = self.model();
        let request = set(self.request(&*model)).stability(false);
        let branch = request.run().unwrap();
        assert_eq!(branch.stopped, Stop::ReachedEnd, "{self:?}");
        assert!(branch.turns.is_empty(), "{self:?} {:?}", branch.turns);
        let mut folds: Vec<_> = branch.folds().cloned().collect();
        folds.sort_by(|a, b| a.point.value.total_cmp(&b.point.value));
        folds
    }

    /// The folds with so many harmonics, or at the tolerance alone: several tests judge the same, which are computed once.
    pub fn folds_with(&self, harmonics: Option<usize>) -> Vec<Event> {
        let key = format!("{self:?} {harmonics:?}");
        let found = Arc::clone(FOUND.lock().unwrap().entry(key).or_default());
        let folds = found.get_or_init(|| {
            self.folds(|request| match harmonics {
                Some(harmonics) => request.harmonics(harmonics),
                None => request,
            })
        });
        folds.clone()
    }

    /// As many folds as are known, with true error and the error stated.
    pub fn errors(&self, harmonics: Option<usize>) -> Vec<(f64, f64)> {
        let folds = self.folds_with(harmonics);
        assert_eq!(
            folds.len(),
            self.folds.len(),
            "{} at {harmonics:?}: {folds:?}",
            self.name
        );
        let pairs = folds.iter().zip(self.folds);
        pairs
            .map(|(fold, exact)| ((fold.point.value - exact.omega).abs(), fold.error))
            .collect()
    }
}
