//! Time grids and boxes.

use proptest::prelude::*;
use reachtube_reach::{Hyperrectangle, ReachError, TimeGrid};

fn steps() -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(1e-4f64..0.1, 1..60)
}

fn times_of(steps: &[f64], origin: f64) -> Vec<f64> {
    let sums = steps.iter().scan(origin, |t, step| {
        *t += step;
        Some(*t)
    });
    std::iter::once(origin).chain(sums).collect()
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None, ..ProptestConfig::with_cases(300)
    })]

    #[test]
    fn recorded_times_are_kept_from_the_first_on(steps in steps(), origin in -10.0f64..1e4) {
        let times = times_of(&steps, origin);
        let grid = TimeGrid::from_times(&times).unwrap();
        prop_assert_eq!(grid.len(), times.len());
        prop_assert_eq!(grid.times()[0], 0.0);
        for (k, (kept, recorded)) in grid.times().iter().zip(&times).enumerate() {
            prop_assert!((kept - (recorded - origin)).abs() <= 1e-6 * steps[0].max(1e-5), "{k}");
        }
        for k in 1..grid.len() {
            let difference = grid.times()[k] - grid.times()[k - 1];
            prop_assert!(grid.interval(k - 1).contains(difference) || grid.step().is_some());
            prop_assert!(grid.interval(k - 1).hi() <= grid.longest_step());
        }
    }

    #[test]
    fn a_fixed_rate_is_found_wherever_it_starts(
        step in 1u32..5000, count in 2usize..400, origin in 0u32..1_000_000,
    ) {
        let (step, origin) = (f64::from(step) * 1e-4, f64::from(origin) * 1e-3);
        let time = |k: usize| format!("{:.6}", origin + k as f64 * step).parse::<f64>().unwrap();
        let grid = TimeGrid::from_times(&(0..count).map(time).collect::<Vec<_>>()).unwrap();
        prop_assert!(grid.step().is_some_and(|h| (h - step).abs() < 1e-9 * step));
    }

    #[test]
    fn a_prefix_of_a_prefix_is_a_prefix(
        steps in steps(), short in 0usize..70, long in 0usize..70,
    ) {
        let grid = TimeGrid::from_times(&times_of(&steps, 0.0)).unwrap();
        let (short, long) = (short.min(long), short.max(long));
        let (first, second) = (grid.prefix(short), grid.prefix(long));
        prop_assert!(first.is_prefix_of(&second) && second.is_prefix_of(&grid));
        prop_assert!(first.is_prefix_of(&grid));
        prop_assert_eq!(second.is_prefix_of(&first), first.len() == second.len());
        prop_assert_eq!(first.len(), short.min(grid.len()));
    }

    #[test]
    fn one_late_sample_ends_a_prefix(steps in steps(), at in 0usize..60) {
        let grid = TimeGrid::from_times(&times_of(&steps, 0.0)).unwrap();
        let mut times = grid.times().to_vec();
        let at = 1 + at % steps.len();
        times[at..].iter_mut().for_each(|t| *t += 1e-4);
        let late = TimeGrid::from_times(&times).unwrap();
        prop_assert!(!late.is_prefix_of(&grid) && !grid.is_prefix_of(&late));
        prop_assert!(late.prefix(at).is_prefix_of(&grid) || late.step().is_some());
    }

    #[test]
    fn times_that_do_not_increase_are_errors(steps in steps(), at in 0usize..60) {
        let mut times = times_of(&steps, 2.0);
        let at = 1 + at % steps.len();
        times[at] = times[at - 1];
        let expected = ReachError::Times { index: at, time: times[at], previous: times[at - 1] };
        prop_assert_eq!(TimeGrid::from_times(&times), Err(expected));
    }

    #[test]
    fn a_box_is_valid_when_every_bound_is_in_order(
        centre in proptest::collection::vec(-10.0f64..10.0, 1..6), radius in -1.0f64..1.0,
    ) {
        let set = Hyperrectangle { radius: vec![radius; centre.len()], centre };
        prop_assert_eq!(set.is_valid(), radius >= 0.0);
        let ordered = (0..set.dimension()).all(|i| set.bounds(i).0 <= set.bounds(i).1);
        prop_assert_eq!(set.is_valid(), ordered);
    }
}

#[test]
fn invalid_boxes_are_recognised() {
    let set = |centre: &[f64], radius: &[f64]| Hyperrectangle {
        centre: centre.to_vec(),
        radius: radius.to_vec(),
    };
    assert!(Hyperrectangle::zero(3).is_valid() && set(&[], &[]).is_valid());
    assert!(!set(&[0.0], &[]).is_valid());
    assert!(!set(&[f64::NAN], &[1.0]).is_valid());
    assert!(!set(&[0.0], &[f64::INFINITY]).is_valid());
}

#[test]
fn times_closer_than_a_picosecond_or_not_finite_are_errors() {
    for times in [
        &[0.0, 1e-13][..],
        &[f64::NAN],
        &[f64::INFINITY, 1.0],
        &[0.0, f64::INFINITY],
        &[-1e308, 1e308],
    ] {
        assert!(TimeGrid::from_times(times).is_err(), "{times:?}");
    }
}

#[test]
fn a_recorded_time_near_a_multiple_of_the_step_is_not_that_multiple() {
    // The product 3 · 0.9 rounds to 2.7.
    let uniform = TimeGrid::uniform(0.9, 10);
    let recorded = TimeGrid::from_times(&[0.0, 0.9, 1.8, 2.7, 4.0]).unwrap().prefix(4);
    assert_eq!((recorded.step(), recorded.times()), (None, &uniform.times()[..4]));
    assert!(!recorded.is_prefix_of(&uniform));
    assert!(recorded.prefix(2).is_prefix_of(&uniform));
}

#[test]
#[should_panic(expected = "above 0")]
fn a_step_of_zero_panics() {
    TimeGrid::uniform(0.0, 5);
}
