//! Exact values, computed independently of this project: event-located DOP853 in 80-bit arithmetic for the powers 1.5 and
//! 0.6, whose states are given to fourteen decimals; the closed form between switches in 60 digits for the power one.

use super::*;

/// A fold of a curve of Wang et al. (2021), drive 0.1. Values stand in full at every fold, as folds of one figure share some by chance.
struct Fold {
    figure: &'static str,
    one_sided: bool,
    alpha: f64,
    zeta: f64,
    load: f64,
    omega: f64,
    state: [f64; 2],
    /// Beside the one at one; of half a period where the orbit is odd, without load.
    multiplier: f64,
}

const FOLDS: &[Fold] = &[
    Fold {
        figure: "2a",
        one_sided: false,
        alpha: 1.5,
        zeta: 0.01,
        load: 0.0,
        omega: 0.909513715044238,
        state: [-0.36474837729589, 0.02333936835171],
        multiplier: 0.9332493022466738,
    },
    Fold {
        figure: "2a",
        one_sided: false,
        alpha: 1.5,
        zeta: 0.01,
        load: 0.0,
        omega: 1.332696002393464,
        state: [-0.1072263737497, 4.73653814692191],
        multiplier: 0.9539477048926559,
    },
    Fold {
        figure: "2a",
        one_sided: false,
        alpha: 1.5,
        zeta: 0.01,
        load: 0.0,
        omega: 0.241956653790653,
        state: [0.39412464234821, -0.0757066097734],
        multiplier: 0.7712966110311875,
    },
    Fold {
        figure: "2a",
        one_sided: false,
        alpha: 1.5,
        zeta: 0.01,
        load: 0.0,
        omega: 0.252011071022547,
        state: [0.08149686482275, -0.10033960378473],
        multiplier: 0.7793291473078361,
    },
    Fold {
        figure: "2b",
        one_sided: false,
        alpha: 0.6,
        zeta: 0.01,
        load: 0.0,
        omega: 0.704927892945083,
        state: [0.53161336679721, 5.24219765787477],
        multiplier: 0.9147245363004486,
    },
    Fold {
        figure: "2b",
        one_sided: false,
        alpha: 0.6,
        zeta: 0.01,
        load: 0.0,
        omega: 1.320305358301798,
        state: [0.08403496272463, 0.00222413366137],
        multiplier: 0.953525720135878,
    },
    Fold {
        figure: "2b",
        one_sided: false,
        alpha: 0.6,
        zeta: 0.01,
        load: 0.0,
        omega: 0.600295303778675,
        state: [0.04161939142585, 0.08538850857603],
        multiplier: 0.9006232635847641,
    },
    Fold {
        figure: "2b",
        one_sided: false,
        alpha: 0.6,
        zeta: 0.01,
        load: 0.0,
        omega: 0.655311078341127,
        state: [0.04417336226394, 0.00334234030884],
        multiplier: 0.9085721691376,
    },
    Fold {
        figure: "2b",
        one_sided: false,
        alpha: 0.6,
        zeta: 0.01,
        load: 0.0,
        omega: 0.396401365447262,
        state: [0.02337311365071, 0.03723231430361],
        multiplier: 0.8534181484651266,
    },
    Fold {
        figure: "2b",
        one_sided: false,
        alpha: 0.6,
        zeta: 0.01,
        load: 0.0,
        omega: 0.401353864568085,
        state: [0.04081114860286, 0.01286404660368],
        multiplier: 0.8550889633724756,
    },
    Fold {
        figure: "2b",
        one_sided: false,
        alpha: 0.6,
        zeta: 0.01,
        load: 0.0,
        omega: 0.400955186850763,
        state: [0.0385254197611, 0.00741165407597],
        multiplier: 0.8549558701173084,
    },
    Fold {
        figure: "2b",
        one_sided: false,
        alpha: 0.6,
        zeta: 0.01,
        load: 0.0,
        omega: 0.457909272249307,
        state: [0.02622411401606, 0.00052641186838],
        multiplier: 0.871783091996227,
    },
    Fold {
        figure: "4a",
        one_sided: false,
        alpha: 1.5,
        zeta: 0.01,
        load: 1.0,
        omega: 1.158212487926707,
        state: [-0.52997004361605, 0.43708586658379],
        multiplier: 0.8971807142523226,
    },
    Fold {
        figure: "4a",
        one_sided: false,
        alpha: 1.5,
        zeta: 0.01,
        load: 1.0,
        omega: 1.337227934760159,
        state: [0.24456707188226, 4.72876228677624],
        multiplier: 0.9103070778285067,
    },
    Fold {
        figure: "4a",
        one_sided: false,
        alpha: 1.5,
        zeta: 0.01,
        load: 1.0,
        omega: 1.09502860674539,
        state: [2.04205426686546, 0.49308543799695],
        multiplier: 0.8915815441118987,
    },
    Fold {
        figure: "4a",
        one_sided: false,
        alpha: 1.5,
        zeta: 0.01,
        load: 1.0,
        omega: 1.136461722203842,
        state: [1.6384186819256, 0.13935800633882],
        multiplier: 0.8953196110761554,
    },
    Fold {
        figure: "4a",
        one_sided: false,
        alpha: 1.5,
        zeta: 0.01,
        load: 5.0,
        omega: 1.484450028723123,
        state: [2.38774764555134, 4.9821428077551],
        multiplier: 0.9188307181688925,
    },
    Fold {
        figure: "4a",
        one_sided: false,
        alpha: 1.5,
        zeta: 0.01,
        load: 5.0,
        omega: 1.56555114602055,
        state: [4.03032567527831, 0.83772544930865],
        multiplier: 0.9228689567925338,
    },
    Fold {
        figure: "5a",
        one_sided: true,
        alpha: 1.0,
        zeta: 0.032,
        load: 1.0,
        omega: 0.715119549676419,
        state: [-0.48676037210566, 2.3074200607571],
        multiplier: 0.7777430770416699,
    },
    Fold {
        figure: "5a",
        one_sided: true,
        alpha: 1.0,
        zeta: 0.032,
        load: 1.0,
        omega: 0.96016367187857,
        state: [1.79486020060022, 0.61302753413818],
        multiplier: 0.6752479543532874,
    },
    Fold {
        figure: "5b",
        one_sided: true,
        alpha: 1.5,
        zeta: 0.032,
        load: 1.0,
        omega: 0.685842253572486,
        state: [-2.55189979898804, 2.35083179131024],
        multiplier: 0.8373956361404825,
    },
    Fold {
        figure: "5b",
        one_sided: true,
        alpha: 1.5,
        zeta: 0.032,
        load: 1.0,
        omega: 1.144516913788162,
        state: [1.55130087870998, 0.48411547983725],
        multiplier: 0.7037387295620701,
    },
    Fold {
        figure: "5c",
        one_sided: true,
        alpha: 0.6,
        zeta: 0.032,
        load: 1.0,
        omega: 0.845526217725541,
        state: [0.26593790047056, 0.54970730662263],
        multiplier: 0.6215182188544779,
    },
    Fold {
        figure: "5c",
        one_sided: true,
        alpha: 0.6,
        zeta: 0.032,
        load: 1.0,
        omega: 0.849176252131873,
        state: [0.27679581892496, 0.6871321461095],
        multiplier: 0.6382719607375877,
    },
    Fold {
        figure: "5c",
        one_sided: true,
        alpha: 0.6,
        zeta: 0.032,
        load: 1.0,
        omega: 0.631308249440869,
        state: [1.00110472280815, 2.36383708326941],
        multiplier: 0.6965189318790136,
    },
    Fold {
        figure: "5c",
        one_sided: true,
        alpha: 0.6,
        zeta: 0.032,
        load: 1.0,
        omega: 0.765568492941199,
        state: [2.15951555554905, 0.4880679765266],
        multiplier: 0.6335702256073072,
    },
];

