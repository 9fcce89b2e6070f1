//! A point of a link as a function of the joints' positions, linearised with a proved remainder.

use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up, sqrt_up, sub_down};

use super::chain::{Chain, Posture};
use super::vector::{Vector, cross, dot, norm, norm_of_bounds, sub};

/// Number of generators up to which the largest norm is sought over all vertices.
const VERTEX_GENERATORS: usize = 10;

/// A bound of the relative rounding error of a sum of products of as many terms as there are
/// joints, about 2 n 2⁻⁵³.
const SUM_ERROR: f64 = 1e-14;

/// The position p(q) of a point of a link about a position q_c of the robot:
/// p(q) = p(q_c) + Σ_k J_k (q_k - q_c,k) + remainder. One q serves all coordinates, so that their
/// correlation is kept.
#[derive(Debug, Clone)]
pub(crate) struct LinearisedPoint {
    /// p(q_c), in the base frame \[m\].
    position: Vector,
    /// J_k = ∂p/∂q_k at q_c: z_k × (p - o_k) for a revolute joint, z_k for a prismatic one.
    columns: Vec<Vector>,
    /// Bounds of |J_k(q)| for q within `radii` of q_c.
    reach: Vec<f64>,
    /// Whether each joint is revolute.
    turns: Vec<bool>,
}

/// A ball in the base frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ball {
    /// Centre \[m\].
    pub centre: [f64; 3],
    /// Radius \[m\].
    pub radius: f64,
}

impl Default for LinearisedPoint {
    fn default() -> Self {
        let (columns, reach, turns) = (Vec::new(), Vec::new(), Vec::new());
        Self { position: [Interval::ZERO; 3], columns, reach, turns }
    }
}

