//! The method that fits a system, where none is asked for.
//!
//! Where a force sets in at a level of its gap, or has a corner there, its harmonics fall off as a low power of their number. The contact
//! equation has forces as unknowns on each stretch between two crossings, on which they are smooth. A force that is continuous with its
//! derivatives, as an odd power above one, has harmonics that fall off faster, and few of them are few unknowns, unless many digits are asked
//! for. So laws and the tolerance tell which method is quicker; what was measured is in DESIGN.md.
//!
//! Where the stiffness of a force is unbounded on both sides of a level, a branch bends beside a touch of it so sharply that the contact equation
//! takes many steps there, or is lost; shooting passes it. So it is where motions without contacts grow by many digits within a period
//! ([`growing`](super::growing)).
//!
//! The contact equation has no equation for a system that nothing holds, may miss a first orbit, and may end where its equations fit no
//! further orbit. There the balance is tried, which was asked for every branch before there was a choice.

use super::growing::grows;
use super::in_turn::{Either, First};
use super::kind::OrbitMethodKind;
use super::sealed::Follow;
use super::steep::{is_steep, is_unbounded};
use crate::balance_branch::options::HarmonicBalance;
use crate::branches::branch::Branch;
use crate::branches::point::{Event, Point};
use crate::branches::progress::See;
use crate::branches::request::Request;
use crate::contact_equation::ContactEquation;
use crate::error::Error;
use crate::event::Side;
use crate::law::{Law, LawFacts, On, PieceFacts, Variation};
use crate::laws::single::{self, Single};
use crate::model::layout::Layout;
use crate::orbit::observe::Accuracy;
use crate::shooting::Shooting;
use crate::system::{System, Variable};

/// The frequency at which laws are looked at. It is in none but through a coefficient of time in units of its own.
const FREQUENCY: f64 = 1.0;
/// Rates at which limits of forces are compared.
const RATES: [f64; 2] = [0.0, 1.0];
/// Limits that differ by this part of their size are the same.
const ROUNDED: f64 = 1e-12;
/// From this tolerance on higher derivatives count as well.
const MANY_DIGITS: f64 = 1e-8;
/// Where forces of two pieces are compared beside their level, in units of the gap and of the level.
const BESIDE: [f64; 4] = [-1.0, -0.3, 0.3, 1.0];

/// The method that fits the system, which a [`FrequencyResponse`](crate::FrequencyResponse) uses unless another one is
/// [asked for](crate::FrequencyResponse::by): the [contact equation](ContactEquation) where a law opens, that is has a piece without force, or
/// has a corner or a jump at a level, and the [harmonic balance](HarmonicBalance) where every force is smooth. At a tolerance of 1e-8 or below it
/// is the contact equation wherever a force is another function on the other side of a level. Where the stiffness of a law is unbounded on both
/// sides of a level, as of `sgn(x)*|x|^0.6`, it is [shooting](Shooting), and so it is in place of the contact equation where motions of
/// the linear part grow by five digits and a half within a period, or so that rounding comes to the tolerance, as those of a buckled beam between stops at a low frequency. Where the contact equation or shooting has no equations for the
/// system, finds no first orbit, or leads no further, the balance is tried: [`Branch::method`] says what a branch
/// was followed by.
///
/// One orbit by itself is one of the balance, which the other methods would begin with.
///
/// Whoever sets an option of the balance, as the number of harmonics, wants the balance. So it is the balance too where a symmetry is to be
/// watched without [stability](crate::FrequencyResponse::stability), which the other methods cannot, and where [accuracy is asked of an
/// output](crate::FrequencyResponse::accuracy_of).
///
/// ```
/// use hertzian::{FrequencyResponse, OrbitMethodKind};
///
/// hertzian::oscillator! {
///     Stopped(x) {
///         law stop(gap) { gap > 0 => 10*gap, else => 0 }
///         ddot(x) + 0.1*dot(x) + x + stop(x - 1) = 0.3*cos(omega*t);
///     }
/// }
///
/// let request = FrequencyResponse::of(&Stopped {}).from(0.8).to(1.2);
/// assert_eq!(request.choice(), OrbitMethodKind::ContactEquation);
/// assert_eq!(request.reason(), "law `stop` opens");
/// assert_eq!(request.run()?.method(), Some(OrbitMethodKind::ContactEquation));
/// assert_eq!(request.harmonics(20).run()?.method(), Some(OrbitMethodKind::HarmonicBalance));
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Chosen {
    /// The balance with its options.
    pub(super) balance: HarmonicBalance,
    /// One of them was set.
    by_balance: bool,
}

