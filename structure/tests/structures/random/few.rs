//! A structure by fewer modes than all, against the whole one.

use hertzian::{Branch, Complex, Point, Stability, Verdict};
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
        self.stability_of_reduced(&name, &truth, reduced, (few, point));
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

    /// The verdict that the reduction leaves, and multipliers to the error that it is stated to make of them.
    fn stability_of_reduced(
        &mut self,
        name: &str,
        truth: &Truth,
        reduced: &Reduced,
        (few, point): (&Branch, &Point),
    ) {
        let own = &point.stability;
        let stated = match reduced.stability_at(&self.sparse, few, point) {
            Ok(stated) => stated,
            Err(error) => return self.find(Kind::Refused, format!("{name}: {error}")),
        };
        let known = truth.elastic(own.rigid);
        let unsure = truth.multiplier_error;
        if matches!(Judged::of(own.verdict, &known, unsure), Judged::False(_)) {
            self.report
                .count("verdicts of reduced equations that are not those of the whole structure");
        }
        match Judged::of(stated.verdict, &known, unsure) {
            Judged::Undecided if own.verdict == Verdict::Undecided => {
                self.report.count("reduced verdicts undecided");
            }
            Judged::Undecided => self
                .report
                .count("reduced verdicts that the reduction leaves open"),
            Judged::Open => self
                .report
                .count("reduced verdicts that the truth leaves open"),
            Judged::Right => self.report.count("reduced verdicts that are right"),
            Judged::NoNumber => self.find(Kind::NoNumber, format!("{name}: multipliers")),
            Judged::False(exact) => {
                let largest = own.multipliers[0].norm();
                let text = format!(
                    "{name}: {}, |mu| {largest:.9} +- {:.1e}; it is {exact:.9}",
                    stated.verdict, stated.errors[0]
                );
                self.find(Kind::FalseReduced, text);
            }
        }
        self.multipliers_of_reduced(name, (&known, unsure), own, &stated.errors);
    }

    /// Of a reduced orbit, to known ones, and what these are known to.
    fn multipliers_of_reduced(
        &mut self,
        name: &str,
        (known, unsure): (&[Complex<f64>], f64),
        own: &Stability,
        errors: &[f64],
    ) {
        for (index, (mu, error)) in own.multipliers.iter().zip(errors).enumerate() {
            // Of a pair one is enough.
            if mu.im < 0.0 {
                continue;
            }
            if error.is_infinite() {
                self.report.count(if index < 2 {
                    "largest multipliers of reduced orbits without a bound"
                } else {
                    "other multipliers of reduced orbits without a bound"
                });
                continue;
            }
            let nearest = known.iter().map(|other| (other - mu).norm());
            let off = nearest.fold(f64::INFINITY, f64::min);
            let of = [off, error + own.error, unsure];
            self.ratio(("multipliers of reduced orbits", Kind::Reduced), name, of);
            if index < 2 {
                let largest = "largest multipliers of reduced orbits";
                self.ratio((largest, Kind::Reduced), name, of);
            }
        }
    }
}
