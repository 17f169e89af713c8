//! What belongs to a number of nodes and a map alone, and is made once per process.

use std::any::Any;
use std::sync::{Arc, Mutex, PoisonError};

use super::map::Map;

type Anything = Arc<dyn Any + Send + Sync>;

/// All that has been made. There are few: a type for each number of nodes, and maps with the few powers of [`grading`](crate::numeric::fourier::grading).
static KEPT: Mutex<Vec<(Map, Anything)>> = Mutex::new(Vec::new());

/// What a map has of a type; it is made where it is asked for first.
pub(super) fn kept<T: Any + Send + Sync>(map: Map, make: impl FnOnce() -> T) -> Arc<T> {
    let find = |kept: &[(Map, Anything)]| {
        let mut same = kept.iter().filter(|(own, _)| *own == map);
        same.find_map(|(_, anything)| Arc::clone(anything).downcast::<T>().ok())
    };
    let known = find(&KEPT.lock().unwrap_or_else(PoisonError::into_inner));
    known.unwrap_or_else(|| {
        // Nobody waits while it is made. Where two make it, both have the same numbers.
        let made = Arc::new(make());
        let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
        find(&kept).unwrap_or_else(|| {
            kept.push((map, Arc::clone(&made) as Anything));
            made
        })
    })
}
