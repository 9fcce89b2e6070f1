//! One step of conservative linearisation.

use reachtube_scalar::Interval;

use crate::polynomial::linearise::linearisation::FlowLinearisation;
use crate::polynomial::linearise::reachable_zonotope::ReachableZonotope;
use crate::polynomial::linearise::rounded_exponential::RoundedExponential;
use crate::polynomial::propagator::StepFailure;
use crate::upward::round_up_sum;

/// Largest number of guesses of the remainder before a step counts as failed.
const TRIES: usize = 25;

/// Enlargement of a guess, relative to its width.
const ENLARGEMENT: f64 = 0.05;

/// Smallest enlargement of a guess.
const LEAST_ENLARGEMENT: f64 = 1e-290;

/// The steps of conservative linearisation, with reused memory.
#[derive(Debug)]
pub(crate) struct LinearisedStep<'a> {
    linearisation: FlowLinearisation<'a>,
    exponential: RoundedExponential,
    /// Columns of the directions of the system.
    directions: Vec<&'a [f64]>,
    /// Largest number of stored generators.
    most_generators: usize,
    linear_solution: LinearSolution,
    /// Offsets from the expansion point over the whole step, with input and remainder, N.
    tube: Vec<Interval>,
    remainder: RemainderGuess,
    /// Movement of the centre in the last step, N.
    last_move: Vec<f64>,
    scratch: StepWorkspace,
}

/// The linear system about the expansion point, without input and remainder.
#[derive(Debug)]
struct LinearSolution {
    /// Offset of the centre from the expansion point at the end of the step, N.
    end: Vec<Interval>,
    /// Radius around it at the end of the step, N.
    end_radius: Vec<f64>,
    /// Offsets over the whole step, N.
    tube: Vec<Interval>,
}

/// Ranges of the remainder: first along the axes (N), then along the directions.
#[derive(Debug)]
struct RemainderGuess {
    guess: Vec<Interval>,
    found: Vec<Interval>,
}

/// Scratch memory, vectors of N entries.
#[derive(Debug)]
struct StepWorkspace {
    /// Σ |g| of the stored generators, in floating point.
    sums: Vec<f64>,
    /// Bounds of the rates that input and remainder add to ẋ.
    drive: Vec<f64>,
    vectors: [Vec<f64>; 4],
}

impl<'a> LinearisedStep<'a> {
    pub(crate) fn new(linearisation: FlowLinearisation<'a>, most_generators: usize) -> Self {
        let system = linearisation.system;
        let n = system.states();
        let directions: Vec<&[f64]> =
            system.directions.iter().map(|d| d.column.as_slice()).collect();
        let remainders = n + directions.len();
        let intervals = |n| vec![Interval::ZERO; n];
        let numbers = || vec![0.0; n];
        Self {
            exponential: RoundedExponential::new(n),
            directions,
            most_generators,
            linear_solution: LinearSolution {
                end: intervals(n),
                end_radius: numbers(),
                tube: intervals(n),
            },
            tube: intervals(n),
            remainder: RemainderGuess {
                guess: intervals(remainders),
                found: intervals(remainders),
            },
            last_move: numbers(),
            scratch: StepWorkspace {
                sums: numbers(),
                drive: numbers(),
                vectors: [numbers(), numbers(), numbers(), numbers()],
            },
            linearisation,
        }
    }

    pub(crate) fn directions(&self) -> &[&'a [f64]] {
        &self.directions
    }

    /// Iterates over the ranges of the states over the last step, N intervals.
    pub(crate) fn tube(&self) -> impl Iterator<Item = Interval> {
        self.linearisation.point().iter().zip(&self.tube).map(|(point, d)| *d + *point)
    }

