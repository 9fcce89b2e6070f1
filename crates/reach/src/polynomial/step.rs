//! One step of conservative linearisation.

use reachtube_scalar::Interval;

use super::exponential::RoundedExponential;
use super::linearisation::Linearisation;
use super::rounded::raised;
use super::set::Set;

/// Guesses of the remainder before a step counts as failed.
const TRIES: usize = 25;

/// What a guess is enlarged by: relative to its width, and in any case.
const ENLARGED: f64 = 0.05;
const LEAST: f64 = 1e-290;

/// What a step that failed had come to.
#[derive(Debug)]
pub(super) struct Exhausted {
    pub state: usize,
    pub widths: Vec<f64>,
}

/// Scratch memory of the steps, vectors of N.
#[derive(Debug)]
pub(super) struct Stepper<'a> {
    linear: Linearisation<'a>,
    exponential: RoundedExponential,
    directions: Vec<&'a [f64]>,
    /// Where the linear system about the point is at the end of the step: the centre, and the
    /// radius around it.
    end: Vec<Interval>,
    end_radius: Vec<f64>,
    /// Offsets from the point over the whole step, without the input and the remainder; and with
    /// them.
    linear_tube: Vec<Interval>,
    tube: Vec<Interval>,
    /// The remainder: along the axes, then along the directions.
    guess: Vec<Interval>,
    found: Vec<Interval>,
    sums: Vec<f64>,
    /// Bounds of what moves the state: input and remainder.
    drive: Vec<f64>,
    spare: [Vec<f64>; 4],
    last_move: Vec<f64>,
    most_generators: usize,
}

impl<'a> Stepper<'a> {
    pub fn new(linear: Linearisation<'a>, most_generators: usize) -> Self {
        let n = linear.system.states();
        let directions: Vec<&[f64]> =
            linear.system.directions.iter().map(|d| d.column.as_slice()).collect();
        let remainders = n + directions.len();
        let intervals = |n| vec![Interval::ZERO; n];
        let numbers = || vec![0.0; n];
        Self {
            exponential: RoundedExponential::new(n),
            directions,
            end: intervals(n),
            end_radius: numbers(),
            linear_tube: intervals(n),
            tube: intervals(n),
            guess: intervals(remainders),
            found: intervals(remainders),
            sums: numbers(),
            drive: numbers(),
            spare: [numbers(), numbers(), numbers(), numbers()],
            last_move: numbers(),
            most_generators,
            linear,
        }
    }

    pub fn directions(&self) -> &[&'a [f64]] {
        &self.directions
    }

    /// The states of the step just made: N boxes.
    pub fn tube(&self) -> impl Iterator<Item = Interval> {
        self.linear.point().iter().zip(&self.tube).map(|(point, d)| *d + *point)
    }

    /// Takes `set` over a step of length h (s) under u ∈ `input` (m).
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding. With d = x - x*, ḋ = f* + A d + B e + Σ_g N_g l_g for exact
    /// numbers l_g in the remainder's range, which is proved by containment: as long as d stays in
    /// the tube, the remainder is strictly inside the guess, and as long as it is in the guess, d
    /// stays in the tube; d is continuous, so neither ends before the step. The set after the step
    /// is that of the linear system under e and l:
    ///
    /// ∫₀ʰ e^{As} b e(s) ds ∈ (h/2) (e^{Ah} b + b) \[-r, r\] ⊕ (h³/12) |A|² e^{|A|h} |b| r \[-1,
    /// 1\],
    ///
    /// since e^{As} b is within s (h - s)/2 sup |A² e^{Aσ} b| of its chord, whose two weights s/h
    /// and 1 - s/h have integrals of h/2.
    pub fn advance(
        &mut self,
        set: &mut Set,
        h: Interval,
        input: &[Interval],
    ) -> Result<(), Exhausted> {
        let point = set.center.iter().zip(&self.last_move).map(|(c, moved)| c + 0.5 * moved);
        self.linear.linearise(point, &set.radius, input);
        if !self.exponential.update(&self.linear.a, h) {
            return Err(self.exhausted(set));
        }
        self.predict(set, h);
        self.span(set, h);
        if !self.contain(h) {
            return Err(self.exhausted(set));
        }
        self.complete(set, h);
        let is_bounded = set.radius.iter().chain(&set.center).all(|x| x.is_finite());
        if is_bounded { Ok(()) } else { Err(self.exhausted(set)) }
    }

