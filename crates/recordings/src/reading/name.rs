//! The name of a column, taken apart into quantity, origin, unit and joint.

use super::unit::{AngleUnit, TimeUnit};

/// The quantity in a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Quantity {
    Time,
    Position,
    Velocity,
    Torque,
    Current,
    Temperature,
    /// Something that a recording does not have: accelerations, forces of a tool, errors.
    Other,
}

/// The source of the values of a column, best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Origin {
    Measured,
    Unstated,
    Target,
}

/// The name of a column, taken apart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ColumnName {
    /// All words and numbers of the name in lower case.
    pub words: Vec<String>,
    pub quantity: Option<Quantity>,
    pub origin: Origin,
    /// Words and numbers that identify the joint.
    pub joint: Vec<String>,
    pub time_unit: Option<TimeUnit>,
    pub angle: Option<AngleUnit>,
}

/// Words that do not distinguish joints.
const FILLERS: [&str; 17] = [
    "joint",
    "joints",
    "jointstate",
    "jointstates",
    "j",
    "axis",
    "axes",
    "state",
    "states",
    "field",
    "msg",
    "data",
    "motor",
    "robot",
    "value",
    "values",
    "header",
];

/// The words that LeRobot's names of measured positions begin with.
const STATE: [&str; 2] = ["observation", "state"];

impl ColumnName {
    pub(super) fn new(name: &str) -> Self {
        let words = words(name);
        let quantities: Vec<Quantity> = quantities(&words);
        let strongest = quantities.iter().copied().max_by_key(|quantity| rank(*quantity));
        let mut quantity = strongest.or_else(|| of_lerobot(&words));
        let mut origins: Vec<Origin> = words.iter().filter_map(|word| origin(word)).collect();
        // "current" beside another quantity means "now".
        if quantities.contains(&Quantity::Current) && quantity != Some(Quantity::Current) {
            origins.push(Origin::Measured);
        }
        // A time of a target is no time of the samples.
        if quantity == Some(Quantity::Time) && origins.contains(&Origin::Target) {
            quantity = Some(Quantity::Other);
        }
        let origin = match (origins.contains(&Origin::Target), origins.first()) {
            (true, _) => Origin::Target,
            (false, Some(_)) => Origin::Measured,
            (false, None) => Origin::Unstated,
        };
        let angle = words.iter().find_map(|word| angle_unit(word));
        let time_unit = (quantity == Some(Quantity::Time)).then(|| time_unit(&words)).flatten();
        let own = if begins(&words, &STATE) { &words[STATE.len()..] } else { &words };
        let joint = own.iter().filter(|word| is_of_joint(word)).cloned().collect();
        Self { words, quantity, origin, joint, time_unit, angle }
    }

    /// Returns the last number of the name, which is the joint's if the name has one.
    pub(super) fn number(&self) -> Option<usize> {
        self.joint.iter().rev().find_map(|word| word.parse().ok())
    }

    /// Returns the words beside the number: columns of one series share them.
    pub(super) fn series(&self) -> Vec<&str> {
        let last = self.joint.iter().rposition(|word| is_number(word));
        let words = self.joint.iter().enumerate().filter(|(at, _)| Some(*at) != last);
        words.map(|(_, word)| word.as_str()).filter(|word| !FILLERS.contains(word)).collect()
    }

    /// Returns whether the name contains these words and numbers, one after another.
    pub(super) fn contains(&self, other: &[String]) -> bool {
        !other.is_empty() && self.words.windows(other.len()).any(|part| part == other)
    }
}

/// Returns whether a name, of a column or a topic, contains a word for commands.
#[must_use]
pub fn is_commanded(name: &str) -> bool {
    ColumnName::new(name).origin == Origin::Target
}

fn is_number(word: &str) -> bool {
    word.bytes().all(|byte| byte.is_ascii_digit())
}

fn is_of_joint(word: &str) -> bool {
    let speaks = quantity(word).is_some()
        || origin(word).is_some()
        || angle_unit(word).is_some()
        || matches!(word, "nm" | "dot" | "ddot");
    !speaks
}

