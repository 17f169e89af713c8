//! Laws: their pieces, levels, rates and units.

use hertzian::law::{Derivatives, On, RateDependence};
use hertzian::system::{Bound, Place, System};

use super::{coefficient, force};

hertzian::oscillator! {
    /// One-sided contact with damping.
    pub OneSided(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// normal load
        param load;
        /// excitation amplitude
        param drive;

        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap^1.5,
            else    => 0,
        }

        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

#[test]
fn a_law_keeps_its_pieces_and_its_damping() {
    let model = OneSided {
        zeta: 0.032,
        load: 1.0,
        drive: 0.1,
    };
    let facts = model.facts();
    assert_eq!(facts.parameters[0].documentation, "damping ratio");
    assert_eq!(facts.parameters[0].minimum, Bound::Included(0.0));
    assert_eq!(
        facts.equation,
        "ddot(x) + contact(x) = drive*cos(omega*t) + load\n\
         law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^1.5, else => 0 }"
    );
    assert_eq!(model.law(0).facts().rate, RateDependence::Linear);
    assert_eq!(force(&model, 0, &[0.032], -1.0, 3.0), 0.0);
    let expected = 2.0 * 0.032 * 3.0 + 8.0;
    assert!((force(&model, 0, &[0.032], 4.0, 3.0) - expected).abs() < 1e-14);
}

hertzian::oscillator! {
    pub(crate) AsInThePaper(x) {
        param zeta in 0.0..;
        param alpha > 0;
        param load;
        param drive;
        ddot(x) + 2*zeta*H(x)*dot(x) + H(x)*sgn(x)*|x|^alpha = drive*cos(omega*t) + load;
    }
}

#[test]
fn both_notations_are_one_model() {
    let law = OneSided {
        zeta: 0.1,
        load: 0.0,
        drive: 0.0,
    };
    let paper = AsInThePaper {
        zeta: 0.1,
        alpha: 1.5,
        load: 0.0,
        drive: 0.0,
    };
    assert_eq!(
        law.law(0).facts().levels.len(),
        paper.law(0).facts().levels.len()
    );
    for gap in [-1.0, 0.0, 1e-3, 2.0] {
        let (a, b) = (
            force(&law, 0, &[0.1], gap, 0.7),
            force(&paper, 0, &[0.1, 1.5], gap, 0.7),
        );
        assert!((a - b).abs() <= 1e-15 * a.abs(), "{a} {b}");
    }
}

hertzian::oscillator! {
    Continuous(x) {
        param zeta in 0.0..1.0;
        param alpha in 0.5..=3;
        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^alpha = cos(omega*t);
    }
}

#[test]
fn linear_damping_is_no_force_of_the_law() {
    let model = Continuous {
        zeta: 0.3,
        alpha: 0.7,
    };
    assert_eq!(
        coefficient(&model, Place::Damping { row: 0, column: 0 }, 1.0),
        0.6
    );
    assert_eq!(model.law(0).facts().rate, RateDependence::None);
    assert!(model.law(0).facts().odd);
    assert_eq!(force(&model, 0, &[0.7], -1.0, 5.0), -1.0);
}

/// The module has constants of the same names, which the generated code must not mean.
#[allow(non_snake_case, reason = "these are the names of constants")]
mod beside_constants {
    pub const K: f64 = 4e4;
    pub static E: f64 = 2.1e11;

    hertzian::oscillator! {
        pub Beam(x) {
            param K > 0;
            param E > 0;
            law stop(gap) { gap > 1 => E*(gap - 1)^K, else => 0 }
            ddot(x) + K*x + stop(x) = cos(omega*t);
        }
    }
}

#[test]
fn parameters_may_be_called_as_constants_are() {
    let model = beside_constants::Beam { K: 3.0, E: 2.0 };
    let mut values = [f64::NAN; 2];
    model.values(&mut values);
    assert_eq!(values, [3.0, 2.0]);
    assert_eq!([beside_constants::K, beside_constants::E], [4e4, 2.1e11]);
}

hertzian::oscillator! {
    TwoWells(x) { ddot(x) + 0.1*dot(x) + ||x|-1|^1.5 = 0.2*cos(omega*t); }
}

#[test]
fn nested_absolute_values_are_four_pieces() {
    let model = TwoWells {};
    let mut levels = [0.0; 3];
    model.law(0).levels(&[], &mut levels);
    assert_eq!(levels, [-1.0, 0.0, 1.0]);
    for gap in [-2.5_f64, -0.4, 0.3, 1.7] {
        let expected = (gap.abs() - 1.0).abs().powf(1.5);
        assert!((force(&model, 0, &[], gap, 0.0) - expected).abs() < 1e-14);
    }
}

hertzian::oscillator! {
    Backlash(x) {
        param play > 0;
        param ζ in 0.0..;
        law teeth(gap) {
            gap > play => gap - play,
            -play <= gap <= play => 0,
            gap < -play => gap + play,
        }
        ddot(x) + 2*ζ*dot(x) + (1 + 0.2*cos(omega*t))*teeth(x) = 0.1;
    }
}

#[test]
fn levels_follow_their_parameter() {
    let model = Backlash {
        play: 0.25,
        ζ: 0.01,
    };
    let (mut levels, mut slopes) = ([0.0; 2], [0.0; 2]);
    model.law(0).levels(&[0.25], &mut levels);
    model.law(0).levels_by(&[0.25], 0, &mut slopes);
    assert_eq!((levels, slopes), ([-0.25, 0.25], [-1.0, 1.0]));
}

hertzian::oscillator! {
    /// Contacts of the literature, side by side.
    Literature(x) {
        param k > 0;
        param c in 0.0..;
        param n >= 1;
        param a > 0;
        param preload in 0.0..=2.0;
        law hunt_crossley(gap) { gap > 0 => k*gap^n*(1 + c*dot(gap)), else => 0 }
        law preloaded(gap) { gap >= 0 => preload + gap, else => 0 }
        law bilinear(gap) { gap > 0 => k*gap, else => 0.5*gap }
        law adhesive(gap) { gap > 0 => gap^1.5 - 1/a^2, else => -(a - gap)^-2 }
        ddot(x) + hunt_crossley(x - 1) + preloaded(x) + bilinear(x) - adhesive(-x) + c*|dot(x)|^1.8*sgn(dot(x)) = cos(omega*t);
    }
}

#[test]
fn contacts_of_the_literature_are_laws() {
    let model = Literature {
        k: 2.0,
        c: 0.5,
        n: 1.5,
        a: 0.1,
        preload: 0.3,
    };
    let facts = model.facts();
    let names: Vec<String> = (0..facts.laws)
        .map(|law| model.law(law).facts().name.to_string())
        .collect();
    assert_eq!(
        names,
        [
            "hunt_crossley",
            "preloaded",
            "bilinear",
            "adhesive",
            "force 1"
        ]
    );
    assert_eq!(model.law(0).facts().rate, RateDependence::Linear);
    assert!(
        model.law(1).facts().levels[0].force_jumps && model.law(1).facts().levels[0].belongs_above
    );
    assert!(model.law(2).facts().pieces.iter().all(|piece| piece.affine));
    assert!(!model.law(3).facts().levels[0].force_jumps);
    assert_eq!(model.law(4).facts().rate, RateDependence::General);
}

hertzian::oscillator! {
    /// A ball pressed on a plate, in newtons, millimetres and tonnes.
    Ball(x: mm) {
        /// mass
        param m: t = 1e-3 > 0;
        /// contact stiffness
        param k: N/mm^1.5 = 4e4 in 0.0..;
        /// damping of the contact
        param c: s/mm = 1e-4 in 0.0..;
        param drive: N = 10;
        law contact(gap) {
            gap > 0 => max(0, k*gap^1.5*(1 + c*dot(gap))),
            else    => 0,
        }
        m*ddot(x) + contact(x) = drive*cos(omega*t);
    }
}

#[test]
fn defaults_make_a_model() {
    let model = Ball::default();
    assert_eq!(model.k, 4e4);
    let facts = model.facts();
    let said = |index: usize| {
        let parameter = &facts.parameters[index];
        [&parameter.documentation[..], &parameter.unit]
    };
    assert_eq!(said(1), ["contact stiffness", "N/mm^1.5"]);
    assert_eq!(said(3), ["", "N"]);
}

#[test]
fn a_contact_without_tension_lets_go() {
    let model = Ball::default();
    let arguments = [4e4, 1e-4];
    assert_eq!(model.law(0).facts().rate, RateDependence::General);
    for (gap, rate) in [
        (0.25_f64, 100.0),
        (0.25, -9000.0),
        (0.25, -11000.0),
        (-0.1, 5.0),
    ] {
        let pressed = if gap > 0.0 {
            (4e4 * gap.powf(1.5) * (1.0 + 1e-4 * rate)).max(0.0)
        } else {
            0.0
        };
        let found = force(&model, 0, &arguments, gap, rate);
        assert!(
            (found - pressed).abs() <= 1e-12 * pressed,
            "{found} {pressed}"
        );
    }
    let (mut force, mut by_gap, mut by_rate) = ([9.0], [9.0], [9.0]);
    let out = Derivatives {
        force: &mut force,
        by_gap: &mut by_gap,
        by_rate: &mut by_rate,
    };
    model
        .law(0)
        .derivatives(On::AllPieces, &arguments, &[0.25], &[-11000.0], out);
    assert_eq!((force, by_gap, by_rate), ([0.0], [0.0], [0.0]));
}
