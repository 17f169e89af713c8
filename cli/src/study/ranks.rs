//! A study over the ranks that `mpirun` has started.

use std::path::Path;

use hertzian::Cancel;
use hertzian_study::{Folder, Prepared, Ranks};

use super::options::Options;
use super::run;
use crate::program::{Ended, Failed};
use crate::response::progress::Progress;

/// The other ranks, where there are some and all of the study is asked for.
pub(super) fn ranks(options: &Options) -> Option<Ranks> {
    options.part.is_none().then(Ranks::join)?
}

/// Computes what this rank is given; rank 0 hands out, writes the table and sums up.
///
/// # Errors
/// If the folder cannot be opened or a file cannot be written; the other ranks go on.
pub(super) fn run(
    ranks: &Ranks,
    study: &Prepared,
    folder: &Path,
    cancel: &Cancel,
    progress: &mut Progress,
) -> Result<Ended, Failed> {
    // A rank without a folder must not leave in silence: the others would wait for it.
    let folder = Folder::open(folder, study);
    let (ran, folder) = ranks.run(study, folder, cancel, &mut run::shown(progress))?;
    if ranks.rank() > 0 {
        return Ok(Ended {
            summary: String::new(),
            complaints: Vec::new(),
            complete: true,
        });
    }
    if ran.interrupted {
        return Ok(run::kept(&ran, false));
    }
    run::table(study, &[folder], Some(&ran), cancel, progress)
}
