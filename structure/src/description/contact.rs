//! Contacts: laws at work in a structure, and where.

use std::sync::Arc;

use hertzian::law::Law;
use hertzian::structure::{Turn, Value};

use super::direction::Direction;

/// A law at work in a structure, and where.
#[derive(Debug, Clone)]
pub struct SparseContact {
    pub(crate) name: String,
    pub(crate) law: Arc<dyn Law>,
    pub(crate) arguments: Vec<Value>,
    pub(crate) gap: Direction,
    pub(crate) force: Option<Direction>,
    /// Towards which direction, and how, that of gap and force turns.
    pub(crate) turning: Option<(Direction, Turn)>,
    pub(crate) offset: Value,
}

impl SparseContact {
    /// A law whose gap is along a direction. Its force is an output of this name.
    pub fn new(name: &str, law: Arc<dyn Law>, gap: Direction) -> Self {
        Self {
            name: name.to_owned(),
            law,
            arguments: Vec::new(),
            gap,
            force: None,
            turning: None,
            offset: 0.0.into(),
        }
    }

    /// The arguments of the law, in its order.
    #[must_use]
    pub fn arguments(mut self, arguments: impl IntoIterator<Item = impl Into<Value>>) -> Self {
        self.arguments = arguments.into_iter().map(Into::into).collect();
        self
    }

    /// A direction of the force that differs from that of the gap.
    #[must_use]
    pub fn force_direction(mut self, direction: Direction) -> Self {
        self.force = Some(direction);
        self
    }

    /// The direction of gap and force turns from that of the gap towards this one: it is `cos(angle) gap + sin(angle) across`, with the angle that
    /// a [`Turn`] has. No other direction of the force can be given then.
    ///
    /// ```
    /// use std::sync::Arc;
    ///
    /// use hertzian::structure::Turn;
    /// use hertzian_structure::{Direction, SparseContact};
    ///
    /// hertzian::law! {
    ///     Ball(gap) { gap > 0 => gap^1.5, else => 0 }
    /// }
    ///
    /// // The balls of a bearing between the coordinates 0, downwards, and 1, across.
    /// let balls = (0..8).map(|ball| {
    ///     let turn = Turn::by(2, 5).from(std::f64::consts::TAU / 8.0 * f64::from(ball));
    ///     let contact = SparseContact::new(&format!("ball{ball}"), Arc::new(Ball), Direction::at(0));
    ///     contact.turning(Direction::at(1), turn).offset(0.1)
    /// });
    /// assert_eq!(balls.count(), 8);
    /// ```
    #[must_use]
    pub fn turning(mut self, across: Direction, turn: Turn) -> Self {
        self.turning = Some((across, turn));
        self
    }

    /// The direction of the force; of one that turns that towards which it does.
    pub(crate) fn second(&self) -> &Direction {
        let across = self.turning.as_ref().map(|(across, _)| across);
        across.or(self.force.as_ref()).unwrap_or(&self.gap)
    }

    /// What is subtracted from the gap.
    #[must_use]
    pub fn offset(mut self, offset: impl Into<Value>) -> Self {
        self.offset = offset.into();
        self
    }
}
