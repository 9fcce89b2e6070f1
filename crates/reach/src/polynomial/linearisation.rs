//! f about a point: f* + A d + B e and what that leaves out.

use reachtube_scalar::Interval;

use super::PolynomialSystem;
use super::angles::{TURN_ROUNDINGS, sine_slope, versine_middle};
use super::corners::Corners;
use super::powers::PowerTable;
use super::rounded::{Square, raised};
use super::shift::Shift;

/// Bounds of variables begin here, so that they do not have to grow often.
const LEAST_BOUND: f64 = 1e-3;

/// Steps over which corners are taken of the same factors.
const CHOICE_STEPS: u32 = 8;

/// f(x* + d, u* + e) = f* + A d + B e + remainder, with A and B in floating point and their error
/// in the remainder.
#[derive(Debug)]
pub(super) struct Linearisation<'a> {
    pub system: &'a PolynomialSystem,
    /// (x*, u*).
    point: Vec<f64>,
    /// (x*, u*) and the turns of the angles, as the shifts take them.
    factors: Vec<f64>,
    turns: Vec<Interval>,
    /// Bounds of their magnitudes that the errors of the shifts rest on.
    bounds: Vec<f64>,
    /// How far (x, u) is from there, about.
    radius: Vec<f64>,
    /// The slopes of the lines of the angles' sines.
    lines: Vec<f64>,
    /// The middles of their κ.
    middles: Vec<f64>,
    /// f*, and what it may be off by at each time.
    pub rate: Vec<Interval>,
    rate_radius: Vec<f64>,
    pub a: Square,
    /// B without the inputs that a direction carries, column by column.
    b: Vec<f64>,
    /// Bounds of |e|, m.
    pub input_radius: Vec<f64>,
    /// Enclosed derivatives, row by row, and their distance from A and B.
    gradient: Vec<Interval>,
    defect: Vec<f64>,
    rows: Vec<Shift>,
    directions: Vec<Shift>,
    powers: PowerTable,
    corners: Corners,
    /// Steps until the factors whose corners are taken are chosen again.
    until_choice: u32,
    centers: Vec<Interval>,
}

impl<'a> Linearisation<'a> {
    pub fn new(system: &'a PolynomialSystem, corners: usize) -> Self {
        let (n, m) = (system.states(), system.inputs());
        let powers = PowerTable::new(&system.highest);
        let mut own = Self {
            system,
            point: vec![0.0; n + m],
            factors: vec![0.0; system.angles.factors().len()],
            turns: system.angles.factors(),
            bounds: system.angles.magnitudes(),
            radius: vec![0.0; n + m],
            lines: vec![0.0; system.angles.states.len()],
            middles: vec![0.0; system.angles.states.len()],
            rate: vec![Interval::ZERO; n],
            rate_radius: vec![0.0; n],
            a: Square::zero(n),
            b: vec![0.0; n * m],
            input_radius: vec![0.0; m],
            gradient: vec![Interval::ZERO; n * (n + m)],
            defect: vec![0.0; n * (n + m)],
            rows: system.rows.iter().map(|row| row.workspace()).collect(),
            directions: system.directions.iter().map(|d| d.polynomial.workspace()).collect(),
            corners: Corners::new(corners, &powers),
            powers,
            until_choice: 0,
            centers: vec![Interval::ZERO; n],
        };
        own.bound_errors();
        own
    }

    /// x*.
    pub fn point(&self) -> &[f64] {
        &self.point[..self.system.states()]
    }

    /// Column j of B; zero for an input that a direction carries.
    pub fn column(&self, j: usize) -> &[f64] {
        let n = self.system.states();
        &self.b[j * n..(j + 1) * n]
    }

    /// About the point x* and the middle of the input. Over a set of that `radius` (N), a power of
    /// one variable is close to a line steeper than its derivative, and A has that slope.
    ///
    /// # Guarantee
    ///
    /// f* and the slopes are enclosed, whichever of their intervals coefficients are at each time;
    /// f*, A and B are midpoints, exact as numbers.
    pub fn linearise(
        &mut self,
        point: impl Iterator<Item = f64>,
        radius: &[f64],
        input: &[Interval],
    ) {
        let n = self.system.states();
        self.point[..n].iter_mut().zip(point).for_each(|(own, x)| *own = x);
        self.radius[..n].copy_from_slice(radius);
        for (j, u) in input.iter().enumerate() {
            self.point[n + j] = u.mid();
            self.input_radius[j] = u.rad();
            self.radius[n + j] = u.rad();
            self.powers.set(n + j, *u - u.mid());
        }
        self.turn();
        self.gradient.fill(Interval::ZERO);
        self.differentiate_rows();
        self.differentiate_directions();
        self.round();
        self.until_choice = self.until_choice.saturating_sub(1);
    }

