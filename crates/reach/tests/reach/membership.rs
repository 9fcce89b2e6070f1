//! Points that are known to lie in a zonotope, or outside, against what the library finds.

use reachtube_reach::{GeneratorRows, Membership, MembershipProof, Place};

use crate::random::Random;

const SLACK: f64 = 1e-9;

/// A zonotope whose generators are those of a chain of integrators with damping, as a robot's are:
/// long and nearly parallel ones among them.
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
