//! The ROS messages that are read: joint states, and marks of runs.

use crate::cdr::{Cdr, Doubles};

/// Name of the type of joint states.
pub(crate) const JOINT_STATE: &str = "sensor_msgs/msg/JointState";

/// Name of the type of what a controller of trajectories commands and measures.
pub(crate) const CONTROLLER_STATE: &str = "control_msgs/msg/JointTrajectoryControllerState";

/// Nanoseconds in a second.
pub(crate) const SECOND: i64 = 1_000_000_000;

/// A `sensor_msgs/msg/JointState`, with numbers still in the message.
#[derive(Debug)]
pub(crate) struct JointState<'a> {
    /// Time of the header, ns.
    pub(crate) stamp: i64,
    /// Names of the joints, in the order of the values.
    pub(crate) names: Vec<&'a str>,
    /// Positions, velocities and efforts: one value per name, or none.
    pub(crate) values: [Doubles<'a>; 3],
}

impl<'a> JointState<'a> {
    /// Decodes a message.
    ///
    /// # Errors
    ///
    /// A clause about the message, which it calls "it".
    pub(crate) fn decode(message: &'a [u8]) -> Result<Self, String> {
        let mut cdr = Cdr::new(message)?;
        let (stamp, names) = stamp_and_names(&mut cdr)?;
        let values = [cdr.doubles()?, cdr.doubles()?, cdr.doubles()?];
        cdr.end()?;
        Ok(Self { stamp, names, values })
    }
}

/// Reads a header, and the names of joints after it.
fn stamp_and_names<'a>(cdr: &mut Cdr<'a>) -> Result<(i64, Vec<&'a str>), String> {
    let (seconds, nanoseconds) = (cdr.i32()?, cdr.u32()?);
    if i64::from(nanoseconds) >= SECOND {
        return Err(format!("its stamp has {nanoseconds} ns, a second or more"));
    }
    cdr.string()?; // frame_id
    let names = cdr.strings()?;
    Ok((i64::from(seconds) * SECOND + i64::from(nanoseconds), names))
}

/// Positions by names, of one kind or two, with numbers still in the message.
#[derive(Debug)]
pub(crate) struct Positions<'a> {
    /// Time of the header, ns.
    pub(crate) stamp: i64,
    /// Names of the joints, in the order of the values.
    pub(crate) names: Vec<&'a str>,
    /// The positions of a joint state; or the commanded and the measured ones of a controller.
    pub(crate) values: Vec<Doubles<'a>>,
}

impl<'a> Positions<'a> {
    /// Decodes a joint state, or a `control_msgs/msg/JointTrajectoryControllerState`. That begins,
    /// in all its versions, with header, names, and two points: `desired` and `actual`, or
    /// `reference` and `feedback`.
    ///
    /// # Errors
    ///
    /// A clause about the message, which it calls "it".
    pub(crate) fn decode(message: &'a [u8], is_of_controller: bool) -> Result<Self, String> {
        if !is_of_controller {
            let JointState { stamp, names, values: [positions, ..] } = JointState::decode(message)?;
            return Ok(Self { stamp, names, values: vec![positions] });
        }
        let mut cdr = Cdr::new(message)?;
        let (stamp, names) = stamp_and_names(&mut cdr)?;
        let mut point = || {
            let positions = cdr.doubles()?;
            // Velocities, accelerations, efforts, and the time from the start.
            for _ in 0..3 {
                cdr.doubles()?;
            }
            cdr.i32()?;
            cdr.u32()?;
            Ok::<_, String>(positions)
        };
        Ok(Self { stamp, names, values: vec![point()?, point()?] })
    }
}

/// The type of a message that marks runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MarkerKind {
    String,
    Bool,
    Int32,
}

impl MarkerKind {
    /// Names of the types, for messages to the user.
    pub(crate) const NAMES: &str = "std_msgs/msg/String, Bool or Int32";

    /// Returns the kind that a type's name stands for.
    pub(crate) fn of(type_name: &str) -> Option<Self> {
        match type_name {
            "std_msgs/msg/String" => Some(Self::String),
            "std_msgs/msg/Bool" => Some(Self::Bool),
            "std_msgs/msg/Int32" => Some(Self::Int32),
            _ => None,
        }
    }

    /// Decodes a message: `None` outside of runs, else the name of the suite, which is empty for
    /// a Bool.
    pub(crate) fn decode(self, message: &[u8]) -> Result<Option<String>, String> {
        let mut cdr = Cdr::new(message)?;
        let marked = match self {
            Self::String => {
                let text = cdr.string()?.trim();
                (!text.is_empty()).then(|| text.to_string())
            }
            Self::Bool => (cdr.byte()? != 0).then(String::new),
            Self::Int32 => {
                let number = cdr.i32()?;
                (number != 0).then(|| number.to_string())
            }
        };
        cdr.end()?;
        Ok(marked)
    }
}

#[cfg(test)]
mod tests {
    use super::{JointState, MarkerKind};

    #[test]
    fn a_joint_state_is_decoded() {
        let mut message = vec![0, 1, 0, 0];
        message.extend([3u32.to_le_bytes(), 5u32.to_le_bytes(), 1u32.to_le_bytes()].concat());
        message.extend([0, 0, 0, 0]); // frame_id "" and padding
        message.extend([1u32.to_le_bytes(), 2u32.to_le_bytes()].concat());
        message.extend([b'a', 0, 0, 0]);
        message.extend(1u32.to_le_bytes());
        message.extend([0; 4].iter().take((8 - (message.len() - 4) % 8) % 8));
        message.extend(1.5f64.to_le_bytes());
        message.extend([0; 8]); // no velocity, no effort
        let state = JointState::decode(&message).unwrap();
        assert_eq!((state.stamp, &state.names[..]), (3_000_000_005, &["a"][..]));
        let values = state.values.map(|values| (values.len(), values.get(0)));
        assert_eq!(values, [(1, Some(1.5)), (0, None), (0, None)]);
        for length in 0..message.len() {
            assert!(JointState::decode(&message[..length]).is_err(), "{length}");
        }
        message.extend([0; 8]);
        assert_eq!(JointState::decode(&message).unwrap_err(), "8 bytes follow its last field");
        message[8..12].copy_from_slice(&1_000_000_000u32.to_le_bytes());
        assert!(JointState::decode(&message).unwrap_err().contains("a second or more"));
    }

    #[test]
    fn markers_are_inside_runs_or_outside() {
        let string = |text: &[u8]| {
            let length = (text.len() as u32 + 1).to_le_bytes();
            let message = [&[0, 1, 0, 0], &length[..], text, &[0]].concat();
            MarkerKind::String.decode(&message).unwrap()
        };
        assert_eq!((string(b"A"), string(b"")), (Some("A".into()), None));
        let bool = |byte| MarkerKind::Bool.decode(&[0, 1, 0, 0, byte]).unwrap();
        assert_eq!((bool(1), bool(0)), (Some(String::new()), None));
        let int = |number: i32| {
            let message = [&[0, 0, 0, 0], &number.to_be_bytes()[..]].concat();
            MarkerKind::Int32.decode(&message).unwrap()
        };
        assert_eq!((int(-7), int(0)), (Some("-7".into()), None));
    }
}
