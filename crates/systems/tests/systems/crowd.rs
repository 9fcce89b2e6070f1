//! Sets of many generators, in many short recordings.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use reachtube_systems::{OutputSystem, SystemModel, SystemRun};

use crate::{run, system};

/// Walkers whose acceleration lies in a polygon of some generators, each times the same factor.
fn walkers(generators: usize) -> OutputSystem {
    let one = |k: usize| {
        let angle = std::f64::consts::PI * k as f64 / generators as f64;
        format!("[{}, {}]", angle.cos(), angle.sin())
    };
    let all: Vec<String> = (0..generators).map(one).collect();
    system(&format!(
        "kind = 'discrete'\nstep = 0.4\nstates = ['px', 'py', 'vx', 'vy']\noutputs = ['px', 'py']\n\
         A = [[1, 0, 0.4, 0], [0, 1, 0, 0.4], [0, 0, 1, 0], [0, 0, 0, 1]]\n\
         E = [[0.08, 0], [0, 0.08], [0.4, 0], [0, 0.4]]\n[sets]\n\
         X0 = {{ radius = [0.01, 0.01, 0.02, 0.02], fixed = true }}\n\
         W = {{ generators = [{}], scale = 'common' }}",
        all.join(", ")
    ))
}

fn crowd(count: usize, seed: u64) -> Vec<SystemRun> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut one = |number: usize| {
        let mut uniform = |size: f64| random.random_range(-size..size);
        let start: Vec<f64> = vec![uniform(9.0), uniform(9.0), uniform(1.5), uniform(1.5)];
        let mut state = start.clone();
        let mut outputs = vec![state[0], state[1]];
        for _ in 0..5 {
            for axis in 0..2 {
                let push = uniform(0.8);
                state[axis] += 0.4 * state[axis + 2] + 0.08 * push;
                state[axis + 2] += 0.4 * push;
            }
            outputs.extend(&state[..2]);
        }
        SystemRun { states: Some(start), ..run(&format!("walker {number}"), 0.4, &[], &outputs, 2) }
    };
    (0..count).map(&mut one).collect()
}

/// The least common factor is what a bisection over checks finds.
#[test]
fn a_common_factor_is_the_least_that_a_check_accepts() {
    let (system, runs) = (walkers(20), crowd(300, 7));
    let model = system.conform(&runs).unwrap().model;
    assert!(model.verified);
    let scale = model.sets.disturbance.scale.clone();
    assert!(scale.len() == 20 && scale.iter().all(|one| *one == scale[0]), "{scale:?}");
    let holds = |factor: f64| {
        let mut other: SystemModel = model.clone();
        other.sets.disturbance.scale.fill(factor);
        other.check(&runs).unwrap().conformant
    };
    let [mut low, mut high] = [0.0, 2.0];
    while high - low > 1e-13 {
        let middle = (low + high) / 2.0;
        if holds(middle) { high = middle } else { low = middle }
    }
    assert!((scale[0] - high).abs() < 1e-11, "{} {high}", scale[0]);
}

/// NominalMotions under disturbances in the sets lie in the sets, and some reach near their faces.
#[test]
fn motions_in_the_sets_lie_inside() {
    let (system, runs) = (walkers(3), crowd(40, 3));
    let model = system.conform(&runs).unwrap().model;
    let tube = model.reach(&runs[..1]).unwrap().remove(0);
    let start = runs[0].states.clone().unwrap();
    let w = &model.sets.disturbance;
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut nearest = f64::INFINITY;
    for _ in 0..200_000 {
        let mut sign = || if random.random_range(0..2) == 0 { -1.0 } else { 1.0 };
        let mut state: Vec<f64> =
            start.iter().zip([0.01, 0.01, 0.02, 0.02]).map(|(x, r)| x + sign() * r).collect();
        for k in 0..6 {
            for (axis, x) in state[..2].iter().enumerate() {
                let [low, high] = [0, 1].map(|side| tube.bounds[side][2 * k + axis]);
                let rounding = 1e-12;
                assert!(*x >= low - rounding && *x <= high + rounding);
                nearest = nearest.min((high - x) / (high - low));
            }
            let mut push = [0.0; 2];
            for (generator, scale) in w.generators.iter().zip(&w.scale) {
                let side = sign() * scale;
                (0..2).for_each(|axis| push[axis] += side * generator[axis]);
            }
            for axis in 0..2 {
                state[axis] += 0.4 * state[axis + 2] + 0.08 * push[axis];
                state[axis + 2] += 0.4 * push[axis];
            }
        }
    }
    assert!(nearest < 1e-9, "{nearest}");
}

/// 4,700 recordings of 6 samples, and every second one left out.
#[test]
fn a_large_crowd_is_held() {
    let made = walkers(20).conform(&crowd(4700, 11)).unwrap();
    assert!(made.is_useful() && made.model.left_out.runs == 2350, "{:?}", made.model.left_out);
    let factor = made.model.left_out.factor.unwrap();
    assert!((0.9..1.2).contains(&factor), "{factor}");
    assert!(made.findings.is_empty(), "{:?}", made.findings);
}
