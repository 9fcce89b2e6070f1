//! Parameters that are found from recordings.

use reachtube_systems::SystemRun;

use crate::{run, system, wrong};

const LAG: &str = "kind = 'continuous'\nstates = ['v']\ninputs = ['u']\noutputs = ['v']\n\
                   A = [['-1 / tau']]\nB = [['gain / tau']]\ndelay = { u = 'late' }\n[parameters]\n\
                   tau = { start = 0.5, low = 0.05, high = 2.0 }\n\
                   gain = { start = 1.0, low = 0.1, high = 5.0 }\n\
                   late = { start = 0.01, low = 0.0, high = 0.2 }\n";

/// Steps of the input through a lag of 0.2 s with the gain 1.5, 0.037 s later, every 25 ms.
fn runs() -> Vec<SystemRun> {
    let (tau, gain, late, h) = (0.2f64, 1.5, 0.037, 0.025);
    let one = |number: usize| {
        let inputs: Vec<f64> =
            (0..120).map(|k| f64::from(((k / 20 + number) * 7 % 5) as u8) - 2.0).collect();
        let input = |t: f64| inputs[(t / h).floor().max(0.0) as usize];
        let (mut v, mut outputs) = (0.0, vec![0.0]);
        for k in 0..119 {
            // The input changes once in each step, at a time that is known.
            let parts = 0.012;
            let t = f64::from(k) * h;
            for (from, length) in [(t, parts), (t + parts, h - parts)] {
                let target = gain * input(from - late + 1e-9);
                v = target + (v - target) * (-length / tau).exp();
            }
            outputs.push(v);
        }
        run(&format!("run {number}"), h, &inputs, &outputs, 1)
    };
    (0..5).map(one).collect()
}

#[test]
fn a_lag_with_a_delay_of_parts_of_a_sample_is_found() {
    let made = system(LAG).conform(&runs()).unwrap();
    let value = |name: &str| made.model.system.parameters[name].start;
    for (name, expected) in [("tau", 0.2), ("gain", 1.5), ("late", 0.037)] {
        assert!((value(name) - expected).abs() < 1e-6, "{name}: {}", value(name));
    }
    assert!(made.model.verified && made.is_useful());
    assert!(made.model.outputs[0].mean < 1e-5, "{:?}", made.model.outputs);
    // Every second recording was judged by parameters and sets of the others.
    assert_eq!((made.model.left_out.runs, made.model.left_out.is_in_turn), (2, false));
}

#[test]
fn parameters_at_bounds_and_copies_are_named() {
    let mut runs = runs();
    let near = system(&LAG.replace("low = 0.05, high = 2.0", "low = 0.3, high = 2.0"));
    let found = near.conform(&runs).unwrap();
    let of = |found: &reachtube_systems::MadeSystem| -> Vec<String> {
        found.findings.iter().map(|finding| finding.text.clone()).collect()
    };
    assert!(of(&found)[0].starts_with("The parameter tau is at its bound 0.3"), "{:?}", of(&found));
    runs.push(reachtube_systems::SystemRun { name: "again".into(), ..runs[1].clone() });
    let found = system(LAG).conform(&runs).unwrap();
    assert!(of(&found)[0].starts_with("again is a copy of run 1. "), "{:?}", of(&found));
}

#[test]
fn wrong_parameters_are_refused() {
    for (from, to, expected) in [
        ("'-1 / tau'", "'-1 / ta'", "ta is no parameter; there are gain, late, tau"),
        ("'-1 / tau'", "'-1 / '", "A has the formula \"-1 / \""),
        ("start = 0.5", "start = 5", "the parameter tau needs low <= start <= high"),
        ("'late'", "0.1", "no matrix and no delay has the parameter late"),
        ("gain", "e", "in formulas e is a constant"),
        ("'-1 / tau'", "'1 / (tau - tau)'", "A has an entry that is not finite"),
    ] {
        let found = wrong(&LAG.replace(from, to));
        assert!(found.contains(expected), "{to}: {found}");
    }
}