    /// The factors at the point. An angle so large that its sine is not known has none.
    fn turn(&mut self) {
        let variables = self.point.len();
        self.factors[..variables].copy_from_slice(&self.point);
        for (i, &state) in self.system.angles.states.iter().enumerate() {
            self.lines[i] = sine_slope(self.radius[state]);
            self.middles[i] = versine_middle(self.radius[state]);
            self.system.angles.turn(i, self.point[state], self.middles[i], &mut self.turns);
        }
        for (at, turn) in self.turns.iter().enumerate().skip(variables) {
            let is_known = turn.rad() <= TURN_ROUNDINGS * f64::EPSILON * self.bounds[at];
            self.factors[at] = if is_known { turn.mid() } else { f64::NAN };
        }
        let beyond = |(z, bound): (&f64, &f64)| z.abs() > *bound;
        if self.point.iter().zip(&self.bounds).any(beyond) {
            let grown =
                self.bounds.iter_mut().zip(&self.point).filter(|(bound, z)| z.abs() > **bound);
            grown.for_each(|(bound, z)| *bound = (2.0 * z.abs()).max(LEAST_BOUND));
            self.bound_errors();
        }
    }

    fn bound_errors(&mut self) {
        let bounds = &self.bounds;
        let rows = self.system.rows.iter().zip(&mut self.rows);
        rows.for_each(|(row, shift)| row.bound_errors(bounds, shift));
        let directions = self.system.directions.iter().zip(&mut self.directions);
        directions.for_each(|(direction, shift)| direction.polynomial.bound_errors(bounds, shift));
    }

    fn differentiate_rows(&mut self) {
        let (variables, angles) = (self.point.len(), &self.system.angles);
        for (i, (row, shift)) in self.system.rows.iter().zip(&mut self.rows).enumerate() {
            row.shift(&self.factors, &self.radius, shift);
            self.rate[i] = row.constant(shift);
            for (z, slope) in row.gradient(shift) {
                let (z, slope) = angles.along_line(z, slope, &self.lines);
                self.gradient[i * variables + z] += slope;
            }
        }
    }

    fn differentiate_directions(&mut self) {
        let (n, variables, angles) = (self.system.states(), self.point.len(), &self.system.angles);
        for (g, (direction, shift)) in
            self.system.directions.iter().zip(&mut self.directions).enumerate()
        {
            direction.polynomial.shift(&self.factors, &self.radius, shift);
            let is_carried = |z: usize| {
                z >= n && self.system.carriers[z - n].is_some_and(|carrier| carrier.direction == g)
            };
            for (i, &entry) in
                direction.column.iter().enumerate().filter(|(_, entry)| **entry != 0.0)
            {
                self.rate[i] += direction.polynomial.constant(shift) * entry;
                let slopes = direction.polynomial.gradient(shift);
                let slopes = slopes.map(|(z, slope)| angles.along_line(z, slope, &self.lines));
                for (z, slope) in slopes.filter(|(z, _)| !is_carried(*z)) {
                    self.gradient[i * variables + z] += slope * entry;
                }
            }
        }
    }

    fn round(&mut self) {
        let (n, variables) = (self.system.states(), self.point.len());
        for i in 0..n {
            self.rate_radius[i] = self.rate[i].rad();
            self.rate[i] = Interval::point(self.rate[i].mid());
            for z in 0..variables {
                let (at, slope) = (i * variables + z, self.gradient[i * variables + z]);
                self.defect[at] = slope.rad();
                if z < n {
                    self.a.entries[i * n + z] = slope.mid();
                } else if self.system.carriers[z - n].is_none() {
                    self.b[(z - n) * n + i] = slope.mid();
                } else {
                    self.defect[at] = slope.mag();
                }
            }
        }
    }

