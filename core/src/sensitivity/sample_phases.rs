//! Where an orbit is looked at: at switches, at extremes of its signals, and at the nodes of rules between switches.
//!
//! Integrals are Gauss rules between switches, on a variable that is graded at both ends of an arc, where derivatives of forces go as powers of the
//! distance from the level.

use super::cycle::{Cycle, Stop};
use super::scan::Scan;
use super::slopes::Slopes;
use crate::numeric::fourier::gauss;
use crate::time::FlowError;

/// Angle of the highest harmonic over a part of an arc that one rule is for.
const ANGLE: f64 = 4.0;

/// What is to be read.
#[derive(Debug, Clone)]
pub(super) struct Needs {
    pub(super) extremes: bool,
    /// Means and squares.
    pub(super) integrals: bool,
    /// Of each signal.
    pub(super) harmonics: Vec<usize>,
    /// Nodes of a rule.
    pub(super) nodes: usize,
}

impl Needs {
    /// The highest harmonic of all signals.
    pub(super) fn highest(&self) -> usize {
        self.harmonics.iter().copied().max().unwrap_or(0)
    }
}

/// A node of a rule.
pub(super) struct Node {
    pub(super) stop: usize,
    pub(super) arc: usize,
    pub(super) weight: f64,
    /// In radians of the orbit's own first harmonic.
    pub(super) angle: f64,
}

/// Where an orbit is looked at.
pub(super) struct Places {
    pub(super) scan: Scan,
    pub(super) stops: Vec<Stop>,
    /// By position among the stops.
    pub(super) switches: Vec<usize>,
    pub(super) extremes: Vec<[Option<usize>; 2]>,
    pub(super) nodes: Vec<Node>,
    pub(super) needs: Needs,
}

impl Places {
    /// Of the orbit from these states.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub(super) fn of(
        cycle: &mut Cycle,
        slopes: &Slopes,
        states: &[f64],
        needs: Needs,
    ) -> Result<Self, FlowError> {
        let scan = Scan::of(cycle, slopes, states, false)?;
        let mut stops: Vec<Stop> = scan.switches.iter().map(|s| scan.stop_of(s)).collect();
        let switches = (0..stops.len()).collect();
        let mut place = |stop: Stop| {
            stops.push(stop);
            stops.len() - 1
        };
        let extremes = scan.extremes.iter().map(|pair| {
            pair.map(|extreme| {
                let extreme = extreme.filter(|e| needs.extremes && e.end.is_none())?;
                let segment = scan.arcs[extreme.arc].segment;
                let phase = extreme.phase;
                Some(place(Stop { segment, phase }))
            })
        });
        let extremes = extremes.collect();
        let mut nodes = Vec::new();
        if needs.integrals || needs.highest() > 0 {
            let rule = gauss::rule(needs.nodes);
            for (index, arc) in scan.arcs.iter().enumerate() {
                let passed = cycle.passed(arc.segment);
                let length = arc.to - arc.from;
                let waves = needs.highest().max(4 * cycle.period) as f64;
                let angle = waves * length / cycle.period as f64;
                let parts = (angle / ANGLE / needs.nodes as f64 * 8.0).ceil().max(1.0);
                for part in 0..parts as usize {
                    for (x, weight) in rule.nodes.iter().zip(&rule.weights) {
                        let s = (part as f64 + x) / parts;
                        let phase = arc.from + length * s * s * (3.0 - 2.0 * s);
                        let segment = arc.segment;
                        nodes.push(Node {
                            stop: place(Stop { segment, phase }),
                            arc: index,
                            weight: weight / parts * length * 6.0 * s * (1.0 - s),
                            angle: (passed + phase) / cycle.period as f64,
                        });
                    }
                }
            }
        }
        let mut places = Self {
            scan,
            stops,
            switches,
            extremes,
            nodes,
            needs,
        };
        places.sort();
        Ok(places)
    }

    /// Puts the stops into the order of the motion.
    fn sort(&mut self) {
        let mut order: Vec<usize> = (0..self.stops.len()).collect();
        let stops = &self.stops;
        order.sort_by(|&a, &b| {
            let (a, b) = (stops[a], stops[b]);
            a.segment.cmp(&b.segment).then(a.phase.total_cmp(&b.phase))
        });
        let mut place = vec![0; order.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old] = new;
        }
        self.stops = order.iter().map(|&old| stops[old]).collect();
        self.switches
            .iter_mut()
            .for_each(|stop| *stop = place[*stop]);
        let extremes = self.extremes.iter_mut().flatten().flatten();
        extremes.for_each(|stop| *stop = place[*stop]);
        self.nodes
            .iter_mut()
            .for_each(|node| node.stop = place[node.stop]);
    }
}
