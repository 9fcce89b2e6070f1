use reachtube_scalar::{Interval, TaylorPolynomial, TaylorTerm};

use super::angles::Angles;
use super::directions::{Direction, directions};
use super::shift::ShiftedPolynomial;
use crate::ReachError;

/// The polynomial system ẋ = f(x, u) with N states x and m inputs u; polynomials may be in sines
/// and cosines of states too.
///
/// Coefficients are intervals: a system whose coefficients are known to an ulp only is enclosed
/// with all systems within. Points are exact numbers ([`Interval::point`]).
///
/// # Examples
///
/// ```
/// use reachtube_reach::PolynomialSystem;
/// use reachtube_scalar::{Interval, TaylorPolynomial, TaylorSpace};
///
/// // Van der Pol: ẋ = y, ẏ = (1 - x²) y - x.
/// let space = TaylorSpace::new(2, 3).unwrap();
/// let [x, y] = [0, 1].map(|i| TaylorPolynomial::<Interval>::variable(&space, i));
/// let system = PolynomialSystem::new(2, 0, &[y.clone(), &y - &(&(&x * &x) * &y) - x])?;
/// assert_eq!((system.states(), system.inputs()), (2, 0));
/// # Ok::<(), reachtube_reach::ReachError>(())
/// ```
#[derive(Debug, Clone)]
pub struct PolynomialSystem {
    states: usize,
    inputs: usize,
    /// f as it was given, in (x, u).
    pub(super) components: Vec<TaylorPolynomial<Interval>>,
    /// What of each component no direction has.
    pub(super) rows: Vec<ShiftedPolynomial>,
    /// f = rows + Σ direction · polynomial.
    pub(super) directions: Vec<Direction>,
    /// For each input, the direction that carries it, and the factor.
    pub(super) carriers: Vec<Option<Carrier>>,
    pub(super) angles: Angles,
    /// The highest exponent of each of the N + m variables, and the highest φ_l of each angle.
    pub(super) highest: Vec<u32>,
}

/// An input that enters f as the column of a direction times a factor.
#[derive(Debug, Clone, Copy)]
pub(super) struct Carrier {
    pub direction: usize,
    pub factor: f64,
}

impl PolynomialSystem {
    /// The system with the given components, N polynomials in (x, u): `states` + `inputs`
    /// variables, or constants.
    ///
    /// Terms of several components whose coefficients are those of one fixed direction (as M⁻¹ e_j
    /// for the torque of joint j) are found, and what is uncertain in them moves the state along
    /// that direction only.
    ///
    /// # Errors
    ///
    /// [`ReachError::Shape`] where the number of components or of variables does not fit;
    /// [`ReachError::NotFinite`] for a coefficient that is not bounded.
    pub fn new(
        states: usize,
        inputs: usize,
        components: &[TaylorPolynomial<Interval>],
    ) -> Result<Self, ReachError> {
        Self::trigonometric(states, inputs, &[], components)
    }

    /// The system with the given components, N polynomials in (x, u, s, c): the states, the inputs,
    /// then s_i = sin x_j and then c_i = cos x_j for each state j of `angles` (rad).
    ///
    /// The sets stay on the circle: s and c are no states but functions of them, and are bounded as
    /// such, for angles up to 10⁶ rad.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new); [`ReachError::Shape`] for an angle that is no state.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_reach::{Flowpipe, FlowpipeSettings, Hyperrectangle, PolynomialSystem, TimeGrid, UncertainInput};
    /// use reachtube_scalar::{Interval, TaylorPolynomial, TaylorSpace};
    ///
    /// // A pendulum, q̈ = -sin q; the variables are q, q̇, sin q and cos q.
    /// let space = TaylorSpace::new(4, 2).unwrap();
    /// let [_, velocity, sine, _] = [0, 1, 2, 3].map(|i| TaylorPolynomial::<Interval>::variable(&space, i));
    /// let pendulum = PolynomialSystem::trigonometric(2, 0, &[0], &[velocity, -sine])?;
    /// let (grid, at_rest) = (TimeGrid::uniform(0.01, 301), Hyperrectangle { center: vec![0.0; 2], radius: vec![0.01, 0.0] });
    /// let input = UncertainInput { measured: &[], set: &Hyperrectangle::zero(0) };
    /// let flowpipe = Flowpipe::new(&pendulum, &grid, &[1.0, 0.0], &at_rest, &input, &FlowpipeSettings::default())?;
    /// // Its energy stays q̇²/2 - cos q = -cos 1 about.
    /// let [q, velocity] = flowpipe.sample(300) else { unreachable!() };
    /// let energy = velocity.sqr() * 0.5 - q.cos();
    /// assert!(energy.contains(-1f64.cos()) && energy.width() < 0.1);
    /// # Ok::<(), reachtube_reach::ReachError>(())
    /// ```
    pub fn trigonometric(
        states: usize,
        inputs: usize,
        angles: &[usize],
        components: &[TaylorPolynomial<Interval>],
    ) -> Result<Self, ReachError> {
        let variables = states + inputs + 2 * angles.len();
        let shape = |what, rows, found_rows| ReachError::Shape {
            what,
            rows,
            columns: 1,
            found_rows,
            found_columns: 1,
        };
        if let Some(angle) = angles.iter().find(|angle| **angle >= states) {
            return Err(shape(
                "the state that an angle is, with all before it,",
                states,
                angle + 1,
            ));
        }
        if components.len() != states {
            return Err(shape("the list of components of f", states, components.len()));
        }
        let mut terms = Vec::with_capacity(states);
        for (row, component) in components.iter().enumerate() {
            if let Some(space) = component.space().filter(|space| space.variables() != variables) {
                return Err(shape(
                    "the list of variables of a component",
                    variables,
                    space.variables(),
                ));
            }
            terms.push(checked_terms(row, variables, component)?);
        }
        let angles = Angles::new(states + inputs, angles, terms.iter().flatten());
        Ok(Self::from_terms(states, inputs, angles, components.to_vec(), terms))
    }

