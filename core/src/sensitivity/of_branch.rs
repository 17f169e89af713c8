//! What can be asked of a branch.

use super::Sensitivities;
use super::orbit::Sensitive;
use super::rows::{self, Row};
use crate::branches::branch::Branch;
use crate::branches::point::{Event, Point};
use crate::error::Error;
use crate::orbit::observe::Wanted;

impl Branch {
    /// Derivatives of what is read off an orbit of this branch, by the frequency and by every parameter of the declaration, exponents
    /// included, each with its error: of extremes, peak-to-peak, mean, rms, crest factor and five harmonics of every coordinate and output, of
    /// the forces of contacts and their impulses, the part of the period on each piece of their laws, the power of the load, and the
    /// multipliers. The orbit is found again from switch to switch, so that they are those of the true orbit, whatever method followed the
    /// branch.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     Linear(x) {
    ///         param zeta in 0.0..;
    ///         ddot(x) + 2*zeta*dot(x) + x = cos(omega*t);
    ///     }
    /// }
    ///
    /// let branch = FrequencyResponse::of(&Linear { zeta: 0.1 }).from(0.5).to(1.5).run()?;
    /// let at = branch.sensitivities(&branch.at(1.0)?[0])?;
    /// // At resonance peak-to-peak is 1 / zeta.
    /// let by_zeta = at.of("x:p2p", "zeta").unwrap();
    /// assert!((by_zeta.value + 100.0).abs() < 1e-8);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// If the branch is a [backbone](crate::backbone), the frequency of which is not fixed, or was read from a file and has no
    /// [model](Self::attach), or if the orbit is at a fold or is not found again.
    pub fn sensitivities(&self, point: &Point) -> Result<Sensitivities, Error> {
        let problem = Sensitive::of(self, point)?;
        problem.with_multipliers(&rows::all(&self.model))
    }

    /// The same of what is asked for alone: `"x:rms".parse()?`. What has no derivative at any orbit, as a number of impacts, is among what is
    /// missing.
    ///
    /// # Errors
    /// As [`sensitivities`](Self::sensitivities), and if nothing has such a name.
    pub fn sensitivities_of(
        &self,
        point: &Point,
        wanted: &[Wanted],
    ) -> Result<Sensitivities, Error> {
        let (rows, missing) = rows::with_derivatives(&self.model, wanted)?;
        let mut told = Sensitive::of(self, point)?.of_point(&rows)?;
        told.missing.extend(missing);
        Ok(told)
    }

    /// As [`sensitivities_of`](Self::sensitivities_of), by some variables alone (`"omega"`, or parameters) and in a fraction of the time: to eight
    /// digits as a rule, but without errors, which are infinite. For who needs many of them, as a fit does.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     Linear(x) {
    ///         param zeta in 0.0..;
    ///         param drive;
    ///         ddot(x) + 2*zeta*dot(x) + x = drive*cos(omega*t);
    ///     }
    /// }
    ///
    /// let branch = FrequencyResponse::of(&Linear { zeta: 0.1, drive: 1.0 }).from(0.5).to(1.5).run()?;
    /// let at = branch.quick_sensitivities_of(&branch.at(1.0)?[0], &["x:p2p".parse()?], &["zeta"])?;
    /// assert_eq!(at.variables, ["zeta"]);
    /// assert!((at.of("x:p2p", "zeta").unwrap().value + 100.0).abs() < 1e-5);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`sensitivities_of`](Self::sensitivities_of), and if there is no such parameter, or a number of impacts is asked for.
    pub fn quick_sensitivities_of(
        &self,
        point: &Point,
        wanted: &[Wanted],
        by: &[&str],
    ) -> Result<Sensitivities, Error> {
        let rows = wanted.iter().map(|wanted| rows::row(&self.model, wanted));
        let rows: Vec<Row> = rows.collect::<Result<_, _>>()?;
        Sensitive::of(self, point)?.only_by(by)?.quick(&rows)
    }

    /// Derivatives of where an event of this branch is: of a fold, of an orbit that grazes a level, of where a period doubles, a symmetry breaks or
    /// quasi-periodic motions begin. And of what is read off the orbit there as the event moves; at a fixed value of what is varied too, but
    /// not at a fold, where those derivatives are unbounded.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     Duffing(x) {
    ///         param zeta in 0.0..;
    ///         param alpha > 0;
    ///         ddot(x) + 2*zeta*dot(x) + x + sgn(x)*|x|^alpha = 0.2*cos(omega*t);
    ///     }
    /// }
    ///
    /// let model = Duffing { zeta: 0.05, alpha: 3.0 };
    /// let branch = FrequencyResponse::of(&model).from(0.5).to(2.0).run()?;
    /// let fold = branch.folds().next().unwrap();
    /// let moves = branch.event_sensitivities(fold)?;
    /// // More damping, and the upper branch ends at a lower frequency and at a lower height.
    /// assert!(moves.of_place("zeta").unwrap().value < 0.0);
    /// assert!(moves.of_moving("x:p2p", "zeta").unwrap().value < 0.0);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// If branches cross there, which a change of parameters undoes, the multiplier that decides is a repeated one, the branch is a
    /// [backbone](crate::backbone) or was read from a file and has no [model](Self::attach), or the event is not found again.
    pub fn event_sensitivities(&self, event: &Event) -> Result<Sensitivities, Error> {
        let rows = rows::all(&self.model);
        Sensitive::of(self, &event.point)?.of_event(event, &rows, true)
    }

    /// As [`event_sensitivities`](Self::event_sensitivities), with what is asked for alone, `"x:rms".parse()?`: the place without anything is
    /// had sooner.
    ///
    /// # Errors
    /// As there, and if nothing has such a name.
    pub fn event_sensitivities_of(
        &self,
        event: &Event,
        wanted: &[Wanted],
    ) -> Result<Sensitivities, Error> {
        let (rows, missing) = rows::with_derivatives(&self.model, wanted)?;
        let mut told = Sensitive::of(self, &event.point)?.of_event(event, &rows, false)?;
        told.missing.extend(missing);
        Ok(told)
    }
}
