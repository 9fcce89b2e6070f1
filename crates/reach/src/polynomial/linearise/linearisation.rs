//! The expansion of f about a point, f* + A d + B e + remainder, and the range of the remainder.

use reachtube_scalar::Interval;

use crate::polynomial::expansion::power_table::PowerTable;
use crate::polynomial::expansion::recentred::RecentredPolynomial;
use crate::polynomial::expansion::vertex_bound::VertexBound;
use crate::polynomial::linearise::expansion_point::RecentringPoint;
use crate::polynomial::linearise::linear_part::LinearPart;
use crate::polynomial::system::PolynomialSystem;

/// Number of steps after which the vertex factors are chosen again.
const CHOICE_STEPS: u32 = 8;

/// The linearisation f(x* + d, u* + e) = f* + A d + B e + remainder.
///
/// A and B are floating-point matrices; their errors belong to the remainder.
#[derive(Debug)]
pub(crate) struct FlowLinearisation<'a> {
    pub system: &'a PolynomialSystem,
    point: RecentringPoint,
    pub linear: LinearPart,
    expansions: Expansions,
    ranges: Ranges,
    /// Scratch memory: enclosed derivatives, N x (N + m), row by row.
    gradient: Vec<Interval>,
}

/// The polynomials of the system about the expansion point.
#[derive(Debug)]
struct Expansions {
    /// Along the axes, N.
    rows: Vec<RecentredPolynomial>,
    /// Along the directions.
    directions: Vec<RecentredPolynomial>,
}

/// The means to bound polynomials over a box of offsets.
#[derive(Debug)]
struct Ranges {
    powers: PowerTable,
    vertices: VertexBound,
    /// Number of steps until the vertex factors are chosen again.
    until_choice: u32,
}

impl<'a> FlowLinearisation<'a> {
    /// Prepares the linearisation of a system, with at most `vertex_variables` vertex factors.
    pub(crate) fn new(system: &'a PolynomialSystem, vertex_variables: usize) -> Self {
        let (n, m) = (system.states(), system.inputs());
        let powers = PowerTable::new(&system.highest);
        let mut own = Self {
            system,
            point: RecentringPoint::new(&system.angles, n + m),
            linear: LinearPart::new(n, m),
            expansions: Expansions {
                rows: system.rows.iter().map(|row| row.workspace()).collect(),
                directions: system.directions.iter().map(|d| d.polynomial.workspace()).collect(),
            },
            ranges: Ranges {
                vertices: VertexBound::new(vertex_variables, &powers),
                powers,
                until_choice: 0,
            },
            gradient: vec![Interval::ZERO; n * (n + m)],
        };
        own.expansions.bound_errors(system, &own.point.bounds);
        own
    }

    /// Returns x*, N entries.
    pub(crate) fn point(&self) -> &[f64] {
        &self.point.coordinates[..self.system.states()]
    }

    /// Linearises about the state `point` (N) and the middle of the input (m).
    ///
    /// Over a set of the given `radius` (N), a line of another slope than the derivative may fit
    /// the powers of one variable better; A has the slope of that line.
    ///
    /// # Guarantee
    ///
    /// f* and the slopes are enclosed for all coefficients within their intervals at each time.
    /// f*, A and B are midpoints, and exact as numbers.
    pub(crate) fn linearise(
        &mut self,
        point: impl Iterator<Item = f64>,
        radius: &[f64],
        input: &[Interval],
    ) {
        // Move the expansion point.
        let n = self.system.states();
        self.point.coordinates[..n].iter_mut().zip(point).for_each(|(own, x)| *own = x);
        self.point.radius[..n].copy_from_slice(radius);
        for (j, u) in input.iter().enumerate() {
            self.point.coordinates[n + j] = u.mid();
            self.point.radius[n + j] = u.rad();
            self.linear.input_radius[j] = u.rad();
            self.ranges.powers.set(n + j, *u - u.mid());
        }
        if self.point.update_factors(&self.system.angles) {
            self.expansions.bound_errors(self.system, &self.point.bounds);
        }
        // Recentre all polynomials and collect f* and the enclosed derivatives.
        self.gradient.fill(Interval::ZERO);
        self.differentiate_rows();
        self.differentiate_directions();
        // Round the derivatives to A and B.
        self.linear.round(self.system, &self.gradient);
        self.ranges.until_choice = self.ranges.until_choice.saturating_sub(1);
    }

