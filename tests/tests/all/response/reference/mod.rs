//! Models of the literature against events and orbits of the differential equations that were computed by other programs:
//! [`hertzian_tests::reference`]. One run over the range finds every event, each within its stated error, and none besides.

mod beam;
mod bearing;
mod chain;
mod gears;
mod two_masses;

use hertzian::{Branch, FrequencyResponse, OrbitMethod};

/// A request from either end of a range, by one method.
fn from_either_end<M: OrbitMethod + Clone>(
    request: &FrequencyResponse<M>,
    [from, to]: [f64; 2],
) -> [Branch; 2] {
    [[from, to], [to, from]].map(|[from, to]| request.clone().from(from).to(to).run().unwrap())
}
