//! Which variables a model's polynomials have, and in which order.

use super::ModelKind;

/// Variables of a model: q̇, then sin q and cos q where the model has them, then u; n of each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Joints n.
    pub joints: usize,
    /// Whether sin q and cos q are variables (Property A).
    pub trigonometric: bool,
}

impl Layout {
    /// The variables of a model.
    pub fn new(kind: ModelKind, joints: usize) -> Self {
        Self { joints, trigonometric: kind != ModelKind::One }
    }

    /// Number of variables k: 2n or 4n.
    pub fn variables(self) -> usize {
        if self.trigonometric { 4 * self.joints } else { 2 * self.joints }
    }

    /// Number of states: 2n, (q, q̇), or 4n, (q, q̇, sin q, cos q).
    pub fn states(self) -> usize {
        if self.trigonometric { 4 * self.joints } else { 2 * self.joints }
    }

    /// Place of q̇ of joint i.
    pub fn velocity(self, i: usize) -> usize {
        i
    }

    /// Place of sin q of joint i; only for trigonometric models.
    pub fn sine(self, i: usize) -> usize {
        self.joints + i
    }

    /// Place of cos q of joint i; only for trigonometric models.
    pub fn cosine(self, i: usize) -> usize {
        2 * self.joints + i
    }

    /// Place of u of joint i.
    pub fn input(self, i: usize) -> usize {
        self.variables() - self.joints + i
    }

    /// Names of the variables: qd1, s1, c1, u1, ...
    pub fn names(self) -> Vec<String> {
        let groups: &[&str] =
            if self.trigonometric { &["qd", "s", "c", "u"] } else { &["qd", "u"] };
        let group =
            |name: &&str| (1..=self.joints).map(|i| format!("{name}{i}")).collect::<Vec<_>>();
        groups.iter().flat_map(group).collect()
    }
}
