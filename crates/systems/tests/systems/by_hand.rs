//! Smallest sets that are known by hand, as exact fractions.

use reachtube_systems::SystemModel;

use crate::{run, system};

/// x' = x / 2 + w from x = 4, with the outputs 4, 2, 3/2, 1: the nominal ones are 4, 2, 1, 1/2.
///
/// With W = [-r, r], outputs reach r (0, 1, 3/2, 7/4), so that r >= 0, (1/2) / (3/2) = 1/3 and
/// (1/2) / (7/4) = 2/7: r = 1/3. With the cost of the widths 2 r (0 + 1 + 3/2 + 7/4), 1 s each, it
/// is 17/6.
#[test]
fn a_disturbance_of_one_third() {
    let system = system(
        "kind = 'discrete'\nstep = 1.0\nstates = ['x']\noutputs = ['x']\nA = [[0.5]]\n\
         start = { at = [4.0] }\nweights = [1.0]\n[sets]\nX0 = 'none'\ncentre = 'zero'",
    );
    let runs = [run("one", 1.0, &[], &[4.0, 2.0, 1.5, 1.0], 1)];
    let model = system.conform(&runs).unwrap().model;
    assert!(model.verified);
    let found = model.sets.disturbance.scale[0];
    assert!((found - 1.0 / 3.0).abs() < 1e-12, "{found}");
    assert!((model.cost - 17.0 / 6.0).abs() < 1e-12, "{}", model.cost);
    assert!(model.lower_bound <= 17.0 / 6.0 + 1e-9 && model.lower_bound > 17.0 / 6.0 - 1e-6);
    // Sets of one unit in the last place less do not hold.
    let mut less = model.clone();
    less.sets.disturbance.scale[0] = (1.0f64 / 3.0).next_down() * (1.0 - 1e-15);
    assert!(!less.check(&runs).unwrap().conformant && model.check(&runs).unwrap().conformant);
}

/// Two states of which the sum is seen, x1' = x2, x2' = -x1 (a quarter turn), from 0, and a box of
/// starts and of noise: y = x1 + x2 becomes x2 - x1, -x1 - x2, x1 - x2 of the start.
///
/// Recorded are 1, 3, 1 and -1. With X0 = c + [-r, r] and V = [-v, v], each sample has the reach
/// r1 + r2 + v, so that these cost the same; the cost is least with the centre that splits the rest
/// best: the outputs ±(c1 + c2), ±(c2 - c1) must be near 1, 3, -1 and 1 with the signs of the turn:
/// c1 + c2 near 1 and -1 (middle 0), c2 - c1 near 3 and 1 (middle 2). All are 1 off: 1 in all, and
/// the cost is 2 x 1 x 4 samples = 8.
#[test]
fn a_quarter_turn_seen_by_a_sum() {
    let text = |noise: &str| {
        format!(
            "kind = 'discrete'\nstep = 1.0\nstates = ['a', 'b']\noutputs = ['y']\n\
             A = [[0, 1], [-1, 0]]\nC = [[1, 1]]\nstart = {{ at = [0.0, 0.0] }}\n\
             weights = [1.0]\n[sets]\nW = 'none'\nV = {noise}"
        )
    };
    let runs = [run("one", 1.0, &[], &[1.0, 3.0, 1.0, -1.0], 1)];
    for noise in ["'none'", "'box'"] {
        let model = system(&text(noise)).conform(&runs).unwrap().model;
        assert!(model.verified);
        assert!((model.cost - 8.0).abs() < 1e-12, "{noise}: {}", model.cost);
        let sets = &model.sets;
        let all: f64 = sets.start.scale.iter().chain(&sets.noise.scale).sum();
        assert!((all - 1.0).abs() < 1e-12, "{all}");
        let [a, b] = [sets.start.centre[0], sets.start.centre[1]];
        assert!((a + b).abs() < 1e-12 && (b - a - 2.0).abs() < 1e-12, "{a} {b}");
    }
    // A noise that is known is taken off: three quarters are left.
    let known = system(&text("{ radius = [0.25], fixed = true }")).conform(&runs).unwrap().model;
    assert!((known.sets.start.scale.iter().sum::<f64>() - 0.75).abs() < 1e-12);
    assert!(known.verified && known.sets.noise.scale == [1.0]);
}

/// x' = -x + u with an input that acts 0.25 s later, between samples that are 1 s apart. The input
/// is 1 from the first sample to the third, and 0 then.
#[test]
fn an_input_that_is_late_by_a_quarter_of_a_step() {
    let system = system(
        "kind = 'continuous'\nstates = ['x']\ninputs = ['u']\noutputs = ['x']\nA = [[-1.0]]\n\
         B = [[1.0]]\nE = [[1.0]]\ndelay = { u = 0.25 }\nstart = { at = [0.5] }\n[sets]\n\
         X0 = { radius = [0.0], fixed = true }\nW = { radius = [0.0], fixed = true }",
    );
    // The input before the first sample is held: it is 1 up to 2.25 s.
    let solution = |t: f64| {
        let on = t.min(2.25);
        let at_end = 1.0 + (0.5 - 1.0) * (-on).exp();
        at_end * (-(t - on)).exp()
    };
    let outputs: Vec<f64> = (0..6).map(|k| solution(f64::from(k))).collect();
    let runs = [run("late", 1.0, &[1.0, 1.0, 0.0, 0.0, 0.0, 0.0], &outputs, 1)];
    let tube = SystemModel::given(&system).unwrap().reach(&runs).unwrap().remove(0);
    for (k, output) in outputs.iter().enumerate() {
        let [low, high] = [tube.bounds[0][k], tube.bounds[1][k]];
        assert!(low <= *output && *output <= high && high - low < 1e-13, "{k}: {low} {high}");
    }
}

/// Without a delay, a continuous system and its discrete one reach the same.
#[test]
fn rates_and_steps_agree() {
    let h = 0.1f64;
    let (decay, input) = ((-2.0 * h).exp(), 0.5 * (1.0 - (-2.0 * h).exp()));
    let continuous = "kind = 'continuous'\nA = [[-2.0]]\nB = [[1.0]]\n".to_string();
    let discrete = format!("kind = 'discrete'\nstep = {h}\nA = [[{decay}]]\nB = [[{input}]]\n");
    let rest = "states = ['x']\ninputs = ['u']\noutputs = ['x']\nstart = { at = [0.0] }\n\
                weights = [1.0]\n[sets]\nX0 = 'none'\ncentre = 'zero'";
    let inputs: Vec<f64> = (0..50).map(|k| f64::from(k % 7) - 3.0).collect();
    let mut outputs = vec![0.0];
    for k in 0..49 {
        let pushed = inputs[k] + 0.3 * f64::from((k % 5) as u8) - 0.6;
        outputs.push(decay * outputs[k] + input * pushed);
    }
    let runs = [run("one", h, &inputs, &outputs, 1)];
    let costs = [continuous, discrete].map(|of| {
        let model = system(&format!("{of}{rest}")).conform(&runs).unwrap().model;
        assert!(model.verified && model.sets.disturbance.scale[0] <= 0.6 + 1e-9);
        model.cost
    });
    assert!((costs[0] - costs[1]).abs() < 1e-9 * costs[0], "{costs:?}");
}
