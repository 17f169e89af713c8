//! `--resume`: goes on with a branch that was kept in a file.

use hertzian::bifurcation::Diagram;
use hertzian::{Branch, Cancel, System};

use super::options::Options;
use super::progress::Seen;
use super::run::Failure;
use crate::range::RangeOptions;

/// The branch in the file, if one is resumed, and the options with what varies there, and from where to where.
///
/// # Errors
/// If the file has no branch.
pub fn of(options: &Options) -> Result<(Options, Option<Branch>), Failure> {
    let Some(path) = &options.resume else {
        return Ok((options.clone(), None));
    };
    let branch = Branch::read(path)?;
    let ends = [branch.points.first(), branch.points.last()];
    let [from, to] = ends.map(|point| point.map(|point| point.value));
    let omega = branch.points.first().map(hertzian::Point::omega);
    let mut options = Options {
        range: RangeOptions {
            sweep: branch.varied.clone(),
            from: from.unwrap_or(options.range.from),
            to: to.unwrap_or(options.range.to),
        },
        one_branch: true,
        ..options.clone()
    };
    if branch.varied != "omega" {
        options.model.omega = options.model.omega.or(omega);
    }
    Ok((options, Some(branch)))
}

/// The whole of it, alone.
///
/// # Errors
/// If the oscillator is another one, or the branch does not go on.
pub fn find(
    options: &Options,
    branch: &Branch,
    model: &dyn System,
    cancel: &Cancel,
    seen: &mut Seen<'_>,
) -> Result<Diagram, Failure> {
    let mut branch = branch.clone();
    branch.attach(model)?;
    let mut resume = branch.resume().cancel(cancel);
    if let Some(path) = &options.resume {
        resume = resume.keep(path);
    }
    if let Some(points) = options.max_points {
        resume = resume.max_points(points);
    }
    let whole = resume.run_with(|progress| seen.see(progress))?;
    Ok(Diagram::from(vec![whole]))
}
