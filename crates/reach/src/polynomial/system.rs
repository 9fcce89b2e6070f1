use reachtube_scalar::{Interval, TaylorPolynomial, TaylorTerm};

use crate::error::ReachError;
use crate::polynomial::directions::{FixedDirection, directions};
use crate::polynomial::expansion::angles::Angles;
use crate::polynomial::expansion::monomials::degree;
use crate::polynomial::expansion::recentred::Recentring;

/// A polynomial system ẋ = f(x, u) with N states x and m inputs u; f may also contain sines and
/// cosines of states.
///
/// Coefficients are intervals, and the reachable sets enclose every system within them. An exact
/// coefficient is an [`Interval::point`].
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
    /// Components of f, in the variables of the constructor.
    pub(crate) components: Vec<TaylorPolynomial<Interval>>,
    /// Part of each component that lies along no direction.
    pub(crate) rows: Vec<Recentring>,
    /// The directions: f = rows + Σ column · polynomial.
    pub(crate) directions: Vec<FixedDirection>,
    /// For each input, the direction that carries it and the factor.
    pub(crate) carriers: Vec<Option<Carrier>>,
    pub(crate) angles: Angles,
    /// Highest exponent of each of the N + m variables, and highest index l of φ_l of each angle.
    pub(crate) highest: Vec<u32>,
}

/// An input that enters f linearly, as a factor times the column of a direction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Carrier {
    pub direction: usize,
    pub factor: f64,
}

impl PolynomialSystem {
    /// Builds the system from N components, each a constant or a polynomial in the `states` +
    /// `inputs` variables (x, u).
    ///
    /// Terms whose coefficients form one fixed direction over several components, such as M⁻¹ e_j
    /// for the torque of joint j, are collected. Their uncertainty then moves the state along that
    /// direction only.
    ///
    /// # Errors
    ///
    /// Returns [`ReachError::Shape`] when the number of components or of variables does not fit,
    /// and [`ReachError::NotFinite`] for an unbounded coefficient.
    pub fn new(
        states: usize,
        inputs: usize,
        components: &[TaylorPolynomial<Interval>],
    ) -> Result<Self, ReachError> {
        Self::trigonometric(states, inputs, &[], components)
    }

    /// Builds the system from N polynomials in (x, u, s, c): the states, the inputs, then
    /// s_i = sin x_j and then c_i = cos x_j for each state j of `angles` (rad).
    ///
    /// The sets stay on the circle: s and c are not states but functions of states, and are bounded
    /// as functions. Sines of angles beyond 10⁶ rad have no bound.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`new`](Self::new), and [`ReachError::Shape`] for an angle whose index
    /// is not a state's.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_reach::{
    ///     Flowpipe, FlowpipeSettings, Hyperrectangle, PolynomialSystem, TimeGrid, UncertainInput,
    /// };
    /// use reachtube_scalar::{Interval, TaylorPolynomial, TaylorSpace};
    ///
    /// // A pendulum, q̈ = -sin q; the variables are q, q̇, sin q and cos q.
    /// let space = TaylorSpace::new(4, 2).unwrap();
    /// let variable = |i| TaylorPolynomial::<Interval>::variable(&space, i);
    /// let (velocity, sine) = (variable(1), variable(2));
    /// let pendulum = PolynomialSystem::trigonometric(2, 0, &[0], &[velocity, -sine])?;
    /// let grid = TimeGrid::uniform(0.01, 301);
    /// let initial = Hyperrectangle { centre: vec![0.0; 2], radius: vec![0.01, 0.0] };
    /// let input = UncertainInput { measured: &[], set: &Hyperrectangle::zero(0) };
    /// let settings = FlowpipeSettings::default();
    /// let flowpipe = Flowpipe::new(&pendulum, &grid, &[1.0, 0.0], &initial, &input, &settings)?;
    /// // The energy q̇²/2 - cos q stays near its initial value -cos 1.
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
            return Err(shape("the vector of states up to the angle", states, angle + 1));
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

    /// Separates the directions from the terms of all components.
    fn from_terms(
        states: usize,
        inputs: usize,
        angles: Angles,
        components: Vec<TaylorPolynomial<Interval>>,
        mut terms: Vec<Vec<TaylorTerm<Interval>>>,
    ) -> Self {
        let directions = directions(&angles, &mut terms);
        let carriers = (0..inputs).map(|j| carrier(states + j, &directions, &terms)).collect();
        let rows: Vec<_> = terms.iter().map(|terms| Recentring::new(&angles, terms)).collect();
        let mut highest = vec![1; angles.plain + angles.states.len()];
        rows.iter().for_each(|row| row.raise_exponents(&mut highest));
        directions.iter().for_each(|direction| direction.polynomial.raise_exponents(&mut highest));
        Self { states, inputs, components, rows, directions, carriers, angles, highest }
    }

    /// Returns the number of states.
    #[must_use]
    pub fn states(&self) -> usize {
        self.states
    }

    /// Returns the number of inputs.
    #[must_use]
    pub fn inputs(&self) -> usize {
        self.inputs
    }
}

/// Returns the terms of a component over all variables, or an error for an unbounded coefficient.
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

/// Finds the direction that carries input `variable`, where it enters f linearly and along one
/// direction only.
///
/// `terms` must no longer contain the terms of the directions.
fn carrier(
    variable: usize,
    directions: &[FixedDirection],
    terms: &[Vec<TaylorTerm<Interval>>],
) -> Option<Carrier> {
    let occurs =
        |terms: &[TaylorTerm<Interval>]| terms.iter().any(|term| term.exponents[variable] > 0);
    let mut with_input = directions.iter().enumerate().filter(|(_, d)| occurs(&d.terms));
    let (direction, carrier) = with_input.next()?;
    let sole = carrier.terms.iter().filter(|term| term.exponents[variable] > 0).collect::<Vec<_>>();
    let [term] = sole[..] else { return None };
    let is_linear = degree(&term.exponents) == 1;
    let is_alone = with_input.next().is_none() && is_tiny(variable, terms, term.coefficient.mag());
    (is_linear && is_alone).then(|| Carrier { direction, factor: term.coefficient.mid() })
}

/// Returns whether the rows contain a variable only linearly, with coefficients of the size of
/// rounding errors.
fn is_tiny(variable: usize, terms: &[Vec<TaylorTerm<Interval>>], scale: f64) -> bool {
    let mut own = terms.iter().flatten().filter(|term| term.exponents[variable] > 0);
    own.all(|term| degree(&term.exponents) == 1 && term.coefficient.mag() <= 1e-9 * scale)
}
