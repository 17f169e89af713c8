//! A study over the ranks that `mpirun` has started.

use std::path::Path;

use hertzian::Cancel;
use hertzian::error::chain;
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
/// If rank 0 cannot open the folder, or a file cannot be written; what another rank cannot is a complaint of it.
pub(super) fn run(
    ranks: &Ranks,
    study: &Prepared,
    folder: &Path,
    cancel: &Cancel,
    progress: &mut Progress,
) -> Result<Ended, Failed> {
    // A rank without a folder must not leave in silence: the others would wait for it.
    let folder = Folder::open(folder, study);
    let ran = ranks.run(study, folder, cancel, &mut run::shown(progress));
    if ranks.rank() > 0 {
        // What it could not keep another one computes, and rank 0 knows what is left: an exit code here would have the launcher end them all.
        let fault = ran.err().map(|error| {
            let (rank, why) = (ranks.rank(), chain(&error));
            format!("rank {rank}: {why}; the other ranks go on without it")
        });
        return Ok(Ended {
            summary: String::new(),
            complaints: fault.into_iter().collect(),
            complete: true,
        });
    }
    let (ran, folder) = ran?;
    if ran.interrupted {
        return Ok(run::kept(&ran, false));
    }
    run::table(study, &[folder], Some(&ran), cancel, progress)
}
