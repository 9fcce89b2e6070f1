/// How many states and inputs a system has. What a robot's states mean, n positions and then n
/// velocities, is no matter of programs and searches.
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
