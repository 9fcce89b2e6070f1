use reachtube_robot::{Joint, Robot};

/// What recorded torques contradict in the description of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Contradiction {
    /// A clause that says what, with numbers.
    pub text: String,
    /// The joints that it is about, from 0; none if it is about all.
    pub joints: Vec<usize>,
    /// A number by its name.
    pub number: Option<(&'static str, f64)>,
    /// The setting that helps, its value and what it does.
    pub remedy: Option<[String; 3]>,
    /// Whether no robot like the described one has such torques.
    pub is_certain: bool,
}

impl Contradiction {
    pub(crate) fn new(text: String) -> Self {
        Self { text, joints: Vec::new(), number: None, remedy: None, is_certain: true }
    }

    /// Torques without gravity, of which they have a part of what the description needs in the
    /// heaviest joint.
    pub(crate) fn no_gravity(joint: &Joint, needed: f64, part: f64) -> Self {
        let (name, unit) = (&joint.name, joint.kind.force_unit());
        let text = format!(
            "the recorded torques contain no gravity: the description needs {needed:.1} {unit} \
             of {name} against it (root mean square), and the torques have {:.2} times that; the \
             driver probably publishes efforts without gravity: record the motors' torques or \
             currents, or add the controller's own gravity torque to the columns",
            part.abs()
        );
        Self { number: Some(("gravity", part)), ..Self::new(text) }
    }

    /// Gravity along another direction of the base.
    pub(crate) fn mount(angle: f64, acceleration: [f64; 3]) -> Self {
        let [x, y, z] = acceleration.map(|g| (g * 100.0).round() / 100.0 + 0.0);
        let how = if angle > 2.6 { "hangs from a ceiling" } else { "is on a wall or tilted" };
        let text = format!(
            "gravity along [{x}, {y}, {z}] m/s² of the base explains the recorded torques, at \
             {:.0}° to the description's: the arm probably {how}; state `gravity = [{x}, {y}, \
             {z}]` in the robot's TOML file, or in a TOML file of the same name beside its URDF",
            angle.to_degrees()
        );
        Self { number: Some(("angle", angle)), ..Self::new(text) }
    }

    pub(crate) fn all_opposite(joints: usize) -> Self {
        let text = "all recorded torques have the opposite sign of what the description needs";
        let remedy = ["gains".into(), vec!["-1"; joints].join(","), "turns them.".into()];
        Self { remedy: Some(remedy), ..Self::new(text.into()) }
    }

    pub(crate) fn opposite(robot: &Robot, joints: Vec<usize>) -> Self {
        let names = names(robot, &joints);
        let text = format!(
            "the torque of {names} is opposite to what the description needs: its sign may be wrong"
        );
        Self { joints, ..Self::new(text) }
    }

    /// Torques that are factors of what the description needs, for some joints; about `factor`.
    pub(crate) fn size(robot: &Robot, factors: &[(usize, f64)], factor: f64) -> Self {
        let list = |number: &dyn Fn(f64) -> f64| {
            let each = factors.iter().map(|(_, factor)| digits(number(factor.abs())));
            each.collect::<Vec<_>>().join(", ")
        };
        let unit = match factor {
            700.0..1400.0 => "they are probably in N mm".into(),
            0.0007..0.0014 => "they are probably in kN m".into(),
            1.0.. => format!(
                "they may be per mille of rated torques of {} N m, percent of {} N m, or currents",
                list(&|factor| 1000.0 / factor),
                list(&|factor| 100.0 / factor)
            ),
            _ => format!(
                "they may be currents in A of {} N m/A, or torques of motors before gears of these \
                 ratios",
                list(&f64::recip)
            ),
        };
        let joints: Vec<usize> = factors.iter().map(|(joint, _)| *joint).collect();
        let text = format!(
            "the recorded torques of {} are {} times what the description needs: {unit}; or the \
             description is of another robot or without its load",
            names(robot, &joints),
            list(&|factor| factor),
        );
        let is_whole = factors.len() == robot.joint_count();
        let gains = factors.iter().map(|(_, factor)| digits(factor.abs().recip()));
        let value = if is_whole { gains.collect::<Vec<_>>().join(",") } else { String::new() };
        let effect = "turns currents in A, or parts of a rated torque, into torques by one factor \
                      per joint; factors of 1 state that they are torques already.";
        let remedy = Some(["gains".into(), value, effect.into()]);
        Self { number: Some(("factor", factor)), remedy, ..Self::new(text) }
    }

    pub(crate) fn noise(rest: f64) -> Self {
        let text = format!(
            "neither the robot's links of any mass nor friction explain the recorded torques: \
             {:.0} % of their squares is left in recordings that are left out; check that the \
             columns hold torques, and that they belong to these motions",
            100.0 * rest.min(1.0)
        );
        Self { number: Some(("unexplained", rest)), ..Self::new(text) }
    }
}

pub(crate) fn names(robot: &Robot, joints: &[usize]) -> String {
    let names = joints.iter().map(|joint| robot.joints()[*joint].name.as_str());
    names.collect::<Vec<_>>().join(", ")
}

/// Returns a number with about three digits.
fn digits(value: f64) -> String {
    match value.abs() {
        100.0.. => format!("{value:.0}"),
        10.0..100.0 => format!("{value:.1}"),
        0.1..10.0 => format!("{value:.2}"),
        0.01..0.1 => format!("{value:.3}"),
        _ => format!("{value:.2e}"),
    }
}
