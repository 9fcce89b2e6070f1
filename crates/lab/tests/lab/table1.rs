//! Tests of the models on random motions against Table I of the paper.

use reachtube_abstraction::ModelKind::{One, Three, Two};
use reachtube_lab::reproduce::{Paper, Speed, Table1, Table1Options, table1};

fn table(orders: &[u32], motions: usize) -> Table1 {
    table_within(Table1Options::default().range, orders, motions)
}

fn table_within(range: f64, orders: &[u32], motions: usize) -> Table1 {
    let options =
        Table1Options { motions, orders: orders.to_vec(), model3_up_to: 3, seed: 2, range };
    table1(&options, &|_, _| ()).unwrap()
}

#[test]
fn at_order_one_the_models_have_one_error() {
    let table = table(&[1], 16);
    for speed in Speed::ALL {
        let one = table.cell(One, 1, speed).unwrap();
        assert_eq!((one.errors.len(), one.diverged), (16, 0));
        for kind in [Two, Three] {
            let other = table.cell(kind, 1, speed).unwrap();
            for (a, b) in one.errors.iter().zip(&other.errors) {
                assert!((a.unwrap() - b.unwrap()).abs() < 1e-13, "{kind:?}");
            }
        }
    }
}

/// The oracle is the range that another simulation gave over three random motions within the
/// joints' limits (lwa4p/README.md of the shared data), at p = 1 and 3.
#[test]
fn the_error_of_model_1_has_its_known_size() {
    let table = table_within(4.0, &[1, 3], 16);
    for (order, speed, expected) in [
        (1, Speed::Slow, 0.005..0.010),
        (1, Speed::Fast, 0.05..0.07),
        (3, Speed::Slow, 0.004..0.009),
        (3, Speed::Fast, 0.049..0.065),
    ] {
        let mean = table.cell(One, order, speed).unwrap().mean.unwrap();
        assert!(expected.contains(&mean), "p = {order}, {speed:?}: {mean}");
    }
}

/// Model 2 is worse than model 1 at p = 3 and better at p = 7, and model 3 diverges at p = 3.
#[test]
fn the_models_are_in_the_papers_order() {
    let table = table(&[3, 7], 16);
    let mean = |kind, order, speed| table.cell(kind, order, speed).unwrap().mean.unwrap();
    for speed in Speed::ALL {
        assert!(mean(Two, 3, speed) > mean(One, 3, speed));
        assert!(mean(Two, 7, speed) < 0.9 * mean(One, 7, speed));
        assert!((mean(One, 7, speed) - mean(One, 3, speed)).abs() < 1e-13);
        let three = table.cell(Three, 3, speed).unwrap();
        assert_eq!((three.paper, three.diverged > 0), (Some(Paper::Diverged), true));
        assert_eq!(three.errors.iter().filter(|error| error.is_none()).count(), three.diverged);
    }
    assert!(table.cell(Three, 7, Speed::Fast).is_none());
}

/// A motion does not depend on the other motions and orders.
#[test]
fn errors_depend_on_seed_and_motion_alone() {
    let (few, many) = (table(&[3], 2), table(&[1, 3], 5));
    for cell in &few.cells {
        assert_eq!(cell.errors[..], many.cell(cell.model, 3, cell.speed).unwrap().errors[..2]);
    }
    let nothing = Table1Options { motions: 0, ..Default::default() };
    let refused = table1(&nothing, &|_, _| ()).unwrap_err().to_string();
    assert!(refused.contains("give at least 1"));
}