    fn differentiate_rows(&mut self) {
        let Self { system, point, linear, expansions, gradient, .. } = self;
        let variables = point.coordinates.len();
        for (i, (row, work)) in system.rows.iter().zip(&mut expansions.rows).enumerate() {
            row.recentre(&point.factors, &point.radius, work);
            linear.rate[i] = row.constant(work);
            for (z, slope) in row.gradient(work) {
                let (z, slope) = system.angles.chain_slope(z, slope, &point.sine_slopes);
                gradient[i * variables + z] += slope;
            }
        }
    }

    fn differentiate_directions(&mut self) {
        let Self { system, point, linear, expansions, gradient, .. } = self;
        let (n, variables) = (system.states(), point.coordinates.len());
        let works = system.directions.iter().zip(&mut expansions.directions);
        for (g, (direction, work)) in works.enumerate() {
            direction.polynomial.recentre(&point.factors, &point.radius, work);
            let is_carried = |z: usize| {
                z >= n && system.carriers[z - n].is_some_and(|carrier| carrier.direction == g)
            };
            let column = direction.column.iter().enumerate().filter(|(_, entry)| **entry != 0.0);
            for (i, &entry) in column {
                linear.rate[i] += direction.polynomial.constant(work) * entry;
                let slopes = direction.polynomial.gradient(work);
                let slopes = slopes
                    .map(|(z, slope)| system.angles.chain_slope(z, slope, &point.sine_slopes));
                for (z, slope) in slopes.filter(|(z, _)| !is_carried(*z)) {
                    gradient[i * variables + z] += slope * entry;
                }
            }
        }
    }

    /// Bounds the remainder over the offsets `tube` (N) and the input: first along the axes (N),
    /// then along the directions.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn remainder(&mut self, tube: &[Interval], out: &mut [Interval]) {
        let Self { system, point, linear, expansions, ranges, .. } = self;
        let (n, variables) = (tube.len(), point.coordinates.len());
        if tube.iter().any(|side| !side.mag().is_finite()) {
            out.fill(Interval::ENTIRE);
            return;
        }
        // Powers of the sides of the tube.
        let (powers, vertices) = (&mut ranges.powers, &mut ranges.vertices);
        tube.iter().enumerate().for_each(|(i, side)| powers.set(i, *side));
        for (i, &state) in system.angles.states.iter().enumerate() {
            let line = [point.sine_slopes[i], point.versine_middles[i]];
            powers.set_angle(variables + i, tube[state], line);
        }
        // Ranges of the polynomials, and the rounding errors of the linear part.
        let (rows, directions) = out.split_at_mut(n);
        for (i, (out, work)) in rows.iter_mut().zip(&mut expansions.rows).enumerate() {
            let range = system.rows[i].remainder(powers, vertices, work);
            *out = range + Interval::centred(0.0, linear.rounding_error(i, tube));
        }
        let works = system.directions.iter().zip(&mut expansions.directions);
        for (out, (direction, work)) in directions.iter_mut().zip(works) {
            *out = direction.polynomial.remainder(powers, vertices, work);
        }
        // Vertex factors for the next steps.
        if ranges.until_choice == 0 {
            ranges.until_choice = CHOICE_STEPS;
            expansions.choose_vertex_factors(system, powers, vertices);
        }
    }
}

impl Expansions {
    /// Bounds the errors of recentring for factors within `bounds`.
    fn bound_errors(&mut self, system: &PolynomialSystem, bounds: &[f64]) {
        let rows = system.rows.iter().zip(&mut self.rows);
        rows.for_each(|(row, work)| row.bound_errors(bounds, work));
        let directions = system.directions.iter().zip(&mut self.directions);
        directions.for_each(|(direction, work)| direction.polynomial.bound_errors(bounds, work));
    }

    fn choose_vertex_factors(
        &mut self,
        system: &PolynomialSystem,
        powers: &PowerTable,
        vertices: &mut VertexBound,
    ) {
        for (row, work) in system.rows.iter().zip(&mut self.rows) {
            row.choose_vertex_factors(powers, vertices, work);
        }
        for (direction, work) in system.directions.iter().zip(&mut self.directions) {
            direction.polynomial.choose_vertex_factors(powers, vertices, work);
        }
    }
}
