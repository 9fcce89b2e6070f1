//! The variables of a model's polynomials and their order.

use reachtube_robot::JointKind;

use crate::model_kind::ModelKind;

/// The variables of a model: q̇, then sin q and cos q if the model has them, then u; n of each.
///
/// A prismatic joint has its position q and the constant 1 in place of sin q and cos q.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Number of joints n.
    pub joints: usize,
    /// Whether sin q and cos q are variables (Property A).
    pub trigonometric: bool,
}

impl Layout {
    /// Returns the layout of a model of `joints` joints.
    #[must_use]
    pub(crate) fn new(kind: ModelKind, joints: usize) -> Self {
        Self { joints, trigonometric: kind != ModelKind::One }
    }

    /// Returns the number of variables, 2n or 4n. There are as many states: (q, q̇), or (q, q̇,
    /// sin q, cos q).
    #[must_use]
    pub(crate) fn variables(self) -> usize {
        if self.trigonometric { 4 * self.joints } else { 2 * self.joints }
    }

    /// Returns the index of q̇ of joint `i` (from 0) among the variables.
    #[must_use]
    pub(crate) fn velocity(self, i: usize) -> usize {
        i
    }

    /// Returns the index of sin q of joint `i` (from 0), for trigonometric models.
    #[must_use]
    pub(crate) fn sine(self, i: usize) -> usize {
        self.joints + i
    }

    /// Returns the index of cos q of joint `i` (from 0), for trigonometric models.
    #[must_use]
    pub(crate) fn cosine(self, i: usize) -> usize {
        2 * self.joints + i
    }

    /// Returns the index of u of joint `i` (from 0) among the variables.
    #[must_use]
    pub(crate) fn input(self, i: usize) -> usize {
        self.variables() - self.joints + i
    }

    /// Returns the names of the variables for joints of these kinds: qd1, .., s1, .., c1, .., u1,
    /// ..; a prismatic joint 1 has q1 and one1 in place of s1 and c1.
    #[must_use]
    pub(crate) fn names(self, kinds: &[JointKind]) -> Vec<String> {
        let [qd, sine, cosine, u] = [["qd"; 2], ["s", "q"], ["c", "one"], ["u"; 2]];
        let groups = if self.trigonometric { vec![qd, sine, cosine, u] } else { vec![qd, u] };
        let name = |[revolute, prismatic]: [&str; 2], i: usize| match kinds[i] {
            JointKind::Revolute => format!("{revolute}{}", i + 1),
            JointKind::Prismatic => format!("{prismatic}{}", i + 1),
        };
        let group = |names: [&'static str; 2]| (0..self.joints).map(move |i| name(names, i));
        groups.into_iter().flat_map(group).collect()
    }
}
