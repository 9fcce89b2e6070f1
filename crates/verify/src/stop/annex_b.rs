//! The table of stopping times and distances that ISO 10218-1 requires in Annex B.

use crate::code::Code;
use rayon::prelude::*;
use reachtube_finding::{Finding, Severity};
use reachtube_reach::Hyperrectangle;
use reachtube_robot::{InertiaPoint, LinkInertia, Robot};
use reachtube_scalar::Interval;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::Result;
use crate::stop::brakes::{Brakes, Payload};
use crate::stop::category::Category;
use crate::stop::extension::stretched;
use crate::stop::path::Path;

/// The parts of greatest speed, extension and load.
const PARTS: [f64; 3] = [0.33, 0.66, 1.0];

/// Number of joints in the table.
const JOINTS: usize = 3;

/// Duration of the path of a stop, s.
const PATH: f64 = 100.0;

/// Stopping times and distances of the three joints with the greatest displacement: category 0 at
/// full speed, extension and load, and category 1 at 33, 66 and 100 % of each.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct AnnexB {
    /// The rows.
    pub rows: Vec<AnnexRow>,
    /// Findings about missing rows of the table, with the reason.
    #[serde(skip)]
    pub notes: Vec<Finding>,
}

/// Stops in which one joint moves, the worse of both directions.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct AnnexRow {
    /// The stop category, 0 or 1.
    pub category: u8,
    /// The joint that moves; the others stand when the stop begins.
    pub joint: String,
    /// Part of the greatest speed.
    pub speed: f64,
    /// Part of the greatest distance of the load from the joint's axis.
    pub extension: f64,
    /// Part of the greatest load.
    pub load: f64,
    /// The speed when the stop begins, rad/s or m/s.
    pub velocity: f64,
    /// The posture when the stop begins, rad or m.
    pub posture: Vec<f64>,
    /// The greatest proved way of the joint, rad or m; infinite if none is proved.
    #[schemars(with = "Option<f64>")]
    pub way: f64,
    /// The latest proved time at which all joints stand, s; infinite if none is proved.
    #[schemars(with = "Option<f64>")]
    pub time: f64,
}

impl AnnexB {
    pub(crate) fn full_load(&self) -> f64 {
        self.rows.iter().map(|row| row.load).fold(0.0, f64::max)
    }
}

impl AnnexRow {
    /// Returns whether a standstill is proved.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        self.time.is_finite()
    }
}

/// The parts at which a joint is stopped.
#[derive(Clone, Copy)]
struct Case {
    joint: usize,
    speed: f64,
    extension: f64,
    load: f64,
}

/// Encloses the stops of the table. The controller knows the load; the error of its torque lies in
/// the set that `input_set` returns for decelerations. Postures come from a search, so that the
/// greatest extension is not proved to be the greatest.
///
/// # Guarantee
///
/// Outer, as [`stop_0`](crate::stop_0) and [`stop_1`](crate::stop_1), from the exact state of each
/// row.
///
/// # Errors
///
/// The robot with its load is not valid.
pub(crate) fn annex_b(
    robot: &Robot,
    brakes: &Brakes,
    input_set: &dyn Fn(&[f64]) -> Hyperrectangle,
) -> Result<AnnexB> {
    let mut notes = Vec::new();
    let unknown = robot.joints().iter().filter(|joint| joint.velocity_limit.is_none());
    if let Some(joint) = unknown.into_iter().next() {
        let name = &joint.name;
        notes.push(
            missing(format!(
                "There is no table, since the greatest speed of {name} is not known; give \
                 velocity_limit in the robot\u{2019}s description."
            ))
            .at(name),
        );
        return Ok(AnnexB { rows: Vec::new(), notes });
    }
    let loads: &[f64] = if brakes.payload.is_some() { &PARTS } else { &[0.0] };
    if brakes.payload.is_none() {
        notes.push(missing(
            "No load is given, so all rows are without load; `payload` in the file of the brakes \
             gives one.",
        ));
    }
    let table = Table { robot, brakes, loaded: loaded(robot, brakes.payload, loads)? };
    let full = |joint| Case { joint, speed: 1.0, extension: 1.0, load: loads[loads.len() - 1] };
    let all = (0..robot.joint_count()).into_par_iter();
    let mut rows: Vec<(usize, AnnexRow)> =
        all.map(|joint| (joint, table.row(full(joint), &Category::Zero))).collect();
    rows.sort_by(|a, b| b.1.way.total_cmp(&a.1.way));
    rows.truncate(JOINTS);
    let joints: Vec<usize> = rows.iter().map(|(joint, _)| *joint).collect();
    let mut rows: Vec<AnnexRow> = rows.into_iter().map(|(_, row)| row).collect();
    match Category::one(brakes, input_set) {
        None => notes.push(missing(
            "There is no category 1, since the file of the brakes has no `deceleration`.",
        )),
        Some(category) => {
            let cases: Vec<Case> = joints.iter().flat_map(|joint| cases(*joint, loads)).collect();
            rows.extend(
                cases.into_par_iter().map(|case| table.row(case, &category)).collect::<Vec<_>>(),
            );
        }
    }
    notes.extend(table.overloaded(&rows));
    Ok(AnnexB { rows, notes })
}