/// Returns the words and numbers of a name in lower case. A word ends at a sign, at a digit, and
/// before a capital that follows a small letter.
pub(super) fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut last = ' ';
    for letter in name.chars() {
        if letter.is_alphanumeric() || letter == '°' {
            let joined = last.is_alphanumeric()
                && last.is_ascii_digit() == letter.is_ascii_digit()
                && !(last.is_lowercase() && letter.is_uppercase());
            if !joined {
                words.push(String::new());
            }
            if let Some(word) = words.last_mut() {
                word.extend(letter.to_lowercase());
            }
        }
        last = letter;
    }
    words
}

/// Returns the quantities that the words name; "q dot" is one.
fn quantities(words: &[String]) -> Vec<Quantity> {
    let of = |(at, word): (usize, &String)| match (quantity(word)?, words.get(at + 1)) {
        (Quantity::Position, Some(next)) if next == "dot" => Some(Quantity::Velocity),
        (Quantity::Position, Some(next)) if next == "ddot" => Some(Quantity::Other),
        (quantity, _) => Some(quantity),
    };
    words.iter().enumerate().filter_map(of).collect()
}

fn quantity(word: &str) -> Option<Quantity> {
    Some(match word {
        "q" | "pos" | "position" | "positions" | "angle" | "angles" | "theta" | "qpos" => {
            Quantity::Position
        }
        "qd" | "dq" | "vel" | "velocity" | "velocities" | "speed" | "speeds" | "qdot" | "qvel"
        | "dtheta" => Quantity::Velocity,
        "tau" | "torque" | "torques" | "effort" | "efforts" | "eff" | "moment" | "moments"
        | "trq" | "force" | "forces" => Quantity::Torque,
        "current" | "currents" | "curr" | "amps" => Quantity::Current,
        "temp" | "temps" | "temperature" | "temperatures" => Quantity::Temperature,
        "t" | "time" | "timestamp" | "timestamps" | "stamp" | "secs" | "nsecs" | "nanosec" => {
            Quantity::Time
        }
        "qdd" | "ddq" | "qddot" | "qacc" | "acc" | "accel" | "acceleration" | "accelerations"
        | "tcp" | "tool" | "pose" | "wrench" | "voltage" | "voltages" | "error" | "errors"
        | "err" | "ext" | "external" | "cartesian" | "ee" | "ft" | "jerk" | "scaling"
        | "gravity" | "coriolis" => Quantity::Other,
        _ => return None,
    })
}

/// Returns the quantity of LeRobot's names, which have no word for it.
fn of_lerobot(words: &[String]) -> Option<Quantity> {
    (begins(words, &["action"]) || begins(words, &STATE)).then_some(Quantity::Position)
}

fn begins(words: &[String], with: &[&str]) -> bool {
    words.len() >= with.len() && words.iter().zip(with).all(|(word, with)| word == with)
}

/// Returns how strongly a word stands for its quantity against the others of a name.
fn rank(quantity: Quantity) -> u8 {
    match quantity {
        Quantity::Time => 0,
        Quantity::Current => 1,
        Quantity::Position => 2,
        Quantity::Velocity => 3,
        Quantity::Torque => 4,
        Quantity::Temperature => 5,
        Quantity::Other => 6,
    }
}

fn origin(word: &str) -> Option<Origin> {
    match word {
        "actual" | "act" | "measured" | "meas" | "msr" | "fbk" | "feedback" | "real"
        | "observation" => Some(Origin::Measured),
        "target" | "desired" | "des" | "cmd" | "cmptd" | "command" | "commands" | "commanded"
        | "ref" | "reference" | "setpoint" | "goal" | "action" | "d" => Some(Origin::Target),
        _ => None,
    }
}

fn angle_unit(word: &str) -> Option<AngleUnit> {
    match word {
        "deg" | "degs" | "degree" | "degrees" | "°" => Some(AngleUnit::Degrees),
        "rad" | "rads" | "radian" | "radians" => Some(AngleUnit::Radians),
        _ => None,
    }
}

fn time_unit(words: &[String]) -> Option<TimeUnit> {
    let unit = |word: &String| match word.as_str() {
        "s" | "sec" | "secs" | "seconds" => Some(TimeUnit::Seconds),
        "ms" | "msec" | "msecs" | "milliseconds" => Some(TimeUnit::Milliseconds),
        "us" | "µs" | "μs" | "usec" | "usecs" | "microseconds" => Some(TimeUnit::Microseconds),
        "ns" | "nsec" | "nsecs" | "nanosec" | "nanoseconds" => Some(TimeUnit::Nanoseconds),
        _ => None,
    };
    words.iter().rev().find_map(unit)
}