    fn exhausted(&self, set: &Set) -> Exhausted {
        let widths: Vec<f64> = self.tube.iter().map(|x| x.width()).collect();
        let growth = |i: &usize| widths[*i] / set.radius[*i].max(f64::MIN_POSITIVE);
        let state = (0..widths.len()).max_by(|i, j| growth(i).total_cmp(&growth(j))).unwrap_or(0);
        Exhausted { state, widths }
    }

    /// The linear system without input: Φ (c - x*) + h φ₁ f*, and the radius of Φ times the rest.
    fn predict(&mut self, set: &mut Set, h: Interval) {
        let offset = |i: usize| Interval::point(set.center[i]) - self.linear.point()[i];
        let n = set.center.len();
        let [magnitudes, errors, ..] = &mut self.spare;
        for (i, end) in self.end.iter_mut().enumerate() {
            let row =
                self.exponential.phi.row(i).iter().enumerate().filter(|(_, phi)| **phi != 0.0);
            *end = row.fold(Interval::ZERO, |sum, (j, phi)| sum + offset(j) * *phi);
            magnitudes[i] = offset(i).mag();
        }
        self.exponential.error_times(magnitudes, errors);
        self.end.iter_mut().zip(&*errors).for_each(|(end, error)| *end += symmetric(*error));
        drift(&self.exponential, h, &self.linear.rate, &mut self.end, [magnitudes, errors]);
        set.generators.map(&self.exponential.phi, &mut self.sums);
        let [rounding, recent, errors, _] = &mut self.spare;
        self.exponential.phi.apply_absolute(&set.radius, rounding);
        self.exponential.phi.apply_absolute(&set.recent_radius, recent);
        self.exponential.error_times(&set.radius, errors);
        let terms = set.generators.len() + 64;
        for i in 0..n {
            let rest = recent[i] + errors[i] + rounding[i] * product_error(n);
            self.end_radius[i] = raised(self.sums[i] + rest, terms);
        }
    }

    /// Every state of the linear system over the step: within h²/8 sup|ÿ| of the chord, ÿ = A
    /// e^{As} (A y(0) + f*).
    fn span(&mut self, set: &Set, h: Interval) {
        let [velocity, bound, bulge, _] = &mut self.spare;
        let linear = &self.linear;
        linear.a.apply_absolute(&set.radius, velocity);
        for (i, velocity) in velocity.iter_mut().enumerate() {
            let row = linear.a.row(i).iter().enumerate().filter(|(_, a)| **a != 0.0);
            let offset = |j: usize| Interval::point(set.center[j]) - linear.point()[j];
            let center = row.fold(linear.rate[i], |sum, (j, a)| sum + offset(j) * *a);
            *velocity = raised(*velocity + center.mag(), 1);
        }
        self.exponential.bound_times(velocity, bound);
        linear.a.apply_absolute(bound, bulge);
        let eighth = (h.sqr() * 0.125).hi();
        for (i, bulge) in bulge.iter().enumerate() {
            let start = Interval::centered(set.center[i], set.radius[i]) - linear.point()[i];
            let end = self.end[i] + symmetric(self.end_radius[i]);
            self.linear_tube[i] = start.hull(end) + symmetric(raised(bulge * eighth, 1));
        }
    }

    /// Finds the range of the remainder over the step, from that of the step before; whether it was
    /// found.
    fn contain(&mut self, h: Interval) -> bool {
        self.guess.copy_from_slice(&self.found);
        for _ in 0..TRIES {
            self.guess.iter_mut().for_each(|x| *x = enlarged(*x));
            self.surround(h);
            self.linear.remainder(&self.tube, &mut self.found);
            let is_inside = |(found, guess): (&Interval, &Interval)| {
                found.lo() > guess.lo() && found.hi() < guess.hi() && guess.mag().is_finite()
            };
            if self.found.iter().zip(&self.guess).all(is_inside) {
                return true;
            }
            if self.found.iter().any(|x| !x.mag().is_finite()) {
                return false;
            }
            self.guess
                .iter_mut()
                .zip(&self.found)
                .for_each(|(guess, found)| *guess = guess.hull(*found));
        }
        false
    }

    /// The tube under the guess: what input and remainder can move the state by within the step is
    /// at most h e^{|A|h} times their magnitude.
    fn surround(&mut self, h: Interval) {
        let [reach, ..] = &mut self.spare;
        self.linear.magnitude(&self.guess, Interval::mag, &mut self.drive);
        self.exponential.bound_times(&self.drive, reach);
        for ((tube, linear), reach) in self.tube.iter_mut().zip(&self.linear_tube).zip(&*reach) {
            *tube = *linear + symmetric(raised(reach * h.hi(), 1));
        }
    }

