//! Points that are known to lie in a zonotope, or outside, against what the library finds.

use reachtube_reach::{
    Disturbance, GeneratorRows, IntervalVector, Membership, MembershipProof, Place, Propagation,
    SampleGenerators, TimeGrid,
};
use reachtube_scalar::Interval;

use crate::arm::arm;
use crate::random::Random;

const SLACK: f64 = 1e-9;

/// A zonotope whose generators come from a chain of integrators with damping, as a robot's do: long
/// and nearly parallel ones among them.
fn zonotope(dimension: usize, count: usize, random: &mut Random) -> GeneratorRows {
    let mut rows = GeneratorRows::new(dimension, count);
    for i in 0..dimension {
        let size = 10f64.powf(2.0 * random.symmetric() - 1.0);
        for (j, x) in rows.row_mut(i).iter_mut().enumerate() {
            let along = (j as f64 / count as f64 * (i + 1) as f64).cos();
            *x = size * (along + 0.1 * random.symmetric()) / count as f64;
        }
    }
    rows
}

fn dot(x: &[f64], y: impl Iterator<Item = f64>) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

fn point(rows: &GeneratorRows, factors: &[f64]) -> Vec<f64> {
    (0..rows.dimension()).map(|i| dot(factors, rows.row(i).iter().copied())).collect()
}

/// The reach Σ |lᵀ g| along a direction.
fn reach(rows: &GeneratorRows, direction: &[f64]) -> f64 {
    let along =
        |j: usize| (0..rows.dimension()).map(|i| direction[i] * rows.row(i)[j]).sum::<f64>();
    (0..rows.count()).map(|j| along(j).abs()).sum()
}

#[test]
fn points_of_random_factors_are_proved_and_points_beyond_a_face_are_separated() {
    let mut random = Random::new(1);
    let mut proved = 0;
    for dimension in [1, 2, 3, 6, 12] {
        for count in [dimension, 2 * dimension + 1, 40, 400] {
            let rows = zonotope(dimension, count.max(dimension), &mut random);
            let set = Membership::new(&rows);
            let proof = MembershipProof::new(&set).expect("the generators span the states");
            let mut work = set.workspace();
            for at in 0..60 {
                // Every third point is a vertex: all factors are 1 or -1.
                let factor = |_| {
                    let x = random.symmetric();
                    if at % 3 == 0 { x.signum() * (1.0 - 2.0 * SLACK) } else { x }
                };
                let factors: Vec<f64> = (0..rows.count()).map(factor).collect();
                let inside = point(&rows, &factors);
                let scaled: Vec<f64> = inside.iter().map(|x| x / (1.0 - SLACK)).collect();
                let place = set.locate(&scaled, 1e-12, &mut work);
                assert_eq!(place, Place::Inside, "{dimension} {count} {at}");
                let none = vec![0.0; dimension];
                assert!(
                    proof.holds(&inside, &none, 1.0 - SLACK, &mut work),
                    "{dimension} {count} {at}"
                );
                proved += 1;
                // Beyond the face in a random direction.
                let direction: Vec<f64> =
                    (0..dimension).map(|i| random.symmetric() / rows.row(i)[0].abs()).collect();
                let along = |j: usize| (0..dimension).map(|i| direction[i] * rows.row(i)[j]).sum();
                let signs: Vec<f64> =
                    (0..rows.count()).map(|j| f64::signum(along(j)) * 1.001).collect();
                let outside = point(&rows, &signs);
                let Place::Outside { direction, ratio } = set.locate(&outside, 1e-9, &mut work)
                else {
                    panic!("{dimension} {count} {at}: not outside")
                };
                let exact = dot(&direction, outside.iter().copied()) / reach(&rows, &direction);
                assert!((exact - ratio).abs() < 1e-9 && exact > 1.0, "{exact} {ratio}");
                let (factor, _) = set.gauge(&outside, 1e-6, &mut work).unwrap();
                assert!((factor - 1.001).abs() < 1e-4, "{dimension} {count} {at}: {factor}");
            }
        }
    }
    assert_eq!(proved, 5 * 4 * 60);
}

