//! What the tests share: a folder of their own, and a study that is computed quickly.

use std::path::PathBuf;

use hertzian_study::{Prepared, Request, Spread, Study, Variants};

hertzian::oscillator! {
    /// Linear oscillator.
    pub Linear(x) {
        /// stiffness
        param k = 4 > 0;
        /// amplitude of the excitation
        param drive = 1;
        ddot(x) + 0.2*dot(x) + k*x = drive*cos(omega*t);
    }
}

/// A folder that is removed in the end.
pub struct Folder(PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        let folder =
            std::env::temp_dir().join(format!("hertzian-study-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).expect("a folder");
        Self(folder)
    }

    pub fn join(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// So many variants of a linear oscillator, in blocks of four.
pub fn study(count: usize) -> Prepared {
    unprepared(count).prepare().expect("a study")
}

/// The same, before it is checked.
pub fn unprepared(count: usize) -> Study {
    let variants = Variants::sobol(count)
        .over("k", Spread::uniform(3.0, 5.0))
        .over("drive", Spread::normal(1.0, 0.1));
    let keep = hertzian_study::Keep::new().at(&[1.0, 2.5]);
    let request = Request::response(0.5, 3.0).tolerance(1e-4).stability(false);
    let study = Study::of(&Linear::default()).variants(variants);
    study.request(request).keep(keep).block(4)
}

/// The largest displacement less the smallest of the linear oscillator.
pub fn peak_to_peak(k: f64, drive: f64, omega: f64) -> f64 {
    2.0 * drive / (k - omega * omega).hypot(0.2 * omega)
}
