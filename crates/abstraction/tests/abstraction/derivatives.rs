use proptest::prelude::*;
use reachtube_abstraction::{Linearisation, ModelKind};
use reachtube_robot::Robot;
use reachtube_scalar::Interval;

use crate::common::{model, number, numbers};

#[test]
fn intervals_enclose_numbers_and_derivatives_are_slopes() {
    let robot = Robot::lwa4p();
    let mut seed = 21;
    for (kind, order) in
        [(ModelKind::One, 3), (ModelKind::Two, 5), (ModelKind::Two, 12), (ModelKind::Three, 3)]
    {
        let model = model(&robot, kind, order);
        let derivatives = model.derivatives();
        for _ in 0..20 {
            let (q, qd, u) = (
                numbers(&mut seed, 6, 1.0),
                numbers(&mut seed, 6, 1.0),
                numbers(&mut seed, 6, 5.0),
            );
            let x = model.state(&q, &qd);
            let wide = |values: &[f64]| -> Vec<Interval> {
                values.iter().map(|v| Interval::centred(*v, 0.01)).collect()
            };
            let (rate, boxed) = (model.rate(&x, &u), model.rate(&wide(&x), &wide(&u)));
            assert!(rate.iter().zip(&boxed).all(|(r, b)| b.contains(*r)));
            let z: Vec<f64> =
                x[6..].iter().chain(&u).zip(model.origin()).map(|(z, o)| z - o).collect();
            let (place, h) = ((number(&mut seed).abs() * z.len() as f64) as usize, 1e-5);
            let at = |sign: f64| {
                let mut z = z.clone();
                z[place] += sign * h;
                model.acceleration()[2].evaluate(&z)
            };
            let slope = derivatives[2][place].evaluate(&z);
            assert!((slope - (at(1.0) - at(-1.0)) / (2.0 * h)).abs() < 1e-6 * (1.0 + slope.abs()));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// A and B are the slopes of the rate over (q, q̇, u), sines and cosines included.
    #[test]
    fn linearisations_are_slopes_of_the_rate(
        values in prop::collection::vec(-1.0..1.0, 18),
        index in 0usize..18,
        kind in prop::sample::select(vec![ModelKind::One, ModelKind::Two, ModelKind::Three]),
    ) {
        let model = model(&Robot::lwa4p(), kind, 3);
        let mut linearisation = Linearisation::new(&model);
        let (a, b) = linearisation.at(&values[..12], &values[12..]);
        let h = 1e-5;
        let at = |sign: f64| {
            let mut z = values.clone();
            z[index] += sign * h;
            model.rate(&model.state(&z[..6], &z[6..12]), &z[12..])
        };
        let (above, below) = (at(1.0), at(-1.0));
        for i in 0..12 {
            let slope = if index < 12 { a[(i, index)] } else { b[(i, index - 12)] };
            let expected = (above[i] - below[i]) / (2.0 * h);
            prop_assert!((slope - expected).abs() < 1e-6 * (1.0 + slope.abs()), "row {i}");
        }
    }
}