    fn from_terms(
        states: usize,
        inputs: usize,
        angles: Angles,
        components: Vec<TaylorPolynomial<Interval>>,
        mut terms: Vec<Vec<TaylorTerm<Interval>>>,
    ) -> Self {
        let directions = directions(&angles, &mut terms);
        let carriers = (0..inputs).map(|j| carrier(states + j, &directions, &terms)).collect();
        let rows: Vec<_> =
            terms.iter().map(|terms| ShiftedPolynomial::new(&angles, terms)).collect();
        let mut highest = vec![1; angles.plain + angles.states.len()];
        rows.iter().for_each(|row| row.raise_exponents(&mut highest));
        directions.iter().for_each(|direction| direction.polynomial.raise_exponents(&mut highest));
        Self { states, inputs, components, rows, directions, carriers, angles, highest }
    }

    /// Number of states N.
    pub fn states(&self) -> usize {
        self.states
    }

    /// Number of inputs m.
    pub fn inputs(&self) -> usize {
        self.inputs
    }
}

fn checked_terms(
    row: usize,
    variables: usize,
    component: &TaylorPolynomial<Interval>,
) -> Result<Vec<TaylorTerm<Interval>>, ReachError> {
    let mut terms = component.terms();
    for (column, term) in terms.iter_mut().enumerate() {
        term.exponents.resize(variables, 0);
        let value = term.coefficient.mag();
        if !value.is_finite() {
            return Err(ReachError::NotFinite { what: "a component of f", row, column, value });
        }
    }
    Ok(terms)
}

/// The direction that carries input `variable`, where it enters f linearly and along one direction.
/// What the direction has of it stays out of `terms` already.
fn carrier(
    variable: usize,
    directions: &[Direction],
    terms: &[Vec<TaylorTerm<Interval>>],
) -> Option<Carrier> {
    let occurs =
        |terms: &[TaylorTerm<Interval>]| terms.iter().any(|term| term.exponents[variable] > 0);
    let mut with_input = directions.iter().enumerate().filter(|(_, d)| occurs(&d.terms));
    let (direction, carrier) = with_input.next()?;
    let sole = carrier.terms.iter().filter(|term| term.exponents[variable] > 0).collect::<Vec<_>>();
    let [term] = sole[..] else { return None };
    let is_linear = term.exponents.iter().map(|e| u32::from(*e)).sum::<u32>() == 1;
    let is_alone = with_input.next().is_none() && is_tiny(variable, terms, term.coefficient.mag());
    (is_linear && is_alone).then(|| Carrier { direction, factor: term.coefficient.mid() })
}

/// Whether the rows have no more of the variable than the rounding of its coefficients, which is
/// linear.
fn is_tiny(variable: usize, terms: &[Vec<TaylorTerm<Interval>>], scale: f64) -> bool {
    let own = terms.iter().flatten().filter(|term| term.exponents[variable] > 0);
    own.clone().all(|term| {
        term.exponents.iter().map(|e| u32::from(*e)).sum::<u32>() == 1
            && term.coefficient.mag() <= 1e-9 * scale
    })
}
