//! Residuals at values of the unknowns, and their derivatives.
//!
//! *Near* residuals are distances to the curve through the orbits that were followed, and that of the fold ahead from where the data leave a sheet, so
//! that a search far off sees what is seen at a glance: where the measured curve ends. *Exact* ones are taken from orbits that are computed at
//! the place of each foot: with the reading `y_f` and the slope `m` of the curve there, and the deviations `a` and `b`,
//!
//! ```text
//! r = (d_y - y_f - m (d_x - x_f)) / sqrt(b^2 + m^2 a^2),     dr/dp = - y_p / sqrt(b^2 + m^2 a^2)              (1)
//! ```
//!
//! which is the distance to the tangent at the foot. Derivatives of near residuals are exact at some orbits of each sheet; between these
//! `W = y_p x'` is a smooth function of the length along the curve, also at folds.

use nalgebra::DMatrix;

use crate::assign;
use crate::curve::Curve;
use crate::data::Sweep;
use crate::moves::{Along, chosen, splines};
use crate::path::{Foot, Path, Sheet};
use crate::problem::{Problem, Set};
use crate::result::Part;
use crate::spline::Spline;
use crate::turn;

/// A foot nearer to a fold than this part of the range is at it: there is no derivative at a fixed place.
const FROM_FOLD: f64 = 1e-6;
/// Of deviations along both axes, those of near residuals are at least this part of the range of a set.
const NEAR: f64 = 0.03;

/// A foot nearer to its datum than this part of the deviation of places is at the same place.
const OWN: f64 = 0.01;

/// How residuals are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum How {
    /// From the curve as it was followed, and by deviations that are at least a part of what was measured.
    Near,
    /// From orbits at the places of the data.
    Exact,
}

/// A data set beside its curve.
#[derive(Debug)]
struct Beside {
    paths: Vec<Path>,
    /// Sheets with the number of their path.
    sheets: Vec<(usize, Sheet)>,
    /// The sheet and the foot of each value.
    feet: Vec<(usize, Foot)>,
    /// The place of what is wanted in its group.
    wanted: usize,
    /// Exact: place, number of the orbit there, slope of the curve; nothing where the foot is at a fold.
    exact: Vec<Option<(f64, usize, f64)>>,
    /// The sheet that each jump ends, where there is one.
    jumps: Vec<Option<usize>>,
    /// Where the data leave a sheet, and that sheet.
    left: Option<(f64, usize)>,
}

/// Derivatives of residuals by the unknowns, a row for each.
#[derive(Debug)]
pub(crate) struct Jacobian {
    pub(crate) matrix: DMatrix<f64>,
    /// Rows that are not known, and zero: what of, and why.
    pub(crate) without: Vec<(usize, String)>,
}

/// Curves at values of the unknowns, and residuals.
#[derive(Debug)]
pub(crate) struct Trial {
    pub(crate) unknowns: Vec<f64>,
    pub(crate) how: How,
    pub(crate) residuals: Vec<f64>,
    /// Sum of the squares of the distances of all values from the curve as it was followed.
    pub(crate) distances: f64,
    /// Whether every residual is what is asked for: of a hopeless trial some are distances.
    pub(crate) is_complete: bool,
    /// The first residual of each set.
    pub(crate) first: Vec<usize>,
    curves: Vec<Curve>,
    beside: Vec<Beside>,
}

impl Trial {
    /// Once the sum of the squares of distances from the curve as it was followed is above a bound, no more orbits are computed: residuals are
    /// these distances then, and have no derivatives at their feet.
    ///
    /// # Errors
    /// Why the curves cannot be compared with the data.
    pub(crate) fn below(
        problem: &Problem,
        unknowns: &[f64],
        how: How,
        bound: f64,
    ) -> Result<Self, String> {
        let groups = 0..problem.groups.len();
        let curves = groups.map(|group| Curve::follow(problem, group, unknowns));
        let mut trial = Self {
            unknowns: unknowns.to_vec(),
            how,
            residuals: Vec::new(),
            distances: 0.0,
            is_complete: true,
            first: Vec::new(),
            curves: curves.collect::<Result<_, _>>()?,
            beside: Vec::new(),
        };
        for set in &problem.sets {
            trial.first.push(trial.residuals.len());
            let beside = trial.beside(problem, set, bound)?;
            trial.beside.push(beside);
        }
        if trial.residuals.iter().all(|residual| residual.is_finite()) {
            Ok(trial)
        } else {
            Err("a distance from the curve is no number".to_owned())
        }
    }