impl LinearisedPoint {
    /// Linearises the point `p` of the joint frame of link `link` at a posture, for joints within
    /// `radii` of it.
    ///
    /// A joint before joint k turns J_k without changing its length. A joint m after it changes J_k
    /// by z_k × J_m. Hence |J_k(q)| <= |J_k(q_c)| + Σ_{m>k} |J_m| r_m.
    /// The lengths between the joints after it limit the distance from the axis, too.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn at(
        &mut self,
        chain: &Chain,
        posture: &Posture,
        (link, p): (usize, &Vector),
        radii: &[f64],
    ) {
        self.position = posture.frames[link].place(p);
        self.columns.clear();
        self.turns.clear();
        for k in 0..=link {
            let lever = || sub(&self.position, &posture.frames[k].origin);
            let turns = chain.turns(k);
            let axis = &posture.axes[k];
            self.columns.push(if turns { cross(axis, &lever()) } else { *axis });
            self.turns.push(turns);
        }
        self.reach.clear();
        self.reach.resize(link + 1, 0.0);
        let (mut later, mut length) = (0.0, 0.0);
        let mut outer = self.position;
        for k in (0..=link).rev() {
            let origin = posture.frames[k].origin;
            length = add_up(length, norm(&sub(&outer, &origin)));
            outer = origin;
            let own = norm(&self.columns[k]);
            self.reach[k] = if self.turns[k] { add_up(own, later).min(length) } else { own };
            later = add_up(later, mul_up(self.reach[k], radii[k]));
            if !self.turns[k] {
                length = add_up(length, radii[k]);
            }
        }
    }

    /// Returns p(q_c), rounded to nearest.
    pub(crate) fn centre(&self) -> [f64; 3] {
        self.position.map(Interval::mid)
    }

    /// Encloses the point for joints within `radii` of the posture.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn ball(&self, radii: &[f64]) -> Ball {
        let centre = self.centre();
        let rounding = norm(&core::array::from_fn(|i| self.position[i] - centre[i]));
        let linear = self.largest_shift(radii.iter().map(|r| Interval::centred(0.0, *r)));
        let remainder = mul_up(0.5, self.second_order(radii, radii));
        let shift = add_up(linear, remainder).min(self.first_order(radii));
        Ball { centre, radius: add_up(rounding, shift) }
    }

    /// Returns a lower bound of n · p(q) for joints within `radii` of the posture. In one direction
    /// the image of the joints' box is narrower than the ball around it.
    ///
    /// # Guarantee
    ///
    /// A lower bound, directed rounding.
    pub(crate) fn lowest(&self, n: &Vector, radii: &[f64]) -> f64 {
        let along = self.columns.iter().zip(radii);
        let linear =
            along.fold(0.0, |sum, (column, r)| add_up(sum, mul_up(dot(n, column).mag(), *r)));
        let remainder = mul_up(0.5, self.second_order(radii, radii));
        let length = norm(n);
        let shift = add_up(linear, mul_up(length, remainder));
        let shift = shift.min(mul_up(length, self.first_order(radii)));
        let lowest = sub_down(dot(n, &self.position).lo(), shift);
        if lowest.is_nan() { f64::NEG_INFINITY } else { lowest }
    }

    /// Bounds the distance |p(q + e) - p(q)| for q within `moved` of the posture and e in `shift`;
    /// the radii given to [`at`](Self::at) must cover both together.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn distance(&self, moved: &[f64], shift: &[Interval], sizes: &[f64]) -> f64 {
        let linear = self.largest_shift(shift.iter().copied());
        let turned = self.second_order(moved, sizes);
        let remainder = mul_up(0.5, self.second_order(sizes, sizes));
        add_up(add_up(linear, turned), remainder).min(self.first_order(sizes))
    }

    /// Bounds Σ_k |J_k(q)| r_k, by which the point moves at most as the joints move by r.
    fn first_order(&self, radii: &[f64]) -> f64 {
        let terms = self.reach.iter().zip(radii);
        terms.fold(0.0, |sum, (reach, r)| add_up(sum, mul_up(*reach, *r)))
    }

    /// Bounds Σ_jk |∂²p/∂q_j ∂q_k| a_j b_k for a, b >= 0. For j <= k the derivative is z_j × J_k
    /// for a revolute joint j, and 0 for a prismatic one.
    fn second_order(&self, a: &[f64], b: &[f64]) -> f64 {
        let (mut sum, mut a_before, mut b_before) = (0.0, 0.0, 0.0);
        for (k, reach) in self.reach.iter().enumerate() {
            let own = if self.turns[k] { mul_up(a[k], b[k]) } else { 0.0 };
            let mixed = add_up(mul_up(a_before, b[k]), mul_up(a[k], b_before));
            sum = add_up(sum, mul_up(*reach, add_up(own, mixed)));
            if self.turns[k] {
                a_before = add_up(a_before, a[k]);
                b_before = add_up(b_before, b[k]);
            }
        }
        sum
    }

    /// Bounds |Σ_k J_k e_k| for e in a box: the norm is largest at a vertex.
    fn largest_shift(&self, shift: impl Iterator<Item = Interval>) -> f64 {
        let (mut offset, mut error, mut count) = ([0.0; 3], 0.0, 0);
        let mut generators = [[0.0; 3]; VERTEX_GENERATORS];
        let mut beyond = [0.0; 3];
        for (column, e) in self.columns.iter().zip(shift) {
            let (mid, centre, radius) = (column.map(Interval::mid), e.mid(), e.rad());
            if !radius.is_finite() {
                return f64::INFINITY;
            }
            let inexact: [f64; 3] = core::array::from_fn(|i| (column[i] - mid[i]).mag());
            error = add_up(error, mul_up(norm_of_bounds(inexact), e.mag()));
            error = add_up(error, mul_up(mul_up(SUM_ERROR, norm(column)), add_up(e.mag(), radius)));
            (0..3).for_each(|i| offset[i] += mid[i] * centre);
            if radius == 0.0 {
                continue;
            }
            if let Some(generator) = generators.get_mut(count) {
                *generator = mid.map(|x| x * radius);
                count += 1;
            } else {
                (0..3).for_each(|i| beyond[i] = add_up(beyond[i], mul_up(mid[i].abs(), radius)));
            }
        }
        let square = match &generators[..count] {
            // Opposite vertices are equally far.
            [first, rest @ ..] if offset == [0.0; 3] => furthest_vertex(*first, rest),
            all => furthest_vertex(offset, all),
        };
        let vertex = sqrt_up(mul_up(square, 1.0 + SUM_ERROR));
        add_up(add_up(vertex, norm_of_bounds(beyond)), error)
    }
}

/// Returns the largest |sum ± g_1 ± g_2 ...|², in floating point.
fn furthest_vertex(sum: [f64; 3], generators: &[[f64; 3]]) -> f64 {
    let Some((g, rest)) = generators.split_first() else {
        return sum.iter().map(|x| x * x).sum();
    };
    let [plus, minus] = [1.0, -1.0].map(|sign| {
        let vertex = core::array::from_fn(|i| sum[i] + sign * g[i]);
        furthest_vertex(vertex, rest)
    });
    if plus > minus { plus } else { minus }
}
