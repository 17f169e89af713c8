//! The flow against values known from elsewhere, against closed forms, and against an independent integration.

mod conservation;
mod ladder;
mod linear;
mod random;
mod reference;
mod several;
mod system;
mod touch;

use std::f64::consts::TAU;

use nalgebra::DMatrix;

use super::Affine;
use crate::model;
use crate::numeric::spectrum::eigenvalues;
use crate::system::{System, Variable};
use crate::testing::one_sided::{OneSided, one_sided};
use crate::time::{Flow, Tangent};

/// The flow of a system at the values in it.
fn flow(system: &dyn System, omega: f64) -> Affine {
    Affine::new(system, &model::values(system), omega).unwrap()
}

/// Initial states at `A = 1`, `omega = 1`. Computed independently from the closed-form flow in 80-bit arithmetic, confirmed with
/// 60 digits; period one by Newton's method on the closed form in 30 digits.
#[test]
fn known_periodic_orbits_return() {
    let model = one_sided(1.0);
    let mut flow = flow(&model, 1.0);
    let orbits: [(usize, [f64; 2], [f64; 2]); 3] = [
        (
            1,
            [-1.999_776_122_757_642_7, 0.178_235_874_603_685_45],
            [-0.655_596_449_627_929_2, 0.615_582_920_279_132_8],
        ),
        (
            2,
            [-5.632_060_192_753_841, 3.526_590_078_650_18],
            [-0.524_746_191_089_171_2, 0.733_336_154_170_019_1],
        ),
        (
            3,
            [-31.334_287_816_436_888, 0.605_360_285_158_400_4],
            [-0.380_774_924_593_537_2, 0.817_888_662_584_343_5],
        ),
    ];
    for (period, start, multiplier) in orbits {
        let mut state = start;
        let mut tangent = Tangent::of_state(1, None);
        flow.advance(
            0.0,
            TAU * period as f64,
            &mut state,
            Some(&mut tangent),
            None,
        )
        .unwrap();
        for (x, from) in state.iter().zip(start) {
            assert!((x - from).abs() < 1e-12, "{period}: {state:?}");
        }
        let found = eigenvalues(&DMatrix::from_vec(2, 2, tangent.columns));
        let error = (found[0].re - multiplier[0]).abs() + (found[0].im - multiplier[1]).abs();
        assert!(error < 1e-12, "{period}: {found:?}");
    }
}

/// Table 1 of the paper, with the multipliers that the orbits have exactly, from the same source.
#[test]
fn multipliers_of_period_eight() {
    let orbits: [(f64, [f64; 2], [f64; 2]); 6] = [
        (
            1.7798,
            [-0.330_466_471_111_865_83, 0.333_494_239_641_907_6],
            [0.990_263_429_435_609_6, 0.186_012_521_175_605_96],
        ),
        (
            1.7798,
            [-0.384_626_401_311_123_1, 0.340_688_523_675_724_2],
            [1.034_938_331_267_823, 0.177_099_782_036_897_86],
        ),
        (
            1.77982,
            [-0.344_162_498_155_966_3, 0.334_790_473_811_007_8],
            [0.990_563_979_830_023_9, 0.185_799_858_213_994_64],
        ),
        (
            1.77982,
            [-0.378_877_929_998_983_7, 0.339_514_192_230_480_6],
            [1.020_660_133_883_029_7, 0.179_724_163_521_181],
        ),
        (
            1.779_835,
            [-0.359_930_367_591_290_4, 0.336_589_677_479_782_7],
            [0.996_523_747_851_76, 0.184_458_432_999_697_83],
        ),
        (
            1.779_835,
            [-0.368_487_843_064_549_6, 0.337_773_136_606_999],
            [1.004_195_396_753_012_4, 0.182_895_767_402_616_54],
        ),
    ];
    for (drive, start, multipliers) in orbits {
        let model = one_sided(drive);
        let mut flow = flow(&model, 1.0);
        let mut state = start;
        let mut tangent = Tangent::of_state(1, Some(Variable::Parameter(2)));
        flow.advance(0.0, 8.0 * TAU, &mut state, Some(&mut tangent), None)
            .unwrap();
        let error = (state[0] - start[0]).abs() + (state[1] - start[1]).abs();
        assert!(error < 1e-11, "{drive}: {state:?}");
        let found = eigenvalues(&DMatrix::from_vec(2, 2, tangent.columns[..4].to_vec()));
        for (found, exact) in found.iter().zip(multipliers) {
            assert!(
                (found.re - exact).abs() < 1e-9 && found.im == 0.0,
                "{drive}: {found}"
            );
        }
    }
}
