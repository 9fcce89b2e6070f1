use proptest::prelude::*;
use reachtube_scalar::{TaylorPolynomial, TaylorSpace};

use super::*;

fn terms() -> impl Strategy<Value = Vec<TaylorTerm<Interval>>> {
    let term = (prop::collection::vec(0..4_u8, 3), -2.0..2.0_f64)
        .prop_map(|(exponents, c)| TaylorTerm { exponents, coefficient: Interval::point(c) });
    prop::collection::vec(term, 1..8)
}

proptest! {
    #[test]
    fn a_recentred_polynomial_has_the_same_values(
        terms in terms(),
        z in [-2.0..2.0_f64, -2.0..2.0, -2.0..2.0],
        d in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
    ) {
        let space = TaylorSpace::new(3, 12).unwrap();
        let plan = Recentring::new(&Angles::new(3, &[], terms.iter()), &terms);
        let mut work = plan.workspace();
        plan.recentre(&z, &[0.5; 3], &mut work);
        plan.bound_errors(&[2.0; 3], &mut work);
        // The error bounds hold for |d| <= 2, and grow with the terms' largest magnitudes there.
        let largest = |term: &TaylorTerm<Interval>| {
            let powers = term.exponents.iter().zip(&z);
            let powers = powers.map(|(e, z)| (z.abs() + 2.0).powi(i32::from(*e)));
            term.coefficient.mag() * powers.product::<f64>()
        };
        let scale: f64 = terms.iter().map(largest).sum();
        let polynomial = TaylorPolynomial::from_terms(&space, terms);
        let exact = polynomial.shifted(&z.map(Interval::point));
        prop_assert!(exact.constant_term().intersection(plan.constant(&work)).is_some());
        let mut highest = [0; 3];
        plan.raise_exponents(&mut highest);
        let mut powers = PowerTable::new(&highest);
        d.iter().enumerate().for_each(|(i, d)| powers.set(i, Interval::point(*d)));
        let linear = plan
            .gradient(&work)
            .fold(plan.constant(&work), |sum, (i, slope)| sum + slope * d[i]);
        let mut vertices = VertexBound::new(0, &powers);
        let sum = linear + plan.remainder(&powers, &mut vertices, &mut work);
        prop_assert!(exact.evaluate(&d.map(Interval::point)).intersection(sum).is_some());
        prop_assert!(sum.width() <= 1e-13 * scale + 1e-300, "{} of {scale}", sum.width());
    }

    /// The polynomial is one in an angle x, its sine and its cosine.
    #[test]
    fn a_recentred_trigonometric_polynomial_has_the_same_values(
        terms in terms(), z in -2.0..2.0_f64, d in -1.0..1.0_f64,
        line in 0.0..=1.0_f64, middle in 0.0..=1.0_f64,
    ) {
        let angles = Angles::new(1, &[0], terms.iter());
        let (mut enclosed, mut bounds) = (angles.factors(), angles.magnitudes());
        angles.expand_at(0, z, middle, &mut enclosed);
        let mut factors: Vec<f64> = enclosed.iter().map(|x| x.mid()).collect();
        (factors[0], bounds[0]) = (z, 2.0);
        let plan = Recentring::new(&angles, &terms);
        let mut work = plan.workspace();
        plan.recentre(&factors, &[0.5], &mut work);
        plan.bound_errors(&bounds, &mut work);
        let mut highest = [0; 2];
        plan.raise_exponents(&mut highest);
        let (mut powers, offset) = (PowerTable::new(&highest), Interval::point(d));
        powers.set(0, offset);
        powers.set_angle(1, offset, [line, middle]);
        let linear = plan.gradient(&work).fold(plan.constant(&work), |sum, (i, slope)| {
            sum + angles.chain_slope(i, slope, &[line]).1 * d
        });
        let mut vertices = VertexBound::new(0, &powers);
        let sum = linear + plan.remainder(&powers, &mut vertices, &mut work);
        let (x, (sine, cosine)) = (offset + z, (offset + z).sin_cos());
        let power = |t: &TaylorTerm<Interval>| {
            let [a, b, c] = [0, 1, 2].map(|i| i32::from(t.exponents[i]));
            t.coefficient * x.powi(a) * sine.powi(b) * cosine.powi(c)
        };
        let exact: Interval = terms.iter().map(power).sum();
        prop_assert!(
            exact.intersection(sum).is_some() && sum.width() < 1e-9, "{exact:?} {sum:?}"
        );
    }
}

#[test]
fn a_square_is_not_negative() {
    let square = TaylorTerm { exponents: vec![2], coefficient: Interval::ONE };
    let plan = Recentring::new(&Angles::new(1, &[], [].iter()), &[square]);
    let mut powers = PowerTable::new(&[2]);
    powers.set(0, Interval::new(-1.0, 1.0).unwrap());
    let mut work = plan.workspace();
    plan.recentre(&[3.0], &[1.0], &mut work);
    plan.bound_errors(&[3.0], &mut work);
    let range = plan.remainder(&powers, &mut VertexBound::new(0, &powers), &mut work);
    assert!(range.lo() == 0.0 && (1.0..1.0 + 1e-12).contains(&range.hi()));
}