    /// Advances `set` over a step of length h (s) under u ∈ `input` (m).
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding. With d = x - x*, ḋ = f* + A d + B e + Σ_g N_g l_g for exact
    /// numbers l_g in the range of the remainder. Containment proves that range. While d stays in
    /// the tube, the remainder is strictly inside the guess; while it is in the guess, d stays in
    /// the tube. Since d is continuous, both hold until the end of the step. The set after the step
    /// is reached by the linear system under e and l:
    ///
    /// ∫₀ʰ e^{As} b e(s) ds ∈
    /// (h/2) (e^{Ah} b + b) \[-r, r\] ⊕ (h³/12) |A|² e^{|A|h} |b| r \[-1, 1\],
    ///
    /// since e^{As} b is within s (h - s)/2 sup |A² e^{Aσ} b| of its chord, whose two weights s/h
    /// and 1 - s/h have integrals of h/2.
    pub(crate) fn advance(
        &mut self,
        set: &mut ReachableZonotope,
        h: Interval,
        input: &[Interval],
    ) -> Result<(), StepFailure> {
        // Linearise about a point near the middle of the set over the step.
        let point = set.centre.iter().zip(&self.last_move).map(|(c, moved)| c + 0.5 * moved);
        self.linearisation.linearise(point, &set.radius, input);
        if !self.exponential.update(&self.linearisation.linear.a, h) {
            return Err(self.failure(set));
        }
        // Solve the linear system without input: its end and its tube.
        self.solve_linear_system(set, h);
        self.enclose_linear_tube(set, h);
        // Verify a range of the remainder by containment.
        if !self.find_remainder(h) {
            return Err(self.failure(set));
        }
        // Add the input and the remainder to the set at the end.
        self.update_set(set, h);
        let is_bounded = set.radius.iter().chain(&set.centre).all(|x| x.is_finite());
        if is_bounded { Ok(()) } else { Err(self.failure(set)) }
    }

    fn failure(&self, set: &ReachableZonotope) -> StepFailure {
        let widths: Vec<f64> = self.tube.iter().map(|x| x.width()).collect();
        // A state of width 0 that stays put must not count as the one that grew the most.
        let least = |i: usize| f64::MIN_POSITIVE + f64::EPSILON.sqrt() * set.centre[i].abs();
        let growth = |i: &usize| widths[*i] / set.radius[*i].max(least(*i));
        let state = (0..widths.len()).max_by(|i, j| growth(i).total_cmp(&growth(j))).unwrap_or(0);
        StepFailure { state, widths }
    }

    /// Maps the set by the linear system without input: the centre to Φ (c - x*) + h φ₁ f*, the
    /// generators by Φ.
    fn solve_linear_system(&mut self, set: &mut ReachableZonotope, h: Interval) {
        let Self { linearisation, exponential, linear_solution, scratch, .. } = self;
        let offset = |i: usize| Interval::point(set.centre[i]) - linearisation.point()[i];
        let n = set.centre.len();
        let end = &mut linear_solution.end;
        // Centre.
        let [magnitudes, errors, ..] = &mut scratch.vectors;
        for (i, end) in end.iter_mut().enumerate() {
            let row = exponential.phi.row(i).iter().enumerate().filter(|(_, phi)| **phi != 0.0);
            *end = row.fold(Interval::ZERO, |sum, (j, phi)| sum + offset(j) * *phi);
            magnitudes[i] = offset(i).mag();
        }
        exponential.error_times(magnitudes, errors);
        end.iter_mut().zip(&*errors).for_each(|(end, error)| *end += symmetric(*error));
        add_drift(exponential, h, &linearisation.linear.rate, end, [magnitudes, errors]);
        // Stored and recent generators, with their rounding.
        set.generators.map(&exponential.phi, &mut scratch.sums);
        let [rounding, recent, errors, _] = &mut scratch.vectors;
        exponential.rounding_times(&set.radius, rounding);
        exponential.phi.apply_absolute(&set.recent_radius, recent);
        exponential.error_times(&set.radius, errors);
        let terms = set.generators.len() + 64;
        for i in 0..n {
            let others = recent[i] + errors[i] + rounding[i];
            linear_solution.end_radius[i] = round_up_sum(scratch.sums[i] + others, terms);
        }
    }

