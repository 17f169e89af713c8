use super::{PhaseResonance, Resonance};
use crate::continuation::jacobian::Jacobian;
use crate::continuation::problem::Problem;
use crate::testing::allocations::count;

crate::oscillator! {
    Contact(x) {
        param drive;
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

#[test]
fn evaluations_do_not_allocate() {
    let model = Contact { drive: 0.1 };
    let request = PhaseResonance::of(&model);
    let balance = request.balance(&[0.1], 1.1);
    let mut equations = Resonance::new(balance, vec![0.1], 0, 1.0, 1.0);
    let n = equations.unknowns();
    let mut jacobian = Jacobian::new(equations.partition());
    let (mut u, mut residual) = (vec![0.0; n + 1], vec![0.0; n]);
    // An orbit that loses contact, at frequency 1.1 and amplitude 0.1.
    (u[0], u[1], u[n - 1], u[n]) = (1.0, 1.5, 1.1, 0.1);
    let mut evaluate = || {
        jacobian.clear();
        equations.evaluate(&u, &mut residual, Some(&mut jacobian));
        equations.evaluate(&u, &mut residual, None);
    };
    // A rule of quadrature that is met for the first time is made then.
    evaluate();
    assert_eq!(count(evaluate), 0);
}
