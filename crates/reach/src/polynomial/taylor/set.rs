//! The reachable set as Taylor models with a zonotope of offsets.

use std::sync::Arc;

use reachtube_scalar::{Interval, TaylorBox, TaylorModel, TaylorPolynomial, TaylorSpace};

use crate::polynomial::taylor::offset::Offset;
use crate::sets::zonotope::Zonotope;

/// The set {p(s) + e : s in [-1, 1]^N, e in E} with polynomials p in the coordinates of the initial
/// box and offsets e.
#[derive(Debug, Clone)]
pub(crate) struct TaylorSet {
    /// The polynomials p, as Taylor models without remainders, N.
    pub polynomials: Vec<TaylorModel>,
    /// Ranges of the polynomials, N.
    pub ranges: Vec<Interval>,
    /// The offsets E.
    pub offset: Offset,
}

impl TaylorSet {
    /// Creates a box, with polynomials up to the order of `space`.
    ///
    /// Beyond `most_generators` generators of the offsets, the oldest become a box.
    pub(crate) fn new(
        space: &Arc<TaylorSpace>,
        sides: &[Interval],
        most_generators: usize,
    ) -> Self {
        let polynomials = TaylorBox::new(space, sides).variables();
        let ranges = polynomials.iter().map(TaylorModel::range).collect();
        Self { polynomials, ranges, offset: Offset::zero(sides.len(), most_generators) }
    }

    /// Iterates over the sides of the interval hull, N intervals.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn hull(&self) -> impl Iterator<Item = Interval> {
        self.ranges.iter().zip(self.offset.hull()).map(|(p, e)| *p + e)
    }

    /// Returns an enclosing zonotope: the linear terms, the offsets, and a box for the nonlinear
    /// terms.
    pub(crate) fn zonotope(&self) -> Zonotope {
        let n = self.ranges.len();
        let (mut centre, mut columns) = (vec![0.0; n], vec![0.0; 2 * n * n]);
        for (i, model) in self.polynomials.iter().enumerate() {
            let mut nonlinear = model.clone();
            for term in model.polynomial().truncated(1).terms() {
                let Some(z) = term.exponents.iter().position(|e| *e == 1) else { continue };
                columns[z * n + i] = term.coefficient;
                let space = model.polynomial().space().expect("a variable occurs");
                nonlinear -= TaylorModel::from(TaylorPolynomial::from_terms(space, [term]));
            }
            let along_axis = Interval::centred(0.0, self.offset.along_axis(i));
            let range = nonlinear.tight_range() + along_axis;
            centre[i] = range.mid();
            columns[n * n + i * n + i] = range.rad();
        }
        columns.extend(self.offset.generators());
        Zonotope::new(centre, columns)
    }
}
