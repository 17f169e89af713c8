//! Signals of orbits by their names, whatever method found them.

#[cfg(feature = "serde")]
use serde::Deserialize;

use super::{FrequencyResponse, OrbitMethod};
use crate::branches::branch::{Branch, Further, Model, Source};
use crate::branches::point::Point;
use crate::error::Error;
use crate::model::request::RequestError;
use crate::orbit::observe::{
    Accuracy, Measure, Reading, Wanted, of_coordinate, of_series, over_period, series_over_period,
    stored,
};

impl Branch {
    /// An output, a coordinate or the force of a contact over the period of an orbit, by its name. A contact has the name of its law, with
    /// a number from one on where the law acts in several. Of an orbit that is known by its states its motion is computed once more, and 20
    /// harmonics for each period of the excitation are kept.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     Stopped(x) {
    ///         law stop(gap) { gap > 0 => 10*gap, else => 0 }
    ///         ddot(x) + 0.1*dot(x) + x + stop(x - 1) = 0.3*cos(omega*t);
    ///         output speed = dot(x);
    ///     }
    /// }
    ///
    /// let branch = FrequencyResponse::of(&Stopped {}).from(0.5).to(1.5).run()?;
    /// let orbit = &branch.at(1.2)?[0];
    /// let speed = branch.reading("speed", orbit)?;
    /// println!("{} {:?}", speed.motion.peak_to_peak(), speed.motion.crest_factor());
    /// for line in speed.spectrum().iter().take(4) {
    ///     println!("{} {} {}", line.omega, line.amplitude, line.phase);
    /// }
    /// let force = branch.reading("stop", orbit)?;
    /// let largest = branch.measured(&"stop:max".parse()?, orbit)?.unwrap();
    /// assert_eq!(force.motion.maximum, largest);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// If nothing has that name, the branch was read from a file and has no [model](Self::attach), or the motion of the orbit cannot be
    /// computed.
    pub fn reading(&self, name: &str, point: &Point) -> Result<Reading, Error> {
        self.read_signal(self.model.source(name)?, point)
    }

    /// Several signals over the period of an orbit, by their names, as [`reading`](Self::reading) has one: where the contact equation
    /// finds the orbit again its motion is computed once for all, and else for each.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     Stopped(x) {
    ///         law stop(gap) { gap > 0 => 10*gap, else => 0 }
    ///         ddot(x) + 0.1*dot(x) + x + stop(x - 1) = 0.3*cos(omega*t);
    ///         output speed = dot(x);
    ///     }
    /// }
    ///
    /// let branch = FrequencyResponse::of(&Stopped {}).from(0.5).to(1.5).run()?;
    /// let orbit = &branch.at(1.2)?[0];
    /// let read = branch.readings(&["speed", "stop"], orbit)?;
    /// assert_eq!(read[1], branch.reading("stop", orbit)?);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// As of [`reading`](Self::reading).
    pub fn readings(&self, names: &[&str], point: &Point) -> Result<Vec<Reading>, Error> {
        let sources = names.iter().map(|name| self.model.source(name));
        let sources: Vec<Source> = sources.collect::<Result<_, _>>()?;
        if let (false, Ok(motions)) = (point.orbit.states.is_empty(), self.motions()) {
            return motions.readings(&sources, &self.of_motion(point));
        }
        let read = sources
            .into_iter()
            .map(|source| self.read_signal(source, point));
        read.collect()
    }

    /// What is asked of a signal at an orbit, by name: `"tip:rms".parse()?`. `None` where it is not there, as a harmonic of an orbit that has
    /// fewer. What was not read off an orbit by shooting is computed from its motion.
    ///
    /// # Errors
    /// If nothing has that name or the measure is not one of it; or it takes the model, and the branch was read from a file and has
    /// [none](Self::attach).
    pub fn measured(&self, wanted: &Wanted, point: &Point) -> Result<Option<f64>, Error> {
        let source = self.model.measurable(wanted)?;
        measured(
            source,
            wanted.measure,
            point,
            || self.complete(point),
            || self.read_signal(source, point),
        )
    }

    /// The orbit at which what is asked of a signal is largest, as `"tip:rms"`; `None` where it is known of none.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     Linear(x) { ddot(x) + 0.1*dot(x) + x = cos(omega*t); }
    /// }
    ///
    /// let branch = FrequencyResponse::of(&Linear {}).from(0.5).to(1.5).largest_step(0.01).run()?;
    /// let peak = branch.largest("x:rms")?.unwrap();
    /// // At the root of 1 - 0.1^2 / 2.
    /// assert!((peak.value - 0.9975).abs() < 0.02);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// As of [`measured`](Self::measured), and if the text is not of that form.
    pub fn largest(&self, of: &str) -> Result<Option<&Point>, Error> {
        let wanted: Wanted = of.parse()?;
        let mut largest: Option<(f64, &Point)> = None;
        for point in &self.points {
            let Some(measured) = self.measured(&wanted, point)? else {
                continue;
            };
            // What is not a number is not larger than one.
            if !measured.is_nan() && largest.is_none_or(|(known, _)| measured > known) {
                largest = Some((measured, point));
            }
        }
        Ok(largest.map(|(_, point)| point))
    }