    /// Puts a set beside its curve, and appends its residuals.
    fn beside(&mut self, problem: &Problem, set: &Set, bound: f64) -> Result<Beside, String> {
        let wanted = problem.groups[set.group].wanted.iter();
        let wanted = wanted
            .clone()
            .position(|wanted| *wanted == set.wanted)
            .unwrap_or(0);
        let nodes = self.curves[set.group].nodes(wanted, set.wraps());
        let paths = nodes.into_iter().enumerate();
        let paths = paths.filter_map(|(branch, nodes)| Path::of(branch, nodes, set.size));
        let paths: Vec<Path> = paths.collect();
        let sheets = paths.iter().enumerate().flat_map(|(path, of)| {
            let sheets = of.sheets().into_iter();
            sheets.map(move |sheet| (path, sheet))
        });
        let sheets =
            sheets.filter(|(_, sheet)| sheet.may_be_stable || set.sweep == Sweep::Controlled);
        let sheets: Vec<(usize, Sheet)> = sheets.collect();
        if sheets.is_empty() {
            return Err(format!("{} is known of no orbit of the curve", set.wanted));
        }
        let all: Vec<Vec<Foot>> = (0..set.places.len())
            .map(|index| {
                let feet = sheets
                    .iter()
                    .map(|(path, sheet)| foot(&paths[*path], sheet, set, index, self.how));
                feet.collect()
            })
            .collect();
        let squares: Vec<Vec<f64>> = all
            .iter()
            .map(|feet| {
                feet.iter()
                    .map(|foot| foot.distance * foot.distance)
                    .collect()
            })
            .collect();
        let ranks: Vec<isize> = sheets
            .iter()
            .map(|(path, sheet)| self.curves[set.group].rank(paths[*path].branch, sheet))
            .collect();
        let assigned = assign::assigned(set.sweep, &ranks, &squares);
        let feet = assigned
            .iter()
            .zip(&all)
            .map(|(&sheet, feet)| (sheet, feet[sheet]));
        let mut beside = Beside {
            feet: feet.collect(),
            jumps: jumps(set, &sheets),
            left: left(set, &assigned),
            exact: Vec::new(),
            paths,
            sheets,
            wanted,
        };
        let distances = beside.feet.iter().map(|(_, foot)| foot.distance);
        self.distances += distances.clone().map(|r| r * r).sum::<f64>();
        if self.how == How::Near || self.distances > bound {
            self.is_complete &= self.how == How::Near;
            self.residuals.extend(distances);
        } else {
            self.exact(problem, set, &mut beside)?;
        }
        for (number, jump) in set.jumps.iter().enumerate() {
            let by = jump.deviation.max(self.least(set.size[0]));
            let apart = match beside.jumps[number] {
                Some(sheet) => one_sided(set, number, jump.value - beside.fold(set, sheet)),
                // A branch that does not end goes on far enough.
                None if jump.is_bound => 0.0,
                None => set.size[0],
            };
            self.residuals.push(apart / by);
        }
        if self.how == How::Near {
            let apart = beside
                .left
                .map_or(0.0, |(place, sheet)| place - beside.fold(set, sheet));
            self.residuals.push(apart / self.least(set.size[0]));
        }
        Ok(beside)
    }

    /// Deviations are not below this part of a size.
    fn least(&self, size: f64) -> f64 {
        match self.how {
            How::Near => NEAR * size,
            How::Exact => 0.0,
        }
    }

    /// The residuals (1) of a set.
    fn exact(&mut self, problem: &Problem, set: &Set, beside: &mut Beside) -> Result<(), String> {
        for (index, (sheet, foot)) in beside.feet.iter().enumerate() {
            let (path_number, sheet) = &beside.sheets[*sheet];
            let path = &beside.paths[*path_number];
            let Some(place) = stand(sheet, foot, set, index) else {
                self.residuals.push(foot.distance);
                beside.exact.push(None);
                continue;
            };
            let ([_, near], [dx, dy]) = path.at(path.along_at(sheet, place));
            let curve = &mut self.curves[set.group];
            let readings = curve.readings(problem, path.branch, place, beside.wanted)?;
            let turned = |reading: f64| {
                if set.wraps() {
                    turn::near(reading, near)
                } else {
                    reading
                }
            };
            let nearest = readings.iter().map(|&reading| turned(reading)).enumerate();
            let nearest = nearest.min_by(|a, b| (a.1 - near).abs().total_cmp(&(b.1 - near).abs()));
            let Some((number, reading)) = nearest.filter(|(_, reading)| reading.is_finite()) else {
                return Err(format!(
                    "no orbit was found at {} = {place}",
                    problem.groups[set.group].varied
                ));
            };
            let slope = dy / dx;
            let datum = if set.wraps() {
                turn::near(set.values[index], reading)
            } else {
                set.values[index]
            };
            let apart = datum - reading - slope * (set.places[index] - place);
            self.residuals.push(apart / across(set, index, slope));
            beside.exact.push(Some((place, number, slope)));
        }
        Ok(())
    }