    /// Encloses every state of the linear system over the step.
    ///
    /// The states are within h²/8 sup|ÿ| of the chord, with ÿ = A e^{As} (A y(0) + f*).
    fn enclose_linear_tube(&mut self, set: &ReachableZonotope, h: Interval) {
        let Self { linearisation, exponential, linear_solution, scratch, .. } = self;
        let (linear, point) = (&linearisation.linear, linearisation.point());
        let [velocity, bound, bulge, _] = &mut scratch.vectors;
        // Bound of ẏ at the start.
        linear.a.apply_absolute(&set.radius, velocity);
        for (i, velocity) in velocity.iter_mut().enumerate() {
            let row = linear.a.row(i).iter().enumerate().filter(|(_, a)| **a != 0.0);
            let offset = |j: usize| Interval::point(set.centre[j]) - point[j];
            let centre = row.fold(linear.rate[i], |sum, (j, a)| sum + offset(j) * *a);
            *velocity = round_up_sum(*velocity + centre.mag(), 1);
        }
        // Bound of ÿ over the step.
        exponential.bound_times(velocity, bound);
        linear.a.apply_absolute(bound, bulge);
        // Hull of both ends, widened by the distance from the chord.
        let eighth = (h.sqr() * 0.125).hi();
        for (i, bulge) in bulge.iter().enumerate() {
            let start = Interval::centred(set.centre[i], set.radius[i]) - point[i];
            let end = linear_solution.end[i] + symmetric(linear_solution.end_radius[i]);
            linear_solution.tube[i] = start.hull(end) + symmetric(round_up_sum(bulge * eighth, 1));
        }
    }

    /// Searches a range of the remainder that contains itself over the step, starting from the
    /// range of the last step; returns whether it was found.
    fn find_remainder(&mut self, h: Interval) -> bool {
        self.remainder.guess.copy_from_slice(&self.remainder.found);
        for _ in 0..TRIES {
            self.remainder.guess.iter_mut().for_each(|x| *x = enlarged(*x));
            self.enclose_tube(h);
            let RemainderGuess { guess, found } = &mut self.remainder;
            self.linearisation.remainder(&self.tube, found);
            let is_inside = |(found, guess): (&Interval, &Interval)| {
                found.lo() > guess.lo() && found.hi() < guess.hi() && guess.mag().is_finite()
            };
            if found.iter().zip(&*guess).all(is_inside) {
                return true;
            }
            if found.iter().any(|x| !x.mag().is_finite()) {
                return false;
            }
            guess.iter_mut().zip(&*found).for_each(|(guess, found)| *guess = guess.hull(*found));
        }
        false
    }

    /// Encloses the tube under the guess of the remainder.
    ///
    /// Input and remainder move the state within the step by at most h e^{|A|h} times their
    /// magnitude.
    fn enclose_tube(&mut self, h: Interval) {
        let Self { linearisation, remainder, scratch, .. } = self;
        let [reach, ..] = &mut scratch.vectors;
        let system = linearisation.system;
        linearisation.linear.drive(system, &remainder.guess, Interval::mag, &mut scratch.drive);
        self.exponential.bound_times(&scratch.drive, reach);
        for ((tube, linear), reach) in
            self.tube.iter_mut().zip(&self.linear_solution.tube).zip(&*reach)
        {
            *tube = *linear + symmetric(round_up_sum(reach * h.hi(), 1));
        }
    }

    /// Updates the set to the end of the step, under the verified remainder.
    fn update_set(&mut self, set: &mut ReachableZonotope, h: Interval) {
        let half = 0.5 * h.hi();
        self.bound_drive(set, h);
        // Generators: half of the drive before Φ, half of it after.
        self.add_drive_at_start(set, half);
        let StepWorkspace { sums, vectors, .. } = &mut self.scratch;
        set.store(&self.exponential.phi, &self.directions, &mut vectors[0], sums);
        self.set_drive_at_end(set, half);
        // Centre, and a box of all errors of the step.
        let [_, _, errors, bulge] = &self.scratch.vectors;
        let twelfth = (h.powi(3) / 12.0).hi();
        for i in 0..set.centre.len() {
            let end = self.linear_solution.end[i] + self.linearisation.point()[i];
            self.last_move[i] = end.mid() - set.centre[i];
            set.centre[i] = end.mid();
            let others = errors[i] + bulge[i] * twelfth + half * self.remainder.found[i].rad();
            set.axis_lengths[i] = round_up_sum(set.axis_lengths[i] + end.rad() + others, 4);
        }
        set.measure(&self.directions, &self.scratch.sums, self.most_generators);
    }

