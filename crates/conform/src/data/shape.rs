/// Numbers of states and inputs of a system. Programs and searches do not depend on what the states
/// mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shape {
    pub states: usize,
    pub inputs: usize,
}

impl Shape {
    /// Returns the number of radii, and of centres, of X0 and U together.
    pub(crate) fn radii(self) -> usize {
        self.states + self.inputs
    }

    /// Returns the number of entries that one sample has in the coefficients of a program: for each
    /// state, a row of E and a row of R.
    pub(crate) fn entries(self) -> usize {
        self.states * 2 * self.radii()
    }
}