    /// Derivatives of the residuals by the unknowns. A residual that has none, as where an orbit grazes beside a fold, is left out of them, and the
    /// others are enough.
    ///
    /// # Errors
    /// Why there are none at all.
    pub(crate) fn jacobian(&mut self, problem: &Problem) -> Result<Jacobian, String> {
        let count = problem.unknowns.len();
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(self.residuals.len());
        let mut without: Vec<(usize, String)> = Vec::new();
        let mut known = |row: Result<Vec<f64>, String>, of: &dyn Fn() -> String| {
            rows.push(row.unwrap_or_else(|reason| {
                without.push((rows.len(), format!("{}: {reason}", of())));
                vec![0.0; count]
            }));
        };
        for (number, set) in problem.sets.iter().enumerate() {
            let values = self.at_feet(problem, number, set);
            for row in self.between(problem, number, set, values) {
                known(row, &|| format!("values of {}", set.name));
            }
            let first = self.first[number] + set.places.len();
            for (jump, own) in set.jumps.iter().enumerate() {
                let by = own.deviation.max(self.least(set.size[0]));
                let is_met = own.is_bound && self.residuals[first + jump] == 0.0;
                let sheet = self.beside[number].jumps[jump].filter(|_| !is_met);
                let row = self.fold_row(problem, number, sheet, by);
                known(row, &|| format!("the jump of {}", set.name));
            }
            if self.how == How::Near {
                let sheet = self.beside[number].left.map(|(_, sheet)| sheet);
                let by = self.least(set.size[0]);
                let row = self.fold_row(problem, number, sheet, by);
                known(row, &|| format!("where {} leaves a sheet", set.name));
            }
        }
        match without.first() {
            Some((_, reason)) if without.len() == rows.len() => Err(reason.clone()),
            _ => Ok(Jacobian {
                matrix: DMatrix::from_fn(rows.len(), count, |i, j| rows[i][j]),
                without,
            }),
        }
    }

    /// The row of the distance of a datum from the fold that ends a sheet; zeros without one.
    fn fold_row(
        &mut self,
        problem: &Problem,
        number: usize,
        sheet: Option<usize>,
        by: f64,
    ) -> Result<Vec<f64>, String> {
        let (set, beside) = (&problem.sets[number], &self.beside[number]);
        let Some((branch, event)) = sheet.and_then(|sheet| beside.turn(set, sheet)) else {
            return Ok(vec![0.0; problem.unknowns.len()]);
        };
        let slopes = self.curves[set.group].fold_slopes(problem, branch, event)?;
        Ok(slopes.iter().map(|slope| -slope / by).collect())
    }

    /// Rows of the values of a set whose residuals are exact, by (1); nothing for the others, and where an orbit has no derivatives.
    fn at_feet(&mut self, problem: &Problem, number: usize, set: &Set) -> Vec<Option<Vec<f64>>> {
        let beside = &self.beside[number];
        let curve = &mut self.curves[set.group];
        let row = |index: usize| {
            let (place, orbit, _) = (*beside.exact.get(index)?)?;
            let (path, _) = beside.sheets[beside.feet[index].0];
            let branch = beside.paths[path].branch;
            let slopes = curve.slopes_at(problem, branch, place, orbit).ok()?;
            let (_, slope, by) = slopes.of[beside.wanted].as_ref()?;
            let across = across(set, index, *slope);
            Some(by.iter().map(|by| -by / across).collect())
        };
        (0..set.places.len()).map(row).collect()
    }

