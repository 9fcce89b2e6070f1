/// Numbers of unknowns and rows of a program. Programs and searches do not depend on what the
/// states mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shape {
    /// Number of radii of X0.
    pub states: usize,
    /// Number of radii of U.
    pub inputs: usize,
    /// Number of values that are compared at each sample: all states, or what is seen of them.
    pub outputs: usize,
}

impl Shape {
    /// Returns the shape of a system whose states are its outputs.
    pub(crate) fn of_states(states: usize, inputs: usize) -> Self {
        Self { states, inputs, outputs: states }
    }

    /// Returns the number of radii, and of centres, of X0 and U together.
    pub(crate) fn radii(self) -> usize {
        self.states + self.inputs
    }

    /// Returns the number of entries that one sample has in the coefficients of a program: for each
    /// output, a row of E and a row of R.
    pub(crate) fn entries(self) -> usize {
        self.outputs * 2 * self.radii()
    }
}
