//! Work on several threads, or on one without the feature `parallel`.

use super::BasinError;

/// A number of threads.
pub(super) struct Threads {
    #[cfg(feature = "parallel")]
    pool: rayon::ThreadPool,
}

#[cfg(feature = "parallel")]
impl Threads {
    pub(super) fn new(count: usize) -> Result<Self, BasinError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
        pool.map(|pool| Self { pool })
            .map_err(|_| BasinError::Threads { count })
    }

    /// What a function gives for every item, in the order of the items.
    pub(super) fn map<T: Send>(
        &self,
        items: &[usize],
        function: impl Fn(usize) -> T + Sync + Send,
    ) -> Vec<T> {
        use rayon::prelude::*;
        let map = || {
            items
                .par_iter()
                .with_max_len(1)
                .map(|&item| function(item))
                .collect()
        };
        self.pool.install(map)
    }
}

#[cfg(not(feature = "parallel"))]
#[allow(
    clippy::unused_self,
    clippy::unnecessary_wraps,
    reason = "the same calls as with threads"
)]
impl Threads {
    pub(super) fn new(_count: usize) -> Result<Self, BasinError> {
        Ok(Self {})
    }

    /// What a function gives for every item, in the order of the items.
    pub(super) fn map<T>(&self, items: &[usize], function: impl Fn(usize) -> T) -> Vec<T> {
        items.iter().map(|&item| function(item)).collect()
    }
}
