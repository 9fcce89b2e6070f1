//! Units of tables and figures with one row per joint.

use crate::joint_kind::JointKind;

/// The unit of a column of values, one per joint: it stands in the head where all joints share it,
/// and beside each value otherwise.
///
/// # Examples
///
/// ```
/// use reachtube_robot::JointKind::{self, Prismatic, Revolute};
/// use reachtube_robot::units::ColumnUnit;
///
/// let arm = ColumnUnit::new(&[Revolute, Revolute], JointKind::position_unit);
/// assert_eq!((arm.head("q"), arm.cell(1, "0.2")), ("q [rad]".into(), "0.2".into()));
/// let scara = ColumnUnit::new(&[Revolute, Prismatic], JointKind::position_unit);
/// assert_eq!((scara.head("q"), scara.cell(1, "0.2")), ("q".into(), "0.2 m".into()));
/// ```
#[derive(Debug, Clone)]
pub struct ColumnUnit {
    units: Vec<&'static str>,
}

impl ColumnUnit {
    /// Makes the unit of a column for joints of these kinds.
    #[must_use]
    pub fn new(kinds: &[JointKind], unit: fn(JointKind) -> &'static str) -> Self {
        Self { units: kinds.iter().map(|kind| unit(*kind)).collect() }
    }

    /// Returns the unit that all joints share.
    #[must_use]
    pub fn shared(&self) -> Option<&'static str> {
        let first = *self.units.first()?;
        self.units.iter().all(|unit| *unit == first).then_some(first)
    }

    /// Returns the head of the column.
    #[must_use]
    pub fn head(&self, name: &str) -> String {
        self.shared().map_or_else(|| name.into(), |unit| format!("{name} [{unit}]"))
    }

    /// Returns the text of a value of a joint (from 0).
    #[must_use]
    pub fn cell(&self, joint: usize, value: impl Into<String>) -> String {
        let value = value.into();
        match self.shared() {
            Some(_) => value,
            None => format!("{value} {}", self.units[joint]),
        }
    }
}
