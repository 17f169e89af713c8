//! How orbits of a backbone are read: by the method that finds their motion, and without computing others.

use super::by_shooting;
use super::following::Left;
use crate::branches::branch::Further;
use crate::branches::request::Request;
use crate::shooting::Shooting;
use crate::system::System;

/// By motions with this tolerance, of orbits of which one has this frequency.
pub(crate) fn read_by_shooting(system: &dyn System, tolerance: f64, omega: f64) -> Further {
    let shooting = Shooting::new().tolerance(tolerance);
    // Every request has a range; this one is not followed.
    let request = Request {
        from: Some(omega),
        to: Some(2.0 * omega),
        ..Request::of(system)
    };
    by_shooting::further(&request, shooting, Left::Nothing, None).of_backbone()
}