#[test]
fn what_the_entries_may_be_wrong_by_counts_against_the_proof() {
    let mut rows = GeneratorRows::new(2, 2);
    rows.row_mut(0).copy_from_slice(&[1.0, 1.0]);
    rows.row_mut(1).copy_from_slice(&[1.0, -1.0]);
    for (error, holds) in [(0.0, true), (1e-3, true), (0.2, false)] {
        rows.set_error(0, error);
        let set = Membership::new(&rows);
        let proof = MembershipProof::new(&set).unwrap();
        let mut work = set.workspace();
        assert_eq!(set.locate(&[1.0, 0.8], 1e-12, &mut work), Place::Inside);
        assert_eq!(proof.holds(&[1.0, 0.8], &[0.0; 2], 1.0, &mut work), holds, "{error}");
        // A point that is not known exactly needs its whole neighbourhood inside.
        set.locate(&[1.0, 0.8], 1e-12, &mut work);
        assert!(!proof.holds(&[1.0, 0.8], &[0.2, 0.0], 1.0, &mut work));
    }
}

#[test]
fn a_set_without_width_in_a_state_has_no_proof() {
    let mut rows = GeneratorRows::new(2, 3);
    rows.row_mut(0).copy_from_slice(&[1.0, 1.0, 2.0]);
    let set = Membership::new(&rows);
    assert!(MembershipProof::new(&set).is_none());
}

/// Distinguishes `count` sampled states from states that no motion reaches, at one sample of the
/// arm's reachable set: states of random motions are proved to lie in the set, and for random
/// states of its hull either the factors are a motion or the direction is one that no motion
/// passes, as single steps of the system show.
fn tell_apart(count: usize) {
    let (system, h, k) = (arm(), 0.004, 150);
    let (n, m) = (system.states(), system.inputs());
    let propagation = Propagation::new(&system, &TimeGrid::uniform(h, k + 1)).unwrap();
    let (initial, input) = (vec![0.01; n], vec![0.5; m]);
    let generators = SampleGenerators::new(&propagation, Disturbance::Sample, 1).unwrap();
    let states: Vec<usize> = (0..n).collect();
    let rows = generators.at(k, [&initial, &input, &vec![0.0; n]], &states, 1);
    let set = Membership::new(&rows);
    let proof = MembershipProof::new(&set).unwrap();
    let hull: Vec<f64> = (0..n).map(|i| rows.row(i).iter().map(|x| x.abs()).sum()).collect();
    // One step of the system, from a solution of its own.
    let unit = |size: usize, j: usize| (0..size).map(|i| f64::from(i == j)).collect::<Vec<f64>>();
    let advance = |x: &[f64], u: &[f64]| -> Vec<f64> {
        let start = IntervalVector::from_iterator(n, x.iter().map(|x| Interval::point(*x)));
        let two = Propagation::new(&system, &TimeGrid::uniform(h, 2)).unwrap();
        let inputs = [u, u].concat();
        two.solve(&start, &inputs).state(1).iter().map(|x| x.mid()).collect()
    };
    let phi: Vec<Vec<f64>> = (0..n).map(|j| advance(&unit(n, j), &vec![0.0; m])).collect();
    let gamma: Vec<Vec<f64>> = (0..m).map(|j| advance(&vec![0.0; n], &unit(m, j))).collect();
    let combine = |columns: &[Vec<f64>], x: &[f64]| -> Vec<f64> {
        (0..n).map(|i| columns.iter().zip(x).map(|(c, x)| c[i] * x).sum()).collect()
    };
    let mut random = Random::new(5);
    let (mut work, none, slack) = (set.workspace(), vec![0.0; n], 1e-6);
    let (mut inside, mut outside) = (0, 0);
    for at in 0..count {
        if at % 2 == 0 {
            // A motion with a random input, every fourth one at the corners of the sets.
            let mut corner = |radius: f64| {
                let x = random.symmetric();
                if at % 4 == 0 { radius * x.signum() } else { radius * x }
            };
            let mut x: Vec<f64> = initial.iter().map(|r| corner(*r)).collect();
            for _ in 0..k {
                let u: Vec<f64> = input.iter().map(|r| corner(*r)).collect();
                let next = combine(&phi, &x).into_iter().zip(combine(&gamma, &u));
                x = next.map(|(x, u)| x + u).collect();
            }
            x.iter_mut().for_each(|x| *x *= 1.0 - 2.0 * slack);
            let scaled: Vec<f64> = x.iter().map(|x| x / (1.0 - slack)).collect();
            assert_eq!(set.locate(&scaled, 1e-9, &mut work), Place::Inside, "{at}");
            assert!(proof.holds(&x, &none, 1.0 - slack, &mut work), "{at}");
            continue;
        }
        let d: Vec<f64> = hull.iter().map(|r| 0.5 * r * random.symmetric()).collect();
        match set.locate(&d, 1e-9, &mut work) {
            Place::Inside => {
                let scaled: Vec<f64> = d.iter().map(|x| x / (1.0 - slack)).collect();
                let is_well_inside = set.locate(&scaled, 1e-9, &mut work) == Place::Inside;
                assert!(!is_well_inside || proof.holds(&d, &none, 1.0 - slack, &mut work), "{at}");
                inside += 1;
            }
            Place::Outside { direction, ratio } => {
                // The adjoint: lᵀ e^{A t} backward, step by step.
                let mut l = direction.clone();
                let dot = |x: &[f64], l: &[f64]| x.iter().zip(l).map(|(x, l)| x * l).sum::<f64>();
                let mut reach = 0.0;
                for _ in 0..k {
                    reach +=
                        gamma.iter().zip(&input).map(|(g, r)| dot(g, &l).abs() * r).sum::<f64>();
                    l = phi.iter().map(|column| dot(column, &l)).collect();
                }
                reach += l.iter().zip(&initial).map(|(l, r)| l.abs() * r).sum::<f64>();
                let along = dot(&d, &direction);
                assert!(along > reach && (along / reach / ratio - 1.0).abs() < 1e-9, "{at}");
                outside += 1;
            }
            Place::Unknown => panic!("{at}: no answer"),
        }
    }
    assert!(inside > count / 200 && outside > count / 200, "{inside} {outside}");
}