fn missing(text: impl Into<String>) -> Finding {
    Finding::new(Severity::Info, Code::TableIncomplete, text)
}

fn cases(joint: usize, loads: &[f64]) -> Vec<Case> {
    let mut found = Vec::new();
    for extension in PARTS {
        for load in loads {
            let case = |speed| Case { joint, speed, extension, load: *load };
            found.extend(PARTS.map(case));
        }
    }
    found
}

fn loaded(robot: &Robot, payload: Option<Payload>, parts: &[f64]) -> Result<Vec<(f64, Robot)>> {
    let with = |part: &f64| {
        let robot = match payload {
            Some(Payload { mass, centre }) => with_payload(robot, part * mass, centre)?,
            None => robot.clone(),
        };
        Ok((*part, robot))
    };
    parts.iter().map(with).collect()
}

/// Returns a robot whose last link carries a point of a mass (kg) at a place in its frame (m).
fn with_payload(robot: &Robot, mass: f64, centre: [f64; 3]) -> Result<Robot> {
    let n = robot.joint_count();
    let moment = centre.map(|x| mass * x);
    let [x, y, z] = centre;
    let own = &robot.inertial_parameters()[10 * (n - 1)..];
    let point = [
        mass,
        moment[0],
        moment[1],
        moment[2],
        mass * (y * y + z * z),
        -mass * x * y,
        mass * (x * x + z * z),
        -mass * x * z,
        -mass * y * z,
        mass * (x * x + y * y),
    ];
    let sum: [f64; 10] = std::array::from_fn(|k| own[k] + point[k]);
    let link = LinkInertia::from_parameters(&sum);
    let mut description = robot.description().clone();
    let last = &mut description.joints[n - 1];
    last.mass = link.mass;
    (last.com, last.first_moment) = (None, Some(link.first_moment.into()));
    let [.., xx, xy, yy, xz, yz, zz] = sum;
    last.inertia = [xx, xy, xz, yy, yz, zz];
    last.about = InertiaPoint::Origin;
    if let Some(known) = &mut last.gravity_moments {
        known.mass += mass;
        (0..3).for_each(|i| known.first_moment[i] += moment[i]);
    }
    Ok(Robot::from_description(&description)?)
}

struct Table<'a> {
    robot: &'a Robot,
    brakes: &'a Brakes,
    /// The robot with each part of its load.
    loaded: Vec<(f64, Robot)>,
}