/// What is chosen for a system, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Choice {
    /// Every force is smooth.
    HarmonicBalance,
    /// A force is not.
    ContactEquation {
        /// Name of the first law of which it is one.
        law: String,
        /// Whether the law has a piece without force. Otherwise it has a corner or a jump at a level.
        opens: bool,
    },
    /// The stiffness of a force is unbounded on both sides of a level.
    Shooting {
        /// Name of the first law of which it is one.
        law: String,
    },
    /// A force is not smooth, and without its contacts the system falls away within a period.
    Growing,
    /// Every force is smooth, one is another function on the other side of a level, and so many digits are asked for that this matters.
    ToManyDigits {
        /// Name of the first law of which it is one.
        law: String,
    },
}

impl Choice {
    /// For a request, by laws at both ends of what it varies: a force that is smooth at one end, as where two stiffnesses are the same or an
    /// exponent is above one, may have a corner on the way to the other.
    pub(super) fn within(request: &Request) -> Self {
        let system = request.system.as_ref();
        let mut values = request.parameters();
        let omega = request.omega.unwrap_or(FREQUENCY);
        let mut at = |end: f64| match request.variable() {
            Ok(Variable::Parameter(index)) => {
                values[index] = end;
                Self::at(system, &values, omega, request)
            }
            _ => Self::at(system, &values, end, request),
        };
        let Some((from, to)) = request.from.zip(request.to) else {
            return Self::at(system, &request.parameters(), omega, request);
        };
        match [at(from), at(to)] {
            [steep @ Self::Shooting { .. }, _] | [_, steep @ Self::Shooting { .. }] => steep,
            [Self::Growing, _] | [_, Self::Growing] => Self::Growing,
            [Self::HarmonicBalance, other] => other,
            [found, _] => found,
        }
    }

    /// By laws at values of the parameters and at a frequency.
    fn at(system: &dyn System, values: &[f64], omega: f64, request: &Request) -> Self {
        let tolerance = request.tolerance;
        let layout = Layout::of(system);
        let mut coefficients = vec![0.0; layout.coefficients];
        system.coefficients(values, omega, &mut coefficients);
        let contacts: Vec<(&dyn Law, Vec<f64>)> = (layout.contacts.iter())
            .map(|contact| {
                let mut arguments = vec![0.0; contact.argument_count];
                contact.arguments(&coefficients, &mut arguments);
                (system.law(contact.law), arguments)
            })
            .collect();
        let steep = contacts.iter().find_map(|(law, arguments)| {
            let facts = law.facts();
            let law = facts.name.to_string();
            is_steep(facts, arguments).then_some(Self::Shooting { law })
        });
        let rough = || {
            contacts.iter().find_map(|(law, arguments)| {
                let facts = law.facts();
                let opens = opens(facts);
                let found = opens || has_corner(*law, arguments);
                let law = facts.name.to_string();
                found.then_some(Self::ContactEquation { law, opens })
            })
        };
        let mut changing = contacts.iter().filter(|(law, arguments)| {
            // Nothing is computed for that where it does not matter.
            tolerance <= MANY_DIGITS && changes(*law, arguments)
        });
        let choice = steep.or_else(rough).or_else(|| {
            let (law, _) = changing.next()?;
            let law = law.facts().name.to_string();
            Some(Self::ToManyDigits { law })
        });
        let choice = choice.unwrap_or(Self::HarmonicBalance);
        let grows = || grows(system, &layout, &coefficients, omega, request);
        if choice.method() == OrbitMethodKind::ContactEquation && grows() {
            return Self::Growing;
        }
        choice
    }

    /// The method, as [`Branch::method`] has it.
    pub(super) fn method(&self) -> OrbitMethodKind {
        match self {
            Self::HarmonicBalance => OrbitMethodKind::HarmonicBalance,
            Self::Shooting { .. } | Self::Growing => OrbitMethodKind::Shooting,
            Self::ContactEquation { .. } | Self::ToManyDigits { .. } => {
                OrbitMethodKind::ContactEquation
            }
        }
    }

    /// Why, in a few words.
    pub(super) fn reason(&self) -> String {
        match self {
            Self::HarmonicBalance => "every force is smooth".to_owned(),
            Self::Shooting { law } => {
                format!("the stiffness of law `{law}` is unbounded on both sides of a level")
            }
            Self::Growing => {
                "motions grow by many digits within a period without contacts".to_owned()
            }
            Self::ContactEquation { law, opens: true } => format!("law `{law}` opens"),
            Self::ContactEquation { law, opens: false } => format!("law `{law}` has a corner"),
            Self::ToManyDigits { law } => {
                format!("law `{law}` has a level that matters to so many digits")
            }
        }
    }
}

/// Whether a piece of a law has no force, and others have.
fn opens(law: &LawFacts) -> bool {
    let is_free = |piece: &PieceFacts| piece.force == Variation::Zero;
    law.pieces.iter().any(is_free) && !law.pieces.iter().all(is_free)
}