/// Multiples of one vector are merged, here among generators that alternate between two vectors.
/// Points of the merged set are proved to lie in it with the errors of its sums, and lie in the
/// whole one.
#[test]
fn merged_generators_span_a_smaller_set() {
    let mut random = Random::new(8);
    let mut rows = GeneratorRows::new(2, 101);
    let turn = |j: usize| 0.01 * j as f64 + if j.is_multiple_of(2) { 0.0 } else { 1.5 };
    rows.row_mut(0).iter_mut().enumerate().for_each(|(j, x)| *x = turn(j).cos());
    rows.row_mut(1).iter_mut().enumerate().for_each(|(j, x)| *x = turn(j).sin());
    let merged = rows.merged(2, 10);
    assert_eq!(merged.count(), 11);
    let (whole, set) = (Membership::new(&rows), Membership::new(&merged));
    let (mut of_whole, mut work) = (whole.workspace(), set.workspace());
    for at in 0..1_000 {
        let factors: Vec<f64> = (0..11).map(|_| 0.999 * random.symmetric()).collect();
        let d: Vec<f64> = (0..2)
            .map(|i| merged.row(i).iter().zip(&factors).map(|(g, factor)| g * factor).sum())
            .collect();
        assert_eq!(set.locate(&d, 1e-9, &mut work), Place::Inside, "{at}");
        assert_eq!(whole.locate(&d, 1e-9, &mut of_whole), Place::Inside, "{at}");
    }
    // Hardly smaller: the vectors of a group turn by 0.2 rad.
    let size = |rows: &GeneratorRows| rows.row(0).iter().map(|x| x.abs()).sum::<f64>();
    assert!(size(&merged) <= size(&rows) && size(&merged) > 0.95 * size(&rows));
    assert!(merged.error(0) > 0.0 && merged.error(0) < 1e-12);
}

#[test]
fn sampled_states_are_told_apart() {
    tell_apart(4_000);
}

#[test]
#[ignore = "takes long: a million states"]
fn a_million_sampled_states_are_told_apart() {
    tell_apart(1_000_000);
}
