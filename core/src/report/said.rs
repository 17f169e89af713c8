//! Orbits and events in words.

use std::fmt::Write;

use crate::branches::branch::Branch;
use crate::branches::point::{DECIMALS, Event, Point};
use crate::error::Error;
use crate::numeric::decimal::Decimal;
use crate::orbit::observe::{Measure, Wanted};
use crate::report::unit::with;

impl Branch {
    /// An event in words: what happens, where, and the size of [what leads](Self::leading) there, with names where there are several,
    /// units, and as many digits as their errors bear.
    pub fn describe(&self, event: &Event) -> String {
        let Event {
            kind,
            point,
            error,
            contacts,
            ..
        } = event;
        let unit = self.model.unit_of_varied(&self.varied);
        let value = with(&Decimal::to_error(point.value, *error).to_string(), unit);
        let size = self.describe_size(point);
        let mut text = format!("{kind} at {value} (error {error:.0e}), {size}");
        if *contacts > 1 {
            // Writing to a string does not fail.
            let _ = write!(text, ", {contacts} contacts at once");
        }
        text
    }

    /// What is asked of a signal at an orbit, in words, with its unit: `"x:h1"` is `amplitude of harmonic 1 of x 4.831200 nm`.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     Mount(x: mm) {
    ///         param m: t = 1e-3 > 0;
    ///         param c: N*s/mm = 0.02;
    ///         param k: N/mm = 40;
    ///         param drive: N = 2;
    ///         m*ddot(x) + c*dot(x) + k*x = drive*cos(omega*t);
    ///     }
    /// }
    ///
    /// let branch = FrequencyResponse::of(&Mount::default()).from(100.0).to(300.0).run()?;
    /// // Where inertia and stiffness are in balance: drive over damping and frequency.
    /// let orbit = &branch.at(200.0)?[0];
    /// assert_eq!(branch.describe_measured("x:h1", orbit)?, "amplitude of harmonic 1 of x 0.500000 mm");
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// As of [`measured`](Self::measured), and if the text is not of that form.
    pub fn describe_measured(&self, of: &str, point: &Point) -> Result<String, Error> {
        let wanted: Wanted = of.parse()?;
        let measured = self.measured(&wanted, point)?;
        let what = format!("{} of {}", wanted.measure.in_words(), wanted.name);
        let unit = wanted.measure.unit(self.model.unit_of(&wanted.name));
        Ok(match measured {
            Some(value) => {
                let digits = self.digits(&wanted, value, point).to_string();
                format!("{what} {}", with(&digits, &unit))
            }
            None => format!("{what} not known"),
        })
    }

    /// The size of [what leads](Self::leading) at an orbit in words: `peak-to-peak of tip 1.25 um`.
    pub fn describe_size(&self, point: &Point) -> String {
        let (wanted, model) = (self.leading(), &self.model);
        let measured = self.measured(&wanted, point).ok().flatten();
        let size = self.digits(&wanted, measured.unwrap_or(f64::NAN), point);
        let name = match (model.outputs.len(), model.coordinates.len()) {
            (0, 1) => String::new(),
            _ => format!(" of {}", wanted.name),
        };
        let size = with(&size.to_string(), model.unit_of(&wanted.name));
        format!("peak-to-peak{name} {size}")
    }

    /// With as many digits as the error of peak-to-peak bears, where it is one of this signal.
    fn digits(&self, wanted: &Wanted, value: f64, point: &Point) -> Decimal {
        let is_of_this = self.accuracy_of().is_none_or(|name| name == wanted.name);
        match point.error.filter(|_| is_of_this) {
            Some(error) if wanted.measure == Measure::PeakToPeak => {
                Decimal::to_error(value, error * value)
            }
            _ => Decimal::rounded(value, DECIMALS),
        }
    }
}