    /// Rows with those by derivatives between some orbits where there are none yet; why, where no orbit of the sheet has any.
    fn between(
        &mut self,
        problem: &Problem,
        number: usize,
        set: &Set,
        rows: Vec<Option<Vec<f64>>>,
    ) -> Vec<Result<Vec<f64>, String>> {
        let beside = &self.beside[number];
        let curve = &mut self.curves[set.group];
        let rows = rows.into_iter();
        let mut rows: Vec<Result<Vec<f64>, String>> =
            rows.map(|row| row.ok_or_else(String::new)).collect();
        for number in 0..beside.sheets.len() {
            let feet = beside.feet.iter().zip(rows.iter_mut());
            let without = |((own, _), row): &(&(usize, Foot), &mut Result<Vec<f64>, String>)| {
                *own == number && row.is_err()
            };
            let without: Vec<_> = feet.filter(without).collect();
            if without.is_empty() {
                continue;
            }
            let (path, sheet) = &beside.sheets[number];
            let path = &beside.paths[*path];
            let along: Vec<f64> = without.iter().map(|((_, foot), _)| foot.along).collect();
            let nodes = chosen(path, sheet, &along);
            let of = Along {
                path,
                sheet,
                wanted: beside.wanted,
                size: set.size,
            };
            let splines = splines(problem, curve, of, &nodes);
            for ((_, foot), row) in without {
                let by = |spline: &Spline| foot.weight * spline.of(foot.along)[0];
                let splines = splines.as_ref().map_err(String::clone);
                *row = splines.map(|splines| splines.iter().map(by).collect());
            }
        }
        rows
    }

    /// What the fit says at each value: the reading of the model at the place of the datum's foot, and that place.
    pub(crate) fn feet(&self, set: usize) -> impl Iterator<Item = [f64; 2]> {
        self.beside[set]
            .feet
            .iter()
            .map(|(_, foot)| [foot.x, foot.y])
    }

    /// The curve beside a set, part by part.
    pub(crate) fn drawn(&self, set: usize) -> Vec<Part> {
        let beside = &self.beside[set];
        let parts = beside.paths.iter().flat_map(|path| {
            path.sheets().into_iter().map(move |sheet| Part {
                may_be_stable: sheet.may_be_stable,
                points: path.drawn(&sheet),
            })
        });
        parts.collect()
    }
}

impl Beside {
    /// The place where a sheet ends ahead of the sweep.
    fn fold(&self, set: &Set, sheet: usize) -> f64 {
        self.sheets[sheet].1.range[usize::from(set.sweep == Sweep::Rising)]
    }

    /// The branch and the event of the fold there.
    fn turn(&self, set: &Set, sheet: usize) -> Option<(usize, usize)> {
        let (path, sheet) = &self.sheets[sheet];
        let node = sheet.folds[usize::from(set.sweep == Sweep::Rising)]?;
        let path = &self.paths[*path];
        Some((path.branch, path.nodes[node].event?))
    }
}

/// Where a sweep leaves the first sheet that it leaves, between two values.
fn left(set: &Set, assigned: &[usize]) -> Option<(f64, usize)> {
    let swept = matches!(set.sweep, Sweep::Rising | Sweep::Falling);
    let mut pairs = assigned.windows(2).zip(set.places.windows(2));
    let leaves = pairs.find(|(sheets, _)| swept && sheets[0] != sheets[1]);
    leaves.map(|(sheets, places)| (0.5 * (places[0] + places[1]), sheets[0]))
}

/// For each jump the sheet that ends in a fold nearest to it.
fn jumps(set: &Set, sheets: &[(usize, Sheet)]) -> Vec<Option<usize>> {
    let side = usize::from(set.sweep == Sweep::Rising);
    let of = |jump: &crate::data::Jump| {
        let ends = sheets
            .iter()
            .enumerate()
            .filter(|(_, (_, sheet))| sheet.folds[side].is_some());
        let apart = |sheet: &Sheet| (sheet.range[side] - jump.value).abs();
        let nearest = ends.min_by(|a, b| apart(&a.1.1).total_cmp(&apart(&b.1.1)));
        nearest.map(|(number, _)| number)
    };
    set.jumps.iter().map(of).collect()
}

/// What counts of how far a jump is beyond the fold: of a bound nothing where the fold is farther in the direction of the sweep.
fn one_sided(set: &Set, jump: usize, apart: f64) -> f64 {
    let ahead = if set.sweep == Sweep::Rising {
        1.0
    } else {
        -1.0
    };
    if set.jumps[jump].is_bound && ahead * apart < 0.0 {
        0.0
    } else {
        apart
    }
}

/// The deviation of a value across a curve of a slope.
fn across(set: &Set, index: usize, slope: f64) -> f64 {
    set.deviations[index].hypot(slope * set.place_deviation)
}