/// Table 1 of Wang et al. (2021), exactly: drive, state, multipliers of the orbits of period eight.
const PERIOD_8: &[(f64, [f64; 2], [f64; 2])] = &[
    (
        1.7798,
        [-0.33046647111186583064, 0.33349423964190761326],
        [0.9902634294356096, 0.18601252117560596],
    ),
    (
        1.7798,
        [-0.3846264013111231144, 0.34068852367572424479],
        [1.034938331267823, 0.17709978203689786],
    ),
    (
        1.77982,
        [-0.3441624981559662589, 0.33479047381100781377],
        [0.9905639798300239, 0.18579985821399464],
    ),
    (
        1.77982,
        [-0.37887792999898372686, 0.33951419223048061083],
        [1.0206601338830297, 0.17972416352118084],
    ),
    (
        1.779835,
        [-0.35993036759129042753, 0.33658967747978272458],
        [0.99652374785176, 0.18445843299969783],
    ),
    (
        1.779835,
        [-0.3684878430645495909, 0.33777313660699896468],
        [1.0041953967530124, 0.18289576740261654],
    ),
];

/// Moves over some periods; the tangent.
fn moved(flow: &mut Integrated, periods: usize, state: &mut [f64]) -> [f64; 4] {
    let mut tangent = Tangent::of_state(1, None);
    for _ in 0..periods {
        flow.advance(0.0, TAU, state, Some(&mut tangent), None)
            .unwrap();
    }
    tangent.columns.try_into().unwrap()
}