impl Table<'_> {
    fn robot(&self, load: f64) -> &Robot {
        let known = self.loaded.iter().find(|(part, _)| *part == load);
        known.map_or(self.robot, |(_, robot)| robot)
    }

    /// Returns which brake does not hold an arm from which no standstill is proved.
    fn overloaded(&self, rows: &[AnnexRow]) -> Option<Finding> {
        let excess = |row: &AnnexRow| {
            let load = self.robot(row.load).gravity_torque(&row.posture);
            let joints = load.iter().zip(&self.brakes.torque).enumerate();
            let of_joint = |(joint, (load, [least, _])): (usize, (&f64, &[f64; 2]))| {
                (load.abs() - least, joint, load.abs(), *least)
            };
            joints.map(of_joint).max_by(|a, b| a.0.total_cmp(&b.0))
        };
        let open = rows.iter().filter(|row| !row.is_proved()).filter_map(excess);
        let (most, joint, load, least) = open.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let name = &self.robot.joints()[joint].name;
        let weak = |text: String| Finding::new(Severity::Warning, Code::BrakeWeak, text);
        Some(if most > 0.0 {
            let text = format!(
                "Some rows have no proved standstill: gravity turns {name} with up to {load:.1} \
                 N m, and its brake is only sure to hold {least} N m."
            );
            weak(text).at(name).with("load", load).with("least_torque", least)
        } else {
            weak(
                "Some rows have no proved standstill: the brakes have too little torque to spare \
                 for their load, or the drives\u{2019} torque is too uncertain."
                    .into(),
            )
        })
    }

    fn row(&self, case: Case, category: &Category) -> AnnexRow {
        let Case { joint, speed, extension, load } = case;
        let robot = self.robot(load);
        let centre = self.brakes.payload.map_or([0.0; 3], |payload| payload.centre);
        let (posture, _) = stretched(robot, joint, extension, centre);
        let velocity = speed * robot.joints()[joint].velocity_limit.unwrap_or(0.0);
        let worst = [velocity, -velocity].map(|v| {
            let mut qd = vec![0.0; posture.len()];
            qd[joint] = v;
            let state: Vec<Interval> =
                posture.iter().chain(&qd).map(|x| Interval::point(*x)).collect();
            let path = Path::straight(&posture, &qd, PATH);
            let stop = category.stop(robot, self.brakes, (&path, 0.0), &state);
            let stop = stop.filter(|stop| stop.stands);
            stop.map_or([f64::INFINITY; 2], |stop| {
                let [low, high] = stop.joints[joint].way;
                let times = stop.joints.iter().map(|joint| joint.time[1]);
                [high.max(-low), times.fold(0.0, f64::max)]
            })
        });
        AnnexRow {
            category: category.number(),
            joint: robot.joints()[joint].name.clone(),
            speed,
            extension,
            load,
            velocity,
            posture,
            way: worst[0][0].max(worst[1][0]),
            time: worst[0][1].max(worst[1][1]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_adds_its_weight_and_its_inertia() {
        let robot = Robot::lwa4p();
        let (mass, centre) = (2.0, [0.01, -0.02, 0.1]);
        let loaded = with_payload(&robot, mass, centre).unwrap();
        let q = [0.3, 0.8, -0.5, 0.2, 0.9, -0.4];
        let height = |q: &[f64]| {
            let frame = &robot.link_placements(q)[5];
            (frame.rotation * nalgebra::Vector3::from(centre) + frame.translation).z
        };
        for joint in 0..6 {
            // The torque is the slope of the potential energy.
            let moved = |by: f64| {
                let mut q = q;
                q[joint] += by;
                mass * 9.81 * height(&q)
            };
            let slope = (moved(1e-6) - moved(-1e-6)) / 2e-6;
            let more = loaded.gravity_torque(&q)[joint] - robot.gravity_torque(&q)[joint];
            assert!((more - slope).abs() < 1e-6, "{joint} {more} {slope}");
        }
        let inertia = (loaded.mass_matrix(&q) - robot.mass_matrix(&q))[(5, 5)];
        assert!((inertia - mass * (0.01f64.powi(2) + 0.02f64.powi(2))).abs() < 1e-12);
    }
}