    /// A signal over the period of an orbit as times and values, by its name: enough of them to be drawn, and both sides of every switch, where
    /// a force may jump. An orbit that is known by its states is [completed](Self::complete) first.
    ///
    /// # Errors
    /// As of [`reading`](Self::reading).
    pub fn waveform(&self, name: &str, point: &Point) -> Result<Vec<[f64; 2]>, Error> {
        let source = self.model.source(name)?;
        let completed;
        let point = if point.orbit.has_series() {
            point
        } else {
            completed = self.complete(point)?;
            &completed
        };
        if let Source::Coordinate(index) = source
            && index < point.orbit.coordinates()
        {
            return Ok(series_over_period(point, index));
        }
        let system = self.system().ok_or(RequestError::Detached)?;
        over_period(system, point, source)
    }

    fn read_signal(&self, source: Source, point: &Point) -> Result<Reading, Error> {
        // The series of an orbit that is known by its states was cut off, and its motion was not.
        if let (false, Ok(motions)) = (point.orbit.states.is_empty(), self.motions()) {
            return motions.reading(source, &self.of_motion(point));
        }
        // A coordinate is its series: that takes no model.
        if let Source::Coordinate(index) = source
            && let Some(reading) = of_coordinate(point, index)
        {
            return Ok(reading);
        }
        let system = self.system().ok_or(RequestError::Detached)?;
        if point.orbit.has_series() {
            return of_series(system, point, source);
        }
        self.motions()?.reading(source, &self.of_motion(point))
    }
}

impl Branch {
    /// Name of the output or the coordinate that the errors of its orbits are of, [`Point::error`]: what was
    /// [asked for](FrequencyResponse::accuracy_of). `None` where they are of all coordinates.
    pub fn accuracy_of(&self) -> Option<&str> {
        let accuracy = match self.followed() {
            Ok(following) => following.shooting().accuracy,
            Err(_) => written_accuracy(&self.further),
        };
        accuracy.name(&self.model)
    }
}

/// What the accuracy is of as it was written, of a branch that was read from a file.
fn written_accuracy(further: &Further) -> Accuracy {
    #[cfg(not(feature = "serde"))]
    let _ = further;
    #[cfg(feature = "serde")]
    if let Some(methods) = further.written["by"].as_object() {
        let mut options = methods
            .values()
            .map(|method| &method["options"]["accuracy"]);
        let accuracy = options.next().map(Accuracy::deserialize);
        return accuracy.and_then(Result::ok).unwrap_or_default();
    }
    Accuracy::default()
}

impl<M: OrbitMethod> FrequencyResponse<M> {
    /// An output, a coordinate or the force of a contact over the period of an orbit of this request, by its name: as
    /// [`Branch::reading`], of an orbit that is on no branch.
    ///
    /// # Errors
    /// If nothing has that name, the orbit is not one of this request, or its motion cannot be computed.
    pub fn reading(&self, name: &str, point: &Point) -> Result<Reading, Error> {
        let model = Model::of(self.request.system.as_ref());
        let found = self.read_signal(model.source(name)?, point);
        self.request.unless_cancelled(point.value, found)
    }

    /// What is asked of a signal at an orbit of this request, by name: as [`Branch::measured`], of an orbit that is on no branch.
    ///
    /// # Errors
    /// As [`reading`](Self::reading), and if the measure is not one of the signal.
    pub fn measured(&self, wanted: &Wanted, point: &Point) -> Result<Option<f64>, Error> {
        let model = Model::of(self.request.system.as_ref());
        let source = model.measurable(wanted)?;
        measured(
            source,
            wanted.measure,
            point,
            || self.complete(point),
            || self.read_signal(source, point),
        )
    }

    fn read_signal(&self, source: Source, point: &Point) -> Result<Reading, Error> {
        if point.orbit.states.is_empty() {
            return of_series(self.request.system.as_ref(), point, source);
        }
        self.motions()?.reading(source, point)
    }
}

/// What is asked of a signal at an orbit: what has been read off, or else what the completed orbit, or the signal, says.
fn measured(
    source: Source,
    measure: Measure,
    point: &Point,
    complete: impl FnOnce() -> Result<Point, Error>,
    read: impl FnOnce() -> Result<Reading, Error>,
) -> Result<Option<f64>, Error> {
    let known = |point: &Point| stored(&point.observed, source, measure, point.orbit.base);
    if let Some(known) = known(point) {
        return Ok(Some(known));
    }
    if measure.is_of_contact() {
        // Those of an orbit with series have been read off.
        let read = !point.orbit.has_series();
        return Ok(if read { known(&complete()?) } else { None });
    }
    Ok(read()?.measured(measure))
}
