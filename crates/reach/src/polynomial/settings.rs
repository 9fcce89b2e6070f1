/// The method that propagates sets from step to step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum FlowpipeMethod {
    /// Conservative linearisation of zonotopes (Althoff, Stursberg, Buss, CDC 2008).
    ///
    /// Choose it for a large uncertain input. In each step, the system is its linear part about a
    /// point near the middle of the set plus a remainder. The remainder is bounded over the tube of
    /// the step, and containment proves the tube. For a polynomial the recentred form
    /// f(z* + d) = Σ c_α dᵅ is exact and finite.
    #[default]
    Linearisation,
    /// Taylor models of the state as a function of the initial state.
    ///
    /// Choose it for a large initial set. The state is a polynomial of degree `order` in the
    /// initial state and, over each step, in time, plus an offset. The offset obeys
    /// ė = A e + B (u - u*) + d and is stored as a zonotope. A and B enclose the derivatives of f
    /// over the tube of the step, which containment proves, and d is the defect of the polynomial.
    TaylorModels {
        /// The degree, at least 1; 3 to 5 suits 7 states, up to 12 suits 2 states.
        order: u32,
    },
}

/// Settings of a flowpipe.
#[derive(Debug, Clone, PartialEq)]
pub struct FlowpipeSettings {
    /// The method that propagates sets.
    pub method: FlowpipeMethod,
    /// Number n of variables and squares of variables over whose 2ⁿ vertices
    /// [`Linearisation`](FlowpipeMethod::Linearisation) bounds the remainder, at most 20.
    ///
    /// More vertices give tighter bounds of polynomials with many terms, since the terms are seldom
    /// large together. Each further variable doubles their cost. 0 uses no vertices.
    pub vertex_variables: usize,
    /// Largest number of generators, in multiples of the number of states; `None` for no limit.
    ///
    /// Beyond it, the oldest generators become a box. No limit gives the tightest sets.
    pub order: Option<usize>,
    /// Number of pieces of the initial set along each state, N entries; empty for one piece.
    ///
    /// Each piece is propagated separately, and the flowpipe is the hull of all.
    pub pieces: Vec<usize>,
}

impl Default for FlowpipeSettings {
    fn default() -> Self {
        Self {
            method: FlowpipeMethod::default(),
            vertex_variables: 8,
            order: None,
            pieces: Vec::new(),
        }
    }
}
