//! Systems whose factors are found.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use reachtube_files::SealedFile;
use reachtube_systems::{MatrixEntry, MatrixRows, NominalStartRule, SystemModel, SystemRun};

use crate::{run, system};

const ARX: &str = "kind = 'arx'\nstep = 0.01\ninputs = ['u']\noutputs = ['y']";

/// y(k) = 1.6 y(k-1) - 0.7 y(k-2) + 0.1 u(k-3) + w, |w| <= `noise`.
fn runs(noise: f64, seed: u64) -> Vec<SystemRun> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut one = |number: usize| {
        let (mut u, mut y) = (vec![0.0; 3], vec![0.0; 3]);
        let mut level = 0.0;
        for k in 3..160 {
            if k % 20 == 0 {
                level = random.random_range(-1.0..1.0);
            }
            u.push(level);
            let w = if noise > 0.0 { random.random_range(-noise..noise) } else { 0.0 };
            y.push(1.6 * y[k - 1] - 0.7 * y[k - 2] + 0.1 * u[k - 3] + w);
        }
        run(&format!("run {number}"), 0.01, &u, &y, 1)
    };
    (0..16).map(&mut one).collect()
}

fn numbers(rows: &Option<MatrixRows>) -> Vec<Vec<f64>> {
    let number = |entry: &MatrixEntry| match entry {
        MatrixEntry::Number(number) => *number,
        MatrixEntry::Formula(text) => panic!("{text}"),
    };
    rows.iter().flatten().map(|row| row.iter().map(number).collect()).collect()
}

#[test]
fn factors_and_the_disturbance_are_found() {
    // W alone explains what is not known.
    let alone = format!("{ARX}\n[sets]\nV = 'none'");
    let made = system(&alone).conform(&runs(0.01, 5)).unwrap();
    let model = &made.model;
    assert!(model.verified && made.is_useful());
    assert_eq!(model.system.start, Some(NominalStartRule::Past { outputs: 2, inputs: 2 }));
    let a = numbers(&model.system.a);
    assert!((a[0][0] - 1.6).abs() < 0.01 && (a[0][1] + 0.7).abs() < 0.01, "{a:?}");
    let b = a[0][2..].to_vec();
    assert!((b[1] - 0.1).abs() < 0.01, "{b:?}");
    // Rows are of whole motions: the errors of some steps cancel.
    let w = model.sets.disturbance.scale[0];
    assert!((0.003..0.0101).contains(&w), "{w}");
    // A check of the same recordings compares the same samples.
    let own = model.check(&runs(0.01, 5)).unwrap();
    let compared: usize = model.recordings.iter().map(|of| of.samples).sum();
    assert!(own.conformant && own.values == compared, "{own:?}");
    // Other recordings of the same system need little more.
    let check = SystemModel::parse(&model.to_json(), "model.json".as_ref())
        .unwrap()
        .check(&runs(0.01, 6))
        .unwrap();
    let needed = check.runs.iter().map(|run| run.needed.unwrap()).fold(0.0, f64::max);
    assert!(needed < 1.5, "{needed}");
}

#[test]
fn a_system_without_noise_needs_sets_of_rounding_alone() {
    let made = system(ARX).conform(&runs(0.0, 8)).unwrap();
    assert!(made.model.verified);
    assert!(made.model.sets.disturbance.scale[0] < 1e-9, "{:?}", made.model.sets);
}
