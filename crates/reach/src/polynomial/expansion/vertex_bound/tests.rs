use proptest::prelude::*;
use reachtube_scalar::TaylorTerm;

use super::*;
use crate::polynomial::expansion::angles::Angles;
use crate::polynomial::expansion::recentred::{RecentredPolynomial, Recentring};

/// Generates terms in an angle x, a variable y, and the sine and cosine of x.
fn terms() -> impl Strategy<Value = Vec<TaylorTerm<Interval>>> {
    let term = (prop::collection::vec(0..4_u8, 4), -2.0..2.0_f64)
        .prop_map(|(exponents, c)| TaylorTerm { exponents, coefficient: Interval::point(c) });
    prop::collection::vec(term, 1..8)
}

fn powers(plan: &Recentring, sides: [Interval; 2]) -> PowerTable {
    let mut highest = [0; 3];
    plan.raise_exponents(&mut highest);
    let mut powers = PowerTable::new(&highest);
    sides.iter().enumerate().for_each(|(i, side)| powers.set(i, *side));
    powers.set_angle(2, sides[0], [0.9, 0.1]);
    powers
}

/// Returns the range over a box without vertices and with at most `most` vertex factors.
fn ranges(
    plan: &Recentring,
    powers: &PowerTable,
    most: usize,
    work: &mut RecentredPolynomial,
) -> [Interval; 2] {
    let mut vertices = VertexBound::new(most, powers);
    let without = plan.remainder(powers, &mut vertices, work);
    plan.choose_vertex_factors(powers, &mut vertices, work);
    let with = plan.remainder(powers, &mut vertices, work);
    work.vertex_factors.clear();
    [without, with]
}

proptest! {
    #[test]
    fn vertices_enclose_every_value_and_only_tighten_symmetric_boxes(
        terms in terms(),
        z in [-1.0..1.0_f64, -1.0..1.0],
        lo in [-1.0..0.5_f64, -1.0..0.5],
        width in [0.0..1.0_f64, 0.0..1.0],
        points in prop::collection::vec([0.0..=1.0_f64, 0.0..=1.0], 20),
        most in 0..7_usize,
        is_symmetric: bool,
    ) {
        let angles = Angles::new(2, &[0], terms.iter());
        let (mut enclosed, mut bounds) = (angles.factors(), angles.magnitudes());
        angles.expand_at(0, z[0], 0.1, &mut enclosed);
        let mut factors: Vec<f64> = enclosed.iter().map(|x| x.mid()).collect();
        factors[..2].copy_from_slice(&z);
        bounds[..2].fill(1.0);
        let plan = Recentring::new(&angles, &terms);
        let mut work = plan.workspace();
        plan.recentre(&factors, &[0.5; 2], &mut work);
        plan.bound_errors(&bounds, &mut work);
        let lo = if is_symmetric { width.map(|width| -0.5 * width) } else { lo };
        let sides = [0, 1].map(|i| Interval::new(lo[i], lo[i] + width[i]).unwrap());
        let [without, with] = ranges(&plan, &powers(&plan, sides), most, &mut work);
        let near = without + Interval::centred(0.0, 1e-9);
        prop_assert!(!is_symmetric || near.encloses(&with), "{without:?} {with:?}");
        for point in points {
            let offset = |i: usize| lo[i] + point[i] * width[i];
            let d = [0, 1].map(|i| offset(i).clamp(sides[i].lo(), sides[i].hi()));
            let [value, _] = ranges(&plan, &powers(&plan, d.map(Interval::point)), 0, &mut work);
            prop_assert!(
                value.intersection(with).is_some() && value.width() < 1e-9, "{value:?} {with:?}"
            );
        }
    }
}

/// The maximum of xy - yz + zx over [-1, 1]³ is 1, since its terms are not large together.
#[test]
fn a_multiaffine_polynomial_has_its_exact_range() {
    let term = |exponents: [u8; 3], c: f64| TaylorTerm {
        exponents: exponents.to_vec(),
        coefficient: Interval::point(c),
    };
    let terms = [term([1, 1, 0], 1.0), term([0, 1, 1], -1.0), term([1, 0, 1], 1.0)];
    let plan = Recentring::new(&Angles::new(3, &[], terms.iter()), &terms);
    let mut work = plan.workspace();
    plan.recentre(&[0.0; 3], &[1.0; 3], &mut work);
    plan.bound_errors(&[1.0; 3], &mut work);
    let mut powers = PowerTable::new(&[1; 3]);
    (0..3).for_each(|i| powers.set(i, Interval::new(-1.0, 1.0).unwrap()));
    let [without, with] = ranges(&plan, &powers, 3, &mut work);
    let is_near = |x: Interval, lo: f64| x.lo() <= lo && x.lo() > lo - 1e-12;
    assert!(is_near(without, -3.0) && is_near(-without, -3.0));
    assert!(is_near(with, -3.0) && is_near(-with, -1.0), "{with:?}");
}

/// With as many factors as variables, the bound is the extremum over all vertices: for factors
/// that are lanes of a vector only, for others beside them, and for more than fit into a block.
#[test]
fn all_vertices_are_tried_for_any_number_of_factors() {
    for n in [2, 3, 7, 13] {
        let term = |i: usize, j: usize| {
            let mut exponents = vec![0; n];
            (exponents[i], exponents[j]) = (1, 1);
            let c = f64::from((7 * i + 3 * j) as u8 % 11) - 5.0;
            TaylorTerm { exponents, coefficient: Interval::point(c) }
        };
        let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        let terms: Vec<_> = pairs.map(|(i, j)| term(i, j)).collect();
        let value = |vertex: usize| -> f64 {
            let sign = |i: usize| if vertex >> i & 1 == 1 { 1.0 } else { -1.0 };
            let of = |term: &TaylorTerm<Interval>| {
                let factors = term.exponents.iter().enumerate().filter(|(_, e)| **e == 1);
                term.coefficient.mid() * factors.map(|(i, _)| sign(i)).product::<f64>()
            };
            terms.iter().map(of).sum()
        };
        let values = (0..1 << n).map(value);
        let [lo, hi] = values.fold([0.0_f64; 2], |[lo, hi], x| [lo.min(x), hi.max(x)]);
        let plan = Recentring::new(&Angles::new(n, &[], terms.iter()), &terms);
        let mut work = plan.workspace();
        plan.recentre(&vec![0.0; n], &vec![1.0; n], &mut work);
        plan.bound_errors(&vec![1.0; n], &mut work);
        let mut powers = PowerTable::new(&vec![1; n]);
        (0..n).for_each(|i| powers.set(i, Interval::new(-1.0, 1.0).unwrap()));
        let [_, with] = ranges(&plan, &powers, n, &mut work);
        assert!(with.lo() <= lo && with.lo() > lo - 1e-9, "{n}: {with:?} {lo}");
        assert!(with.hi() >= hi && with.hi() < hi + 1e-9, "{n}: {with:?} {hi}");
    }
}
