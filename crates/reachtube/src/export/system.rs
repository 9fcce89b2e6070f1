//! The right-hand side of a model, as terms that every tool can write.

use reachtube_abstraction::PolynomialModel;
use reachtube_reach::{LinearSystem, System as Dynamics};
use reachtube_recordings::State;
use reachtube_robot::JointKind;

/// ẋ = f(x, u) as polynomials, with the names of states and inputs.
///
/// The states are q, q̇, and for models 2 and 3 also sin q and cos q (q and 1 for a prismatic
/// joint), n of each; the inputs are u, n. SI units.
#[derive(Debug, Clone)]
pub struct System {
    /// Names of the states, N: 2n or 4n.
    pub states: Vec<String>,
    /// Names of the inputs, n.
    pub inputs: Vec<String>,
    /// The derivative of each state, N.
    pub rates: Vec<Polynomial>,
    /// A, B and d if the model is affine; the states are then q and q̇.
    pub linear: Option<LinearSystem>,
    /// Kinds of the joints, n.
    pub kinds: Vec<JointKind>,
    /// The model where it is not affine.
    model: Option<PolynomialModel>,
}

/// A polynomial in states and inputs: a sum of terms.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Polynomial {
    /// The terms.
    pub terms: Vec<Term>,
}

/// A coefficient times powers of offsets of variables.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// The coefficient.
    pub coefficient: f64,
    /// The factors, none for a constant.
    pub factors: Vec<Factor>,
}

/// A power of a variable's offset from a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factor {
    /// Index of the variable: the states, then the inputs.
    pub variable: usize,
    /// The origin of the variable, often 0.
    pub origin: f64,
    /// The exponent, 1 or more.
    pub power: u8,
}

impl System {
    /// Takes the model of `dynamics`, which counts as affine wherever its polynomials are.
    #[must_use]
    pub(crate) fn new(dynamics: &Dynamics, kinds: Vec<JointKind>) -> Self {
        let n = kinds.len();
        let model = dynamics.nonlinear_system();
        let model = model.and_then(|model| model.any().downcast_ref::<PolynomialModel>());
        let affine_model = || model.and_then(|model| model.linear_system().ok());
        let linear = dynamics.linear_system().cloned().or_else(affine_model);
        let model = model.filter(|_| linear.is_none());
        let mut states: Vec<String> =
            (0..2 * n).map(|i| State::from_index(i, n).to_string()).collect();
        let inputs = (1..=n).map(|j| format!("u{j}")).collect();
        let rates = linear.as_ref().map(affine).or(model.map(polynomial)).unwrap_or_default();
        if let Some(model) = model.filter(|model| model.layout().trigonometric) {
            let names = model.variable_names();
            // The sine of a prismatic joint is its position, under a name of its own.
            let copied = |(i, name): (usize, &String)| match kinds[i % n] {
                JointKind::Revolute => name.clone(),
                JointKind::Prismatic if i < n => format!("{name}_copy"),
                JointKind::Prismatic => name.clone(),
            };
            states.extend(names[n..3 * n].iter().enumerate().map(copied));
        }
        Self { states, inputs, rates, linear, kinds, model: model.cloned() }
    }

    /// Returns the number of states N.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.states.len()
    }

    /// Returns the highest degree of a term in states and inputs together.
    #[must_use]
    pub(crate) fn degree(&self) -> u32 {
        let of = |term: &Term| term.factors.iter().map(|factor| u32::from(factor.power)).sum();
        self.rates.iter().flat_map(|rate| &rate.terms).map(of).max().unwrap_or(0)
    }

    /// Returns the state of positions `q` and velocities `qd`, n each: N values.
    #[must_use]
    pub fn state(&self, q: &[f64], qd: &[f64]) -> Vec<f64> {
        self.model.as_ref().map_or_else(|| [q, qd].concat(), |model| model.state(q, qd))
    }

    /// Evaluates ẋ at the state `x`, N, and the input `u`, n, without the terms of this export: A,
    /// B and d of an affine model, and the model's own evaluation of any other.
    #[must_use]
    pub fn rate(&self, x: &[f64], u: &[f64]) -> Vec<f64> {
        if let Some(model) = &self.model {
            return model.rate(x, u);
        }
        let Some(system) = &self.linear else { return Vec::new() };
        let product = |row: &[f64], by: &[f64]| row.iter().zip(by).map(|(a, b)| a * b).sum::<f64>();
        let row = |i: usize| {
            let [a, b] = [system.a(), system.b()]
                .map(|matrix| matrix.row(i).iter().copied().collect::<Vec<_>>());
            product(&a, x) + product(&b, u) + system.drift()[i]
        };
        (0..self.dimension()).map(row).collect()
    }
}

impl Polynomial {
    /// Returns the polynomial without its constant term.
    #[must_use]
    pub(crate) fn without_constant(&self) -> Self {
        let terms = self.terms.iter().filter(|term| !term.factors.is_empty());
        Self { terms: terms.cloned().collect() }
    }
}

/// Returns A x + B u + d without its zeros.
fn affine(system: &LinearSystem) -> Vec<Polynomial> {
    let (states, inputs) = (system.states(), system.inputs());
    let row = |i: usize| {
        let entries = (0..states).map(|j| system.a()[(i, j)]);
        let entries = entries.chain((0..inputs).map(|j| system.b()[(i, j)]));
        let linear = entries.enumerate().map(|(variable, coefficient)| Term {
            coefficient,
            factors: vec![Factor { variable, origin: 0.0, power: 1 }],
        });
        let constant = Term { coefficient: system.drift()[i], factors: Vec::new() };
        let terms = linear.chain([constant]).filter(|term| term.coefficient != 0.0).collect();
        Polynomial { terms }
    };
    (0..states).map(row).collect()
}

/// Returns the right-hand side of a polynomial model: its accelerations as they are, about their
/// origin, and q' = q̇, (sin q)' = q̇ cos q, (cos q)' = -q̇ sin q.
fn polynomial(model: &PolynomialModel) -> Vec<Polynomial> {
    let n = model.joints();
    let single = |coefficient: f64, variables: &[usize]| Polynomial {
        terms: vec![Term {
            coefficient,
            factors: variables
                .iter()
                .map(|&variable| Factor { variable, origin: 0.0, power: 1 })
                .collect(),
        }],
    };
    let mut rates: Vec<Polynomial> = (0..n).map(|j| single(1.0, &[n + j])).collect();
    // The polynomials' variables are q̇, then the other states, then u: all but q.
    let factor = |(z, &power): (usize, &u8)| {
        (power > 0).then(|| Factor { variable: n + z, origin: model.origin()[z], power })
    };
    rates.extend(model.acceleration().iter().map(|f| {
        Polynomial {
            terms: f
                .terms()
                .iter()
                .map(|term| Term {
                    coefficient: term.coefficient,
                    factors: term.exponents.iter().enumerate().filter_map(factor).collect(),
                })
                .collect(),
        }
    }));
    if model.layout().trigonometric {
        let kinds = || model.joint_kinds().iter().enumerate();
        rates.extend(kinds().map(|(j, kind)| match kind {
            JointKind::Revolute => single(1.0, &[n + j, 3 * n + j]),
            JointKind::Prismatic => single(1.0, &[n + j]),
        }));
        rates.extend(kinds().map(|(j, kind)| match kind {
            JointKind::Revolute => single(-1.0, &[n + j, 2 * n + j]),
            JointKind::Prismatic => Polynomial::default(),
        }));
    }
    rates
}
