use reachtube_reach::Hyperrectangle;
use reachtube_robot::Robot;
use reachtube_scalar::Interval;

use crate::error::{Error, Result};
use crate::stop::brakes::Brakes;
use crate::stop::deceleration::Deceleration;
use crate::stop::path::Path;
use crate::stop::stop::{Stop, stop_0, stop_1};

/// Category of a stop (IEC 60204-1).
#[derive(Debug, Clone, PartialEq)]
pub enum Category {
    /// Drives off and brakes on at once.
    Zero,
    /// A controlled deceleration along the path, then drives off and brakes on.
    One {
        /// The greatest deceleration of each joint on a straight path \[rad/s²; m/s²\].
        limits: Vec<f64>,
        /// Difference of each joint's torque from the controller's, as the model's U.
        input_set: Hyperrectangle,
    },
}

impl Category {
    /// Returns category 1 with the deceleration of the brakes' file and the error of the drives'
    /// torque, which `input_set` returns for decelerations; `None` if the file has none.
    pub(crate) fn one(
        brakes: &Brakes,
        input_set: &dyn Fn(&[f64]) -> Hyperrectangle,
    ) -> Option<Self> {
        let limits = brakes.deceleration.clone()?;
        let input_set = input_set(&limits);
        Some(Self::One { limits, input_set })
    }

    /// Returns the category of a number, 0 or 1, with the deceleration of the brakes' file and the
    /// error of the drives' torque, which `input_set` returns for decelerations
    /// ([`Problem::input_set_at`](reachtube_conform::Problem::input_set_at)); `origin` names that
    /// file in errors.
    ///
    /// # Errors
    ///
    /// [`Error::NoDeceleration`] for category 1 without a deceleration.
    pub fn numbered(
        number: u8,
        brakes: &Brakes,
        origin: &str,
        input_set: &dyn Fn(&[f64]) -> Hyperrectangle,
    ) -> Result<Self> {
        match number {
            0 => Ok(Self::Zero),
            _ => Self::one(brakes, input_set)
                .ok_or_else(|| Error::NoDeceleration { origin: origin.into() }),
        }
    }

    pub(crate) fn number(&self) -> u8 {
        match self {
            Self::Zero => 0,
            Self::One { .. } => 1,
        }
    }

    /// Encloses the stop that begins at the time `from` (s) of a path, from all states of a box.
    /// `None` if the path ends before the deceleration does.
    ///
    /// # Guarantee
    ///
    /// Outer, as [`stop_0`] and [`stop_1`].
    ///
    /// # Panics
    ///
    /// Panics when an argument is of another number of joints.
    #[must_use]
    pub fn stop(
        &self,
        robot: &Robot,
        brakes: &Brakes,
        (path, from): (&Path, f64),
        state: &[Interval],
    ) -> Option<Stop> {
        Some(match self {
            Self::Zero => stop_0(robot, brakes, state),
            Self::One { limits, input_set } => {
                let deceleration = Deceleration::along(robot, path, from, limits)?;
                stop_1(robot, brakes, &deceleration, input_set, state)
            }
        })
    }
}