/// The foot of a value on a sheet.
fn foot(path: &Path, sheet: &Sheet, set: &Set, index: usize, how: How) -> Foot {
    let least = |size: f64| if how == How::Near { NEAR * size } else { 0.0 };
    let by = [
        set.place_deviation.max(least(set.size[0])),
        set.deviations[index].max(least(set.size[1])),
    ];
    let mut value = set.values[index];
    if set.wraps() {
        let ([_, near], _) = path.at(path.along_at(sheet, set.places[index]));
        value = turn::near(value, near);
    }
    path.foot(sheet, [set.places[index], value], by)
}

/// The place of the orbit that a value is compared with: that of its foot, where (1) does not depend on the slope, or that of the value itself
/// where both are nearly one. None where the foot is at a fold or beyond: the fold is a node of the curve, and the distance from it is exact
/// as it is.
fn stand(sheet: &Sheet, foot: &Foot, set: &Set, index: usize) -> Option<f64> {
    let own = set.places[index];
    let is_own = (foot.x - own).abs() <= OWN * set.place_deviation;
    let place = if is_own { own } else { foot.x };
    let away = FROM_FOLD * set.size[0];
    let [low, high] = sheet.range;
    let [low_fold, high_fold] = sheet.folds.map(|fold| fold.is_some());
    let at_fold = low_fold && place <= low + away || high_fold && place >= high - away;
    let beyond = foot.along < sheet.ends[0] && sheet.nodes[0] > 0 || foot.along > sheet.ends[1];
    (!at_fold && !beyond).then(|| place.clamp(low, high))
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::*;
    use crate::data::DataSet;
    use crate::fit::Fit;

    hertzian::oscillator! {
        OneSided(x) {
            param alpha > 0;
            param zeta in 0.0..;
            param load;
            param drive;
            law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^alpha, else => 0 }
            ddot(x) + contact(x) = drive*cos(omega*t) + load;
        }
    }

    /// Derivatives of residuals on both sides of folds against differences of them.
    #[test]
    fn derivatives_are_those_of_the_residuals() {
        let omegas: Vec<f64> = (0..14).map(|i| 0.65 + 0.05 * f64::from(i)).collect();
        let rising = [
            0.19, 0.2, 0.21, 0.23, 0.25, 0.28, 0.31, 0.36, 0.43, 0.6, 2.2, 1.9, 1.4, 0.9,
        ];
        let falling = [
            0.2, 8.0, 6.9, 6.1, 5.3, 4.7, 4.1, 3.5, 3.0, 2.6, 2.2, 1.9, 1.5, 0.8,
        ];
        let model = OneSided {
            alpha: 1.45,
            zeta: 0.035,
            load: 0.97,
            drive: 0.1,
        };
        let set = |values: &[f64], sweep| {
            DataSet::new("x:p2p", omegas.clone(), values.to_vec())
                .named(format!("{sweep:?}"))
                .sweep(sweep)
        };
        let fit = Fit::of(&model)
            .data(set(&rising, Sweep::Rising).jump(crate::Jump::at(1.13, 0.01)))
            .data(set(&falling, Sweep::Falling))
            .free("alpha")
            .free("zeta")
            .free("load");
        let problem = Problem::new(&fit).expect("a problem");
        let at = [1.45, 0.035, 0.97];
        for how in [How::Near, How::Exact] {
            let mut trial = Trial::below(&problem, &at, how, f64::INFINITY).expect("a trial");
            let jacobian = trial.jacobian(&problem).expect("derivatives");
            assert_eq!(jacobian.without, []);
            let jacobian = jacobian.matrix;
            for j in 0..3 {
                let h = 1e-5 * at[j];
                let [a, b] = [-h, h].map(|h| {
                    let mut moved = at;
                    moved[j] += h;
                    let trial =
                        Trial::below(&problem, &moved, how, f64::INFINITY).expect("a trial");
                    trial.residuals
                });
                let differences = a.iter().zip(&b).map(|(a, b)| (b - a) / (2.0 * h));
                let differences = DVector::from_iterator(a.len(), differences);
                let column = jacobian.column(j);
                if how == How::Near {
                    // Between orbits: good enough for steps that lead near.
                    let cosine = column.dot(&differences) / column.norm() / differences.norm();
                    assert!(cosine > 0.9, "{j}: {cosine}");
                    continue;
                }
                for (i, (found, expected)) in column.iter().zip(&differences).enumerate() {
                    // Beyond the fold, where the branch is as narrow as a needle, residuals are those of the curve between orbits.
                    let is_exact = !(24..28).contains(&i);
                    let apart = (found - expected).abs() / (expected.abs() + 1e-3 * column.norm());
                    assert!(!is_exact || apart < 0.02, "{j} {i}: {found} {expected}");
                }
            }
        }
    }
}
