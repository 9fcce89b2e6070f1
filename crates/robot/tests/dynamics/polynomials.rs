//! M, c and g as polynomials against the same as numbers.

use reachtube_robot::{Robot, Workspace};
use reachtube_scalar::{Interval, TaylorPolynomial};

use crate::close::assert_close;

#[test]
fn probe() {
    let robot = Robot::lwa4p();
    let t = std::time::Instant::now();
    let d = robot.polynomial_dynamics::<f64>().unwrap();
    let t1 = t.elapsed();
    let c = d.christoffel();
    let t2 = t.elapsed();
    let n = 6;
    let terms: usize = (0..n)
        .flat_map(|i| (0..=i).map(move |j| (i, j)))
        .map(|(i, j)| d.mass_matrix[i * n + j].term_count())
        .sum();
    let all: usize = d.mass_matrix.iter().map(|m| m.term_count()).sum();
    let cterms: usize = c.iter().flatten().map(|m| m.term_count()).sum();
    println!("{t1:?} {t2:?} M {terms} {all} C {cterms}");
    let small: usize =
        d.mass_matrix.iter().map(|m| m.terms().iter().filter(|t| t.coefficient.abs() < 1e-15).count()).sum();
    println!("small {small}");
    let degrees: Vec<_> = d.mass_matrix.iter().map(|m| m.degree()).collect();
    println!("{degrees:?} {:?}", d.gravity.iter().map(|g| (g.degree(), g.term_count())).collect::<Vec<_>>());
    let t = std::time::Instant::now();
    let d = robot.polynomial_dynamics::<Interval>().unwrap();
    let c = d.christoffel();
    println!("interval {:?} {}", t.elapsed(), c.iter().flatten().map(|m| m.term_count()).sum::<usize>());
}