    /// Adds the middle of the remainder to the end, and bounds the errors and the distance from the
    /// chord in `scratch.vectors[2]` and `scratch.vectors[3]`.
    fn bound_drive(&mut self, set: &ReachableZonotope, h: Interval) {
        let Self { linearisation, exponential, linear_solution, remainder, scratch, .. } = self;
        let (n, half, system) = (set.centre.len(), 0.5 * h.hi(), linearisation.system);
        let (linear, drive) = (&mut linearisation.linear, &mut scratch.drive);
        linear.drive(system, &remainder.found, Interval::rad, drive);
        let [spare, reach, errors, bulge] = &mut scratch.vectors;
        let centres = linear.remainder_centre(system, &remainder.found);
        add_drift(exponential, h, centres, &mut linear_solution.end, [spare, errors]);
        // Rounding of Φ and of its products.
        (0..n).for_each(|i| reach[i] = round_up_sum(set.radius[i] + half * drive[i], 1));
        exponential.error_times(reach, errors);
        exponential.rounding_times(reach, spare);
        (0..n).for_each(|i| errors[i] = round_up_sum(errors[i] + spare[i], 1));
        // |A|² e^{|A|h} times the drive.
        exponential.bound_times(drive, spare);
        linear.a.apply_absolute(spare, reach);
        linear.a.apply_absolute(reach, bulge);
    }

    /// Adds the contribution of input and remainder at the start of the step.
    fn add_drive_at_start(&mut self, set: &mut ReachableZonotope, half: f64) {
        let Self { linearisation, exponential, remainder, scratch, .. } = self;
        let (n, system, linear) = (set.centre.len(), linearisation.system, &linearisation.linear);
        for (g, length) in set.direction_lengths.iter_mut().enumerate() {
            let along = linear.along_direction(system, g, &remainder.found);
            *length = round_up_sum(*length + half * along, 2);
        }
        for j in 0..set.column_lengths.len() {
            let column = linear.column(j);
            let own = round_up_sum(half * linear.input_radius[j], 1);
            if set.columns[j * n..(j + 1) * n] == *column {
                set.column_lengths[j] = round_up_sum(set.column_lengths[j] + own, 1);
            } else {
                // The column has changed, so the generator along the old one is stored separately.
                set.store_column(j, &exponential.phi, &mut scratch.vectors[0], &mut scratch.sums);
                set.columns[j * n..(j + 1) * n].copy_from_slice(column);
                set.column_lengths[j] = own;
            }
        }
        for (i, length) in set.axis_lengths.iter_mut().enumerate() {
            *length = round_up_sum(*length + half * remainder.found[i].rad(), 1);
        }
    }

    /// Sets the contribution of input and remainder at the end of the step.
    fn set_drive_at_end(&mut self, set: &mut ReachableZonotope, half: f64) {
        let (system, linear) = (self.linearisation.system, &self.linearisation.linear);
        for (g, length) in set.direction_lengths.iter_mut().enumerate() {
            let along = linear.along_direction(system, g, &self.remainder.found);
            *length = round_up_sum(half * along, 1);
        }
        for (j, length) in set.column_lengths.iter_mut().enumerate() {
            *length = round_up_sum(half * linear.input_radius[j], 1);
        }
    }
}

/// Adds h φ₁ `rate` to `end`.
fn add_drift(
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

fn symmetric(radius: f64) -> Interval {
    Interval::centred(0.0, radius)
}

fn enlarged(x: Interval) -> Interval {
    let more = ENLARGEMENT * x.width() + LEAST_ENLARGEMENT;
    x + symmetric(more)
}