    /// The remainder over the offsets `tube` (N) and the input: along the axes (N), then along the
    /// directions.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub fn remainder(&mut self, tube: &[Interval], out: &mut [Interval]) {
        let (n, variables) = (tube.len(), self.point.len());
        if tube.iter().any(|side| !side.mag().is_finite()) {
            out.fill(Interval::ENTIRE);
            return;
        }
        tube.iter().enumerate().for_each(|(i, side)| self.powers.set(i, *side));
        for (i, &state) in self.system.angles.states.iter().enumerate() {
            self.powers.set_angle(variables + i, tube[state], [self.lines[i], self.middles[i]]);
        }
        let (rows, directions) = out.split_at_mut(n);
        for (i, out) in rows.iter_mut().enumerate() {
            let defect = &self.defect[i * variables..(i + 1) * variables];
            let states = defect.iter().zip(tube).map(|(defect, d)| defect * d.mag());
            let inputs = defect[n..].iter().zip(&self.input_radius).map(|(defect, r)| defect * r);
            let rounding =
                raised(states.chain(inputs).sum::<f64>() + self.rate_radius[i], variables + 1);
            let range =
                self.system.rows[i].remainder(&self.powers, &mut self.corners, &mut self.rows[i]);
            *out = range + Interval::centered(0.0, rounding);
        }
        for ((out, direction), shift) in
            directions.iter_mut().zip(&self.system.directions).zip(&mut self.directions)
        {
            *out = direction.polynomial.remainder(&self.powers, &mut self.corners, shift);
        }
        self.choose();
    }

    /// The factors whose corners are taken, now and then.
    fn choose(&mut self) {
        if self.until_choice > 0 {
            return;
        }
        self.until_choice = CHOICE_STEPS;
        for (row, shift) in self.system.rows.iter().zip(&mut self.rows) {
            row.choose(&self.powers, &mut self.corners, shift);
        }
        for (direction, shift) in self.system.directions.iter().zip(&mut self.directions) {
            direction.polynomial.choose(&self.powers, &mut self.corners, shift);
        }
    }

    /// A bound of what input and remainder can be along direction g: the inputs it carries and the
    /// radius of its remainder.
    pub fn along_direction(&self, g: usize, remainder: &[Interval]) -> f64 {
        raised(self.carried(g) + remainder[self.system.states() + g].rad(), 1)
    }

    fn carried(&self, g: usize) -> f64 {
        let inputs = self.system.carriers.iter().zip(&self.input_radius);
        let own =
            inputs.filter_map(|(carrier, r)| carrier.filter(|c| c.direction == g).map(|c| (c, r)));
        raised(own.map(|(carrier, r)| carrier.factor.abs() * r).sum(), self.input_radius.len())
    }

    /// `out` >= |B| r + |N| |l|, with the `size` of each l.
    pub fn magnitude(
        &self,
        remainder: &[Interval],
        size: impl Fn(Interval) -> f64,
        out: &mut [f64],
    ) {
        let n = out.len();
        out.iter_mut().zip(remainder).for_each(|(out, l)| *out = size(*l));
        for (column, r) in self.b.chunks_exact(n.max(1)).zip(&self.input_radius) {
            out.iter_mut().zip(column).for_each(|(out, b)| *out += b.abs() * r);
        }
        for (g, direction) in self.system.directions.iter().enumerate() {
            let length = raised(self.carried(g) + size(remainder[n + g]), 1);
            out.iter_mut().zip(&direction.column).for_each(|(out, x)| *out += x.abs() * length);
        }
        let terms = self.input_radius.len() + self.system.directions.len();
        out.iter_mut().for_each(|out| *out = raised(*out, terms));
    }

    /// The middle of the remainder as a part of ẋ, enclosed.
    pub fn center(&mut self, remainder: &[Interval]) -> &[Interval] {
        let n = self.centers.len();
        for (i, center) in self.centers.iter_mut().enumerate() {
            *center = Interval::point(remainder[i].mid());
            for (direction, l) in self.system.directions.iter().zip(&remainder[n..]) {
                if direction.column[i] != 0.0 {
                    *center += Interval::point(direction.column[i]) * l.mid();
                }
            }
        }
        &self.centers
    }
}