#[cfg(test)]
mod tests {
    use super::{ColumnName, Origin, Quantity};
    use crate::reading::unit::{AngleUnit, TimeUnit};

    #[test]
    fn names_of_many_drivers_are_taken_apart() {
        use Origin::{Measured, Target, Unstated};
        use Quantity::{Current, Other, Position, Time, Torque, Velocity};
        let cases = [
            ("actual_q_0", Some(Position), Measured, Some(0)),
            ("target_q_5", Some(Position), Target, Some(5)),
            ("actual_dq_0", Some(Velocity), Measured, Some(0)),
            ("actual_qd_3", Some(Velocity), Measured, Some(3)),
            ("target_moment_0", Some(Torque), Target, Some(0)),
            ("actual_current_0", Some(Current), Measured, Some(0)),
            ("actual_TCP_speed_2", Some(Other), Measured, Some(2)),
            ("Position1", Some(Position), Unstated, Some(1)),
            ("q_joint_1", Some(Position), Unstated, Some(1)),
            ("q_dot_2", Some(Velocity), Unstated, Some(2)),
            ("- arm_1_joint_position", Some(Position), Unstated, Some(1)),
            ("/joint_states/arm_1_joint/velocity", Some(Velocity), Unstated, Some(1)),
            ("field.effort4", Some(Torque), Unstated, Some(4)),
            ("axis2_eff", Some(Torque), Unstated, Some(2)),
            ("current_position_1", Some(Position), Measured, Some(1)),
            ("q_d[3]", Some(Position), Target, Some(3)),
            ("tau_q1", Some(Torque), Unstated, Some(1)),
            ("tau_J[0]", Some(Torque), Unstated, Some(0)),
            ("jointPosition7", Some(Position), Unstated, Some(7)),
            ("timestamp", Some(Time), Unstated, None),
            ("target_qdd_1", Some(Other), Target, Some(1)),
            ("safety_mode", None, Unstated, None),
            ("action_kLeftElbow", Some(Position), Target, None),
            ("action_shoulder_pan.pos", Some(Position), Target, None),
            ("observation.state_6", Some(Position), Measured, Some(6)),
            ("observation.velocity_2", Some(Velocity), Measured, Some(2)),
            ("observation.environment_state_1", None, Measured, Some(1)),
            ("axis3_cmptd_pos", Some(Position), Target, Some(3)),
        ];
        for (text, quantity, origin, number) in cases {
            let name = ColumnName::new(text);
            assert_eq!((name.quantity, name.origin), (quantity, origin), "{text}");
            assert_eq!(name.number(), number, "{text}");
        }
    }

    #[test]
    fn units_in_names_count() {
        assert_eq!(ColumnName::new("time [ms]").time_unit, Some(TimeUnit::Milliseconds));
        assert_eq!(ColumnName::new("timestamp_ns").time_unit, Some(TimeUnit::Nanoseconds));
        assert_eq!(ColumnName::new("t").time_unit, None);
        assert_eq!(ColumnName::new("observation.state_pan.pos").joint, ["pan"]);
        assert_eq!(ColumnName::new("q1 [deg]").angle, Some(AngleUnit::Degrees));
        assert_eq!(ColumnName::new("q1 [deg]").number(), Some(1));
        assert_eq!(ColumnName::new("vel_2(rad/s)").angle, Some(AngleUnit::Radians));
        assert_eq!(ColumnName::new("vel_2(rad/s)").number(), Some(2));
    }

    #[test]
    fn columns_of_a_series_share_their_words() {
        assert_eq!(ColumnName::new("left_q_1").series(), ["left"]);
        assert_eq!(ColumnName::new("q_joint_1").series(), [""; 0]);
        assert!(ColumnName::new("- arm_1_joint_position").contains(&super::words("arm_1_joint")));
        assert!(!ColumnName::new("arm_10_joint_position").contains(&super::words("arm_1_joint")));
    }
}