    /// The set at the end of the step, under the remainder found.
    fn complete(&mut self, set: &mut Set, h: Interval) {
        let n = set.center.len();
        let half = 0.5 * h.hi();
        self.linear.magnitude(&self.found, Interval::rad, &mut self.drive);
        let [center, reach, errors, bulge] = &mut self.spare;
        let centers = self.linear.center(&self.found);
        drift(&self.exponential, h, centers, &mut self.end, [center, errors]);
        (0..n).for_each(|i| reach[i] = raised(set.radius[i] + half * self.drive[i], 1));
        self.exponential.error_times(reach, errors);
        self.exponential.phi.apply_absolute(reach, center);
        (0..n).for_each(|i| errors[i] = raised(errors[i] + center[i] * product_error(n), 1));
        self.exponential.bound_times(&self.drive, center);
        self.linear.a.apply_absolute(center, reach);
        self.linear.a.apply_absolute(reach, bulge);
        let twelfth = (h.powi(3) / 12.0).hi();
        self.add_drive(set, half);
        set.store(&self.exponential.phi, &self.directions, &mut self.spare[0], &mut self.sums);
        self.replace_drive(set, half);
        let [_, _, errors, bulge] = &self.spare;
        for i in 0..n {
            let end = self.end[i] + self.linear.point()[i];
            self.last_move[i] = end.mid() - set.center[i];
            set.center[i] = end.mid();
            let rest = errors[i] + bulge[i] * twelfth + half * self.found[i].rad();
            set.axes[i] = raised(set.axes[i] + end.rad() + rest, 4);
        }
        set.measure(&self.directions, &self.sums, self.most_generators);
    }

    /// What input and remainder add at the start of the step.
    fn add_drive(&mut self, set: &mut Set, half: f64) {
        let n = set.center.len();
        for (g, length) in set.lengths.iter_mut().enumerate() {
            *length = raised(*length + half * self.linear.along_direction(g, &self.found), 2);
        }
        for j in 0..set.column_lengths.len() {
            let column = self.linear.column(j);
            let own = raised(half * self.linear.input_radius[j], 1);
            if set.columns[j * n..(j + 1) * n] == *column {
                set.column_lengths[j] = raised(set.column_lengths[j] + own, 1);
            } else {
                // What the last step has along its own column is stored apart.
                set.store_column(j, &self.exponential.phi, &mut self.spare[0], &mut self.sums);
                set.columns[j * n..(j + 1) * n].copy_from_slice(column);
                set.column_lengths[j] = own;
            }
        }
        for (i, length) in set.axes.iter_mut().enumerate() {
            *length = raised(*length + half * self.found[i].rad(), 1);
        }
    }

    /// What they add at its end.
    fn replace_drive(&mut self, set: &mut Set, half: f64) {
        for (g, length) in set.lengths.iter_mut().enumerate() {
            *length = raised(half * self.linear.along_direction(g, &self.found), 1);
        }
        for (j, length) in set.column_lengths.iter_mut().enumerate() {
            *length = raised(half * self.linear.input_radius[j], 1);
        }
    }
}

/// Adds h φ₁ `rate` to `end`.
fn drift(
    exponential: &RoundedExponential,
    h: Interval,
    rate: &[Interval],
    end: &mut [Interval],
    [magnitudes, errors]: [&mut Vec<f64>; 2],
) {
    magnitudes.iter_mut().zip(rate).for_each(|(magnitude, rate)| *magnitude = rate.mag());
    exponential.error_times(magnitudes, errors);
    for (i, end) in end.iter_mut().enumerate() {
        let row = exponential.phi1.row(i).iter().zip(rate).filter(|(phi1, _)| **phi1 != 0.0);
        let sum = row.fold(symmetric(errors[i]), |sum, (phi1, rate)| sum + *rate * *phi1);
        *end += sum * h;
    }
}

/// Relative error of a sum of n products and one more (Higham, section 3.1), with room.
fn product_error(n: usize) -> f64 {
    (n + 4) as f64 * f64::EPSILON
}

fn symmetric(radius: f64) -> Interval {
    Interval::centered(0.0, radius)
}

fn enlarged(x: Interval) -> Interval {
    let more = ENLARGED * x.width() + LEAST;
    x + symmetric(more)
}
