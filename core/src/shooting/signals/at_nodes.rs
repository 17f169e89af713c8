//! Signals on a stretch whose motion is known at the nodes of a Gauss rule, as that of an orbit by collocation is.
//!
//! With `n` nodes that rule has the integrals of polynomials up to the degree `2n - 1`. Where the last coefficients of a signal through its nodes are
//! small, what the rule leaves out of its integral and of that of its square is of the size of their product, and nothing between the nodes is asked
//! for but where a largest value is looked for. Where they are not, the stretch is divided as others are.
//!
//! Source: Trefethen (2008), Is Gauss quadrature better than Clenshaw-Curtis?, SIAM Review 50(1), section 3 (rules of Gauss and coefficients).

use super::{Found, Reader};
use crate::time::Stretch;

/// A stretch whose states are known at the nodes of a Gauss rule, in a variable that its motion is smooth in.
pub(crate) trait AtNodes: Stretch {
    /// How many there are.
    fn count(&self) -> usize;

    /// The phase of a node, and its weight in integrals by the phase.
    fn node(&self, node: usize) -> [f64; 2];

    /// Writes the state at a node.
    fn state_at(&self, node: usize, state: &mut [f64]);

    /// Whether the last coefficients of the polynomial with these values at the nodes are so small that its integrals are those of the signal.
    fn is_known(&self, values: &[f64]) -> bool;
}

impl Reader<'_> {
    /// Includes a stretch that is known at nodes.
    pub(crate) fn include_at_nodes(&mut self, stretch: &dyn AtNodes) {
        self.include_or(stretch, |reader| reader.take_nodes(stretch));
    }

    /// Takes what the nodes tell, if that is all.
    fn take_nodes(&mut self, stretch: &dyn AtNodes) -> bool {
        let channels = self.same.len();
        if self.harmonics > 0 || channels == 0 {
            return false;
        }
        let count = stretch.count();
        let mut rows = vec![0.0; count * channels];
        for (node, row) in rows.chunks_exact_mut(channels).enumerate() {
            stretch.state_at(node, &mut self.state);
            self.write_here(stretch.node(node)[0], row);
        }
        // Channel after channel.
        let columns = (0..channels).flat_map(|channel| rows[channel..].iter().step_by(channels));
        let columns: Vec<f64> = columns.copied().collect();
        let mut of_channels = columns.chunks_exact(count).enumerate();
        if !of_channels.all(|(channel, of)| !self.is_looked_at(channel) || stretch.is_known(of)) {
            return false;
        }
        let signals = self.found.len();
        for (channel, values) in columns.chunks_exact(count).enumerate() {
            let Found { motion, .. } = &mut self.found[channel % signals];
            let mut sums = [0.0; 2];
            for (node, x) in values.iter().enumerate() {
                let [_, weight] = stretch.node(node);
                sums[0] += weight * x;
                sums[1] += weight * x * x;
            }
            motion.mean = motion.mean.map(|mean| mean + sums[0]);
            motion.rms = motion.rms.map(|rms| rms + sums[1]);
        }
        let (from, to) = stretch.phases();
        self.take_extremes(stretch, [from, to], |channel, samples| {
            let values = columns[channel * count..][..count].iter().enumerate();
            samples.extend(values.map(|(node, x)| [stretch.node(node)[0], *x]));
        });
        true
    }
}
