//! Types that stand for generated laws. The implementation of [`Law`] for all of them has to be where `Law` is.

use crate::data::LawData;
use crate::law::{Derivatives, Law, LawFacts, On, Parts};

/// A type that stands for a generated law: what `law!` declares.
pub trait Declared: Send + Sync {
    /// The law.
    fn declared(&self) -> &'static dyn Law;
}

impl<T: Declared> Law for T {
    #[inline]
    fn facts(&self) -> &LawFacts {
        self.declared().facts()
    }

    #[inline]
    fn data(&self) -> Option<&LawData> {
        self.declared().data()
    }

    #[inline]
    fn levels(&self, arguments: &[f64], levels: &mut [f64]) {
        self.declared().levels(arguments, levels);
    }

    #[inline]
    fn levels_by(&self, arguments: &[f64], argument: usize, by_argument: &mut [f64]) {
        self.declared().levels_by(arguments, argument, by_argument);
    }

    #[inline]
    fn force(&self, on: On, arguments: &[f64], gap: &[f64], rate: &[f64], force: &mut [f64]) {
        self.declared().force(on, arguments, gap, rate, force);
    }

    #[inline]
    fn derivatives(
        &self,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
    ) {
        self.declared().derivatives(on, arguments, gap, rate, out);
    }

    #[inline]
    fn derivatives_and_by(
        &self,
        argument: usize,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
        by_argument: &mut [f64],
    ) {
        self.declared()
            .derivatives_and_by(argument, on, arguments, gap, rate, out, by_argument);
    }

    #[inline]
    fn parts(&self) -> Option<Parts<'_>> {
        self.declared().parts()
    }
}
