//! What takes the whole motion of an orbit, for files: branches by shooting and by the contact equation have it of single orbits alone.

use std::ops::ControlFlow;

use hertzian::error::chain;
use hertzian::{Branch, Cancel, Point, Progress};

/// Reads everything off all orbits of the branches, until it is cancelled. Says of which orbits that could not be done.
pub fn all(
    branches: &mut [Branch],
    cancel: &Cancel,
    mut see: impl FnMut(Progress<'_>),
) -> Vec<String> {
    let mut said = Vec::new();
    for (number, branch) in branches.iter_mut().enumerate() {
        let found = branch.complete_all_with(|progress| {
            see(progress);
            if cancel.is_cancelled() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        let lacks = |point: &&Point| point.orbit.harmonics() == 0;
        let left = branch.points.iter().filter(lacks).count();
        let why = match found {
            _ if left == 0 => continue,
            Err(error) => chain(&error).to_string(),
            Ok(()) => "interrupted".to_owned(),
        };
        said.push(format!(
            "of {left} orbits of branch {number} files lack what takes the whole motion: {why}"
        ));
    }
    said
}