/// Whether a force, or a derivative of it, jumps or is unbounded at a level. What is known of the law may be of all values that an exponent
/// can have: the two pieces tell what it is at these.
fn has_corner(law: &dyn Law, arguments: &[f64]) -> bool {
    let facts = &law.facts().levels;
    let mut levels = vec![0.0; facts.len()];
    law.levels(arguments, &mut levels);
    facts.iter().enumerate().any(|(index, level)| {
        let may = level.force_jumps
            || level.by_gap_jumps
            || level.by_rate_jumps
            || level.unbounded_by_gap;
        may && (is_unbounded(law.facts(), index, arguments).contains(&true)
            || RATES.iter().any(|rate| {
                let at = [levels[index], *rate];
                let sides = [index, index + 1];
                let [below, above] =
                    sides.map(|piece| Single::of(law, On::Piece(piece), arguments, at));
                differ(below.force, above.force)
                    || differ(below.by_gap, above.by_gap)
                    || differ(below.by_rate, above.by_rate)
            }))
    })
}

/// Whether a force is another function on the other side of a level: one that is the same there has no harmonics for it. Beyond its piece a power
/// whose exponent is a parameter has no value that could be compared, and counts as another one.
fn changes(law: &dyn Law, arguments: &[f64]) -> bool {
    let mut levels = vec![0.0; law.facts().levels.len()];
    law.levels(arguments, &mut levels);
    levels.iter().enumerate().any(|(index, level)| {
        let unit = level.abs().max(1.0);
        let places = BESIDE
            .iter()
            .flat_map(|part| RATES.map(|rate| (part, rate)));
        places.into_iter().any(|(part, rate)| {
            let at = [level + part * unit, rate];
            let [below, above] =
                [index, index + 1].map(|piece| single::force(law, On::Piece(piece), arguments, at));
            differ(below, above)
        })
    })
}

/// Whether two limits are not one number up to rounding; what is unbounded is none.
fn differ(below: f64, above: f64) -> bool {
    let size = below.abs().max(above.abs());
    let apart = (below - above).abs();
    !apart.is_finite() || apart > ROUNDED * size
}

impl Chosen {
    /// With everything by default.
    pub fn new() -> Self {
        Self::default()
    }

    /// With other options of the balance, which is wanted then.
    pub(super) fn balanced(self, set: impl FnOnce(HarmonicBalance) -> HarmonicBalance) -> Self {
        Self {
            balance: set(self.balance),
            by_balance: true,
        }
    }

    /// What is chosen for a request, unless the balance is wanted.
    fn choice(&self, request: &Request) -> Choice {
        // More nodes do not resolve an output that vanishes but for rounding, and as many as there may be are asked for.
        let of_output = matches!(self.balance.accuracy, Accuracy::Output(_));
        if self.by_balance || of_output {
            Choice::HarmonicBalance
        } else {
            Choice::within(request)
        }
    }

    /// What the methods find that fit, or the balance alone.
    fn by_these<T>(
        &self,
        request: &Request,
        find: impl FnOnce(&dyn Follow) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let accuracy = self.balance.accuracy;
        let choice = self.choice(request);
        // With multipliers the other methods find all that happens.
        let balance = if request.stability {
            self.balance.for_diagram()
        } else {
            self.balance
        };
        match choice {
            Choice::HarmonicBalance => find(&self.balance),
            Choice::Shooting { .. } | Choice::Growing => {
                let shooting = Shooting::new().accurate_in(accuracy);
                find(&Either::of(First::Shooting(shooting), balance))
            }
            Choice::ContactEquation { .. } | Choice::ToManyDigits { .. } => {
                let equation = ContactEquation::new().accurate_in(accuracy);
                find(&Either::of(First::ContactEquation(equation), balance))
            }
        }
    }
}

impl Follow for Chosen {
    fn for_diagram(self) -> Self {
        Self {
            balance: self.balance.for_diagram(),
            ..self
        }
    }

    fn accurate_in(self, accuracy: Accuracy) -> Self {
        Self {
            balance: self.balance.accurate_in(accuracy),
            ..self
        }
    }

    fn is_balance(&self, request: &Request) -> bool {
        self.choice(request) == Choice::HarmonicBalance
    }

    fn orbit(&self, request: &Request, value: f64) -> Result<Point, Error> {
        // The other methods begin with an orbit of the balance.
        self.balance.orbit(request, value)
    }

    fn run(&self, request: &Request, visit: See<'_>) -> Result<Branch, Error> {
        self.by_these(request, |method| method.run(request, visit))
    }

    fn switch(
        &self,
        request: &Request,
        event: &Event,
        side: Side,
        visit: See<'_>,
    ) -> Result<Branch, Error> {
        self.by_these(request, |method| method.switch(request, event, side, visit))
    }

    fn through(&self, request: &Request, value: f64, visit: See<'_>) -> Result<Branch, Error> {
        self.by_these(request, |method| method.through(request, value, visit))
    }
}
