//! A structure by fewer modes than all, against the whole one.

use hertzian::{Branch, Point, Stability};
use hertzian_structure::{Reduced, Reduction};

use super::judge::{Asked, Case, Judged, ORBITS, Whole, of_one, said};
use super::report::Kind;
use super::truth::Truth;

impl Case {
    /// Fewer modes than all, against the whole structure.
    pub fn reduced(&mut self, whole: &Whole, branch: &Branch) {
        let n = self.drawn.size();
        let kept = self.drawn.rigid + 1 + self.random.below(n - 1 - self.drawn.rigid.min(n - 2));
        let reduction = Reduction::to(self.highest()).modes(kept.min(n - 1));
        let reduction = match self.random.below(3) {
            0 => reduction.steps(1),
            1 => reduction.steps(2),
            _ => reduction,
        };
        let reduced = match reduction.run(&self.sparse) {
            Ok(reduced) => reduced,
            Err(error) => return self.find(Kind::Refused, format!("reduced: {error}")),
        };
        if reduced.vectors() == n {
            self.report.count("reductions that leave nothing out");
            return;
        }
        let model = match reduced.structure(&self.sparse) {
            Ok(model) => model,
            Err(error) => return self.find(Kind::Refused, format!("reduced: {error}")),
        };
        let asked = if self.drawn.held {
            Asked::Tip
        } else {
            Asked::Modes
        };
        let Some(few) = self.branch(&model, asked) else {
            return;
        };
        for index in self.chosen(&few, ORBITS[1]) {
            self.report.count("reduced orbits");
            self.of_reduced(whole, branch, &reduced, (&few, &few.points[index]));
        }
    }

    fn of_reduced(
        &mut self,
        whole: &Whole,
        branch: &Branch,
        reduced: &Reduced,
        (few, point): (&Branch, &Point),
    ) {
        let size = |branch: &Branch, point: &Point| {
            let tip = branch.reading("tip", point);
            tip.map_or(f64::NAN, |tip| tip.motion.peak_to_peak())
        };
        // The orbit of the same place among those at this frequency.
        let of = |branch: &Branch| {
            let mut points = branch.at(point.value).unwrap_or_default();
            points.sort_by(|a, b| size(branch, a).total_cmp(&size(branch, b)));
            points
        };
        let (theirs, own) = (of(branch), of(few));
        let tip = size(few, point);
        let place = hertzian_tests::nearest(0..own.len(), tip, |i: &usize| size(few, &own[*i]));
        let Some(place) = place.filter(|_| own.len() == theirs.len()) else {
            self.report
                .count("reduced orbits where the whole structure has others");
            return;
        };
        let Some(truth) = self.truth(whole, &theirs[place]) else {
            return;
        };
        let name = format!(
            "{} of {} vectors by {} at {:?}",
            reduced.vectors(),
            self.drawn.size(),
            said(few),
            point.value
        );
        self.verdict_of_reduced(&name, &truth, &point.stability);
        let errors = match reduced.errors_at(&self.sparse, few, point) {
            Ok(errors) => errors,
            Err(error) => return self.find(Kind::Refused, format!("{name}: {error}")),
        };
        let Some(stated) = self.stated(&name, point) else {
            self.report.count("reduced orbits without a stated error");
            return;
        };
        if errors[0].error.is_infinite() {
            return self
                .report
                .count("reduced orbits without a bound of what the reduction changes");
        }
        let stated = stated + errors[0].error;
        let of = of_one(
            tip,
            &truth,
            self.drawn.size(),
            [stated, self.drawn.tip.abs().sum()],
        );
        self.ratio(("reduced orbits", Kind::Reduced), &name, of);
    }

    fn verdict_of_reduced(&mut self, name: &str, truth: &Truth, stability: &Stability) {
        let known = truth.elastic(stability.rigid);
        self.report.count(
            match Judged::of(stability.verdict, &known, truth.multiplier_error) {
                Judged::Undecided => "reduced verdicts undecided",
                Judged::Open => "reduced verdicts that the truth leaves open",
                Judged::Right => "reduced verdicts that are right",
                Judged::NoNumber => {
                    return self.find(Kind::NoNumber, format!("{name}: multipliers"));
                }
                Judged::False(exact) => {
                    let largest = stability.multipliers[0].norm();
                    let text = format!(
                        "{name}: {}, |mu| {largest:.9} +- {:.1e}; it is {exact:.9}",
                        stability.verdict, stability.error
                    );
                    return self.find(Kind::FalseReduced, text);
                }
            },
        );
    }
}