#[test]
fn folds_return_to_themselves_with_the_multiplier_one() {
    for fold in FOLDS {
        let model = PowerForm::new(fold.one_sided, fold.alpha, fold.zeta, fold.load, 0.1);
        let mut flow = Integrated::new(&model, &model.values, fold.omega, 1e-12).unwrap();
        let mut state = fold.state;
        let [a, b, c, d] = moved(&mut flow, 1, &mut state);
        let error = (state[0] - fold.state[0]).hypot(state[1] - fold.state[1]);
        assert!(error < 1e-12, "{} {} {error:e}", fold.figure, fold.omega);
        // Errors of the given state move the multipliers, those of unbounded stiffness most.
        let characteristic = (a - 1.0) * (d - 1.0) - b * c;
        assert!(
            characteristic.abs() < 2e-11,
            "{} {} {characteristic:e}",
            fold.figure,
            fold.omega
        );
        let product = a * d - b * c;
        let odd = !fold.one_sided && fold.load == 0.0;
        let exact = fold.multiplier.powi(if odd { 2 } else { 1 });
        assert!((product - exact).abs() < 1e-11, "{} {product}", fold.figure);
    }
}

#[test]
fn orbits_of_the_power_one_return_to_themselves() {
    let model = PowerForm::new(true, 1.0, 0.032, 1.0, 1.0);
    let orbits: [(usize, [f64; 2], [f64; 2]); 3] = [
        (
            1,
            [-1.9997761227576426582, 0.1782358746036854517],
            [-0.6555964496279292, 0.6155829202791328],
        ),
        (
            2,
            [-5.632060192753840953, 3.5265900786501795847],
            [-0.5247461910891712, 0.7333361541700191],
        ),
        (
            3,
            [-31.334287816436888456, 0.6053602851584004412],
            [-0.3807749245935372, 0.8178886625843435],
        ),
    ];
    for (periods, start, [real, imaginary]) in orbits {
        let mut flow = Integrated::new(&model, &model.values, 1.0, 1e-13).unwrap();
        let mut state = start;
        let [a, b, c, d] = moved(&mut flow, periods, &mut state);
        let error = (state[0] - start[0]).hypot(state[1] - start[1]);
        assert!(error < 1e-12, "{periods} {error:e}");
        assert!((0.5 * (a + d) - real).abs() < 1e-11);
        assert!((a * d - b * c - real.hypot(imaginary).powi(2)).abs() < 1e-11);
    }
}

#[test]
fn table_1_has_its_exact_multipliers() {
    for &(drive, start, [first, second]) in PERIOD_8 {
        let model = PowerForm::new(true, 1.0, 0.032, 1.0, drive);
        let mut flow = Integrated::new(&model, &model.values, 1.0, 1e-13).unwrap();
        let mut state = start;
        let [a, b, c, d] = moved(&mut flow, 8, &mut state);
        let error = (state[0] - start[0]).hypot(state[1] - start[1]);
        assert!(error < 1e-11, "{drive} {error:e}");
        assert!((a + d - first - second).abs() < 1e-10, "{drive}");
        assert!((a * d - b * c - first * second).abs() < 1e-10, "{drive}");
    }
}
