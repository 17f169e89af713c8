//! Data, the curve of the fit, and residuals below.

use hertzian::chart::{Chart, Curve, Line, Page, Run, Series};

use crate::result::{Fitted, FittedSet, Part};

impl Fitted {
    /// A page of two charts for each thing that was measured: data with the curves of the fit, and below the residuals. Parts of a curve that no
    /// sweep can be on are dashed.
    pub fn picture(&self) -> Page {
        let mut kinds: Vec<(&str, &str)> = Vec::new();
        for set in &self.sets {
            let kind = (set.wanted.as_str(), set.varied[0].as_str());
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        let mut above = Page::new(kinds.len());
        let mut below = Page::new(kinds.len());
        for kind in kinds {
            let of_kind = |set: &&FittedSet| (set.wanted.as_str(), set.varied[0].as_str()) == kind;
            let sets: Vec<&FittedSet> = self.sets.iter().filter(of_kind).collect();
            above = above.chart(Self::data(&sets));
            below = below.chart(self.residuals(&sets));
        }
        above.page(below)
    }

    fn data(sets: &[&FittedSet]) -> Chart {
        let mut chart =
            labelled(Chart::new("Data and fit"), sets).y(with_unit(&sets[0].wanted, &sets[0].unit));
        let mut drawn: Vec<&[Part]> = Vec::new();
        for set in sets {
            // Sets of one curve draw it once.
            if !drawn.contains(&set.curve.as_slice()) {
                drawn.push(&set.curve);
                chart = chart.curve(Curve {
                    label: format!("fit, {}", set.name),
                    runs: runs(&set.curve),
                });
            }
        }
        for set in sets {
            let points: Vec<[f64; 2]> = set
                .values
                .iter()
                .map(|value| [value.place, value.value])
                .collect();
            chart = chart.markers(Series::new(set.name.clone(), points));
        }
        chart
    }

    fn residuals(&self, sets: &[&FittedSet]) -> Chart {
        let unit = if self.is_absolute {
            "in standard deviations"
        } else {
            "in units of their scatter"
        };
        let scale = if self.is_absolute || self.scatter == 0.0 {
            1.0
        } else {
            self.scatter
        };
        let mut chart =
            labelled(Chart::new("Residuals"), sets).y(format!("distance from the curve, {unit}"));
        let places = sets
            .iter()
            .flat_map(|set| set.values.iter().map(|value| value.place));
        let [low, high] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], place| {
            [low.min(place), high.max(place)]
        });
        for level in [-2.0, 0.0, 2.0] {
            chart = chart.reference(Series::new("", [[low, level], [high, level]]));
        }
        for set in sets {
            let points: Vec<[f64; 2]> = set
                .values
                .iter()
                .map(|value| [value.place, value.residual / scale])
                .collect();
            chart = chart.markers(Series::new(set.name.clone(), points));
        }
        chart
    }
}

fn labelled(chart: Chart, sets: &[&FittedSet]) -> Chart {
    let [varied, unit] = &sets[0].varied;
    let name = if varied == "omega" {
        "excitation frequency ω"
    } else {
        varied
    };
    chart.x(with_unit(name, unit))
}

fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() {
        name.to_owned()
    } else {
        format!("{name} [{unit}]")
    }
}

fn runs(curve: &[Part]) -> Vec<Run> {
    let runs = curve.iter().map(|part| Run {
        line: if part.may_be_stable {
            Line::Stable
        } else {
            Line::Unstable
        },
        points: part.points.clone(),
    });
    runs.collect()
}
