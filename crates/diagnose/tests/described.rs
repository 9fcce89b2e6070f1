//! What recorded torques contradict in a description, for an arm whose motions and torques are
//! computed.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use reachtube_diagnose::{Contradiction, Described, NeededTorques, Signals, payload, torque_lag};
use reachtube_recordings::Torque;
use reachtube_robot::Robot;

const N: usize = 6;
const STEP: f64 = 0.02;
const SAMPLES: usize = 1000;
const G: f64 = 9.81;

/// Numbers from -1 to 1 that repeat after a long time.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
        (self.0 >> 33) as f64 / f64::from(1u32 << 30) - 1.0
    }
}

/// Positions, velocities, accelerations and torques of a motion, in rows of n.
struct Recording([Vec<f64>; 4]);

impl Recording {
    /// Records the torques of a robot with motors and friction.
    fn new(robot: &Robot, seed: u64) -> Self {
        let mut random = Random(seed);
        let waves: Vec<[f64; 3]> = (0..4 * N)
            .map(|_| [0.6 * random.next(), 0.5 + 0.4 * random.next(), random.next()])
            .collect();
        let mut rows = [(); 4].map(|()| Vec::new());
        for k in 0..SAMPLES {
            let mut motion = [[0.0; N]; 3];
            for (at, [size, rate, phase]) in waves.iter().enumerate() {
                let (w, joint) = (TAU * rate / 4.0, at % N);
                let angle = w * STEP * k as f64 + 3.0 * phase;
                motion[0][joint] += size * angle.sin();
                motion[1][joint] += size * w * angle.cos();
                motion[2][joint] -= size * w * w * angle.sin();
            }
            let [q, qd, qdd] = &motion;
            let links = robot.inverse_dynamics(q, qd, qdd);
            let torque = |j: usize| {
                links[j] + 0.4 * qdd[j] + 3.0 * qd[j] + 2.0 * qd[j].signum() + 0.2 * random.next()
            };
            rows[3].extend((0..N).map(torque));
            rows.iter_mut().zip(motion).for_each(|(rows, own)| rows.extend(own));
        }
        Self(rows)
    }

    fn signals(&self) -> Signals<'_> {
        let [q, qd, qdd, torques] = &self.0;
        let moves = qd.iter().map(|qd| qd.abs() > 0.02).collect();
        Signals { step: STEP, motion: [q, qd, qdd], torques, moves }
    }

    /// Returns the torques beside the ones that the described arm needs with the same friction.
    fn needed(&self) -> NeededTorques<'_> {
        let (robot, [q, qd, qdd, torques]) = (Robot::lwa4p(), &self.0);
        let rows = q.chunks(N).zip(qd.chunks(N)).zip(qdd.chunks(N));
        let needed = rows.flat_map(|((q, qd), qdd)| {
            let links = robot.inverse_dynamics(q, qd, qdd);
            let torque = |j: usize| links[j] + 0.4 * qdd[j] + 3.0 * qd[j] + 2.0 * qd[j].signum();
            (0..N).map(torque).collect::<Vec<f64>>()
        });
        let needed = needed.collect();
        NeededTorques { step: STEP, motion: [q, qd, qdd], recorded: torques, needed }
    }
}

#[test]
fn a_payload_is_found_with_its_mass() {
    for added in [2.0, 0.5, -0.3] {
        let mut description = Robot::lwa4p().description().clone();
        let last = &mut description.joints[N - 1];
        last.mass += added;
        last.gravity_moments.iter_mut().for_each(|moments| moments.mass += added);
        let loaded = Robot::from_description(&description).unwrap();
        for seed in [1, 2] {
            let recording = Recording::new(&loaded, seed);
            let found = payload(&Robot::lwa4p(), &recording.needed());
            let found = found.unwrap_or_else(|| panic!("{added} {seed}"));
            assert!((found.mass - added).abs() < 0.1 + 0.05 * added.abs(), "{added}: {found:?}");
            assert!(found.explained > 0.7, "{found:?}");
        }
    }
    let unloaded = Recording::new(&Robot::lwa4p(), 1);
    assert_eq!(payload(&Robot::lwa4p(), &unloaded.needed()), None);
    // Friction that is higher is no payload.
    let mut rubbing = Recording::new(&Robot::lwa4p(), 1);
    let [_, qd, _, torques] = &mut rubbing.0;
    torques.iter_mut().zip(qd).for_each(|(torque, qd)| *torque += 3.0 * *qd);
    assert_eq!(payload(&Robot::lwa4p(), &rubbing.needed()), None);
}

#[test]
fn torques_that_come_late_are_found_and_a_payload_is_no_lag() {
    let late = |recording: &mut Recording, samples: usize| {
        let torques = &mut recording.0[3];
        let first = torques[..N].repeat(samples);
        torques.truncate(torques.len() - first.len());
        torques.splice(0..0, first);
    };
    for samples in [0, 2, 5] {
        let mut recordings: Vec<Recording> =
            (1..=4).map(|seed| Recording::new(&Robot::lwa4p(), seed)).collect();
        recordings.iter_mut().for_each(|recording| late(recording, samples));
        let needed: Vec<NeededTorques> = recordings.iter().map(Recording::needed).collect();
        let found = torque_lag(&needed, N);
        let expected = STEP * samples as f64;
        match samples {
            0 => assert_eq!(found, None),
            _ => assert!(found.is_some_and(|lag| (lag - expected).abs() < 2e-3), "{found:?}"),
        }
    }
}

/// Returns what contradicts the description of the arm in recordings of `robot`, as `change` made
/// them, which takes a row of positions and one of torques.
fn found(robot: &Robot, mut change: impl FnMut(&mut [f64], &mut [f64])) -> Vec<Contradiction> {
    let described = Robot::lwa4p();
    let mut recordings: Vec<Recording> = (1..=4).map(|seed| Recording::new(robot, seed)).collect();
    for Recording([q, _, _, torques]) in &mut recordings {
        q.chunks_mut(N).zip(torques.chunks_mut(N)).for_each(|(q, tau)| change(q, tau));
    }
    let signals = recordings.iter().map(Recording::signals).collect();
    Described::new(&described, Torque::Motor, signals).contradictions().0
}

/// Asserts that one contradiction is found, with these words.
fn assert_named(found: &[Contradiction], words: &str) {
    assert!(found.len() == 1 && found[0].is_certain, "{found:?}");
    assert!(found[0].text.contains(words), "{words}: {}", found[0].text);
}

/// Returns the arm with masses that differ from the description's.
fn with_masses(factor: impl Fn(usize) -> f64) -> Robot {
    let mut description = Robot::lwa4p().description().clone();
    for (link, joint) in description.joints.iter_mut().enumerate() {
        joint.mass *= factor(link);
        joint.first_moment.iter_mut().flatten().for_each(|moment| *moment *= factor(link));
    }
    Robot::from_description(&description).unwrap()
}

#[test]
fn healthy_recordings_contradict_nothing() {
    let none = |_: &mut [f64], _: &mut [f64]| ();
    assert_eq!(found(&Robot::lwa4p(), none), []);
    // Descriptions are rough, and do not know payloads.
    assert_eq!(found(&with_masses(|link| [0.6, 1.7, 0.5, 1.5, 2.0, 0.7][link]), none), []);
    assert_eq!(found(&with_masses(|link| if link == 5 { 4.0 } else { 1.0 }), none), []);
}

#[test]
fn torques_without_gravity_are_named() {
    let robot = Robot::lwa4p();
    let without = |part: f64, robot: &Robot| {
        found(robot, |q, tau| {
            let gravity = robot.gravity_torque(q);
            tau.iter_mut().zip(&gravity).for_each(|(tau, gravity)| *tau -= part * gravity);
        })
    };
    assert_named(&without(1.0, &robot), "contain no gravity");
    // A controller's own masses are not exact, nor are the description's.
    assert_named(&without(0.9, &robot), "contain no gravity");
    assert_named(
        &without(1.0, &with_masses(|link| [0.6, 1.7, 0.5, 1.5, 1.2, 0.7][link])),
        "no grav",
    );
    assert_eq!(without(0.4, &robot), []);
}

#[test]
fn torques_in_other_units_are_named_with_their_factors() {
    let scaled = |factors: [f64; N]| {
        found(&Robot::lwa4p(), |_, tau| tau.iter_mut().zip(factors).for_each(|(tau, f)| *tau *= f))
    };
    let parts = [1000.0 / 50.0, 1000.0 / 50.0, 1000.0 / 20.0, 1000.0 / 20.0, 1e3 / 8.0, 1e3 / 8.0];
    assert_named(&scaled(parts), "per mille of rated torques");
    assert_named(&scaled([1e3; N]), "probably in N mm");
    assert_named(&scaled([0.1; N]), "currents in A of");
    let remedy = scaled([1e3; N])[0].remedy.clone().unwrap();
    assert_eq!(remedy[0], "gains");
    assert_named(&scaled([1.0, -1.0, 1.0, 1.0, 1.0, 1.0]), "is opposite");
    assert_named(&scaled([-1.0; N]), "all recorded torques have the opposite sign");
}

#[test]
fn another_mount_is_named_with_its_gravity() {
    let mounted = |gravity| found(&Robot::lwa4p().with_gravity(gravity), |_, _| ());
    assert_named(&mounted([G, 0.0, 0.0]), "on a wall or tilted; state `gravity = [9.8");
    assert_named(&mounted([0.0, 0.0, G]), "hangs from a ceiling");
    let part = G * FRAC_1_SQRT_2;
    assert_named(&mounted([0.0, part, -part]), "at 45° to the description's");
}

#[test]
fn a_zero_that_is_off_is_named_with_its_joint() {
    for (joint, offset) in [(1, 0.15), (2, -0.2), (1, 0.4)] {
        let found = found(&Robot::lwa4p(), |q, _| q[joint] += offset);
        assert_named(&found, &format!("the position of joint{} probably has", joint + 1));
        let (name, size) = found[0].number.unwrap();
        assert!(name == "offset" && (size - offset).abs() < 0.01, "{size}, not {offset}");
    }
}

#[test]
fn another_unit_of_the_description_is_named() {
    let robot = Robot::lwa4p();
    let recordings: Vec<Recording> = (1..=4).map(|seed| Recording::new(&robot, seed)).collect();
    let cases = [
        ([1e3, 1.0, 1.0], "the distances between joints of the description are probably in mm"),
        ([1e2, 1e2, 1.0], "centres of mass of the description are probably in cm"),
        ([1.0, 1.0, 1e6], "the moments of inertia of the description are probably in kg mm²"),
    ];
    for ([distance, centre, inertia], words) in cases {
        let mut description = robot.description().clone();
        for joint in &mut description.joints {
            let dh = joint.dh.as_mut().unwrap();
            [&mut dh.a, &mut dh.d].into_iter().for_each(|length| *length *= distance);
            joint.com.iter_mut().flatten().for_each(|length| *length *= centre);
            let moments = joint.gravity_moments.iter_mut();
            moments.flat_map(|own| &mut own.first_moment).for_each(|moment| *moment *= centre);
            joint.inertia.iter_mut().for_each(|moment| *moment *= inertia);
        }
        let other = Robot::from_description(&description).unwrap();
        let signals = recordings.iter().map(Recording::signals).collect();
        let (found, count) = Described::new(&other, Torque::Motor, signals).contradictions();
        assert_named(&found, words);
        assert!(2 * count >= N, "{count}: {found:?}");
    }
}

#[test]
fn joints_that_move_alike_are_not_called_exchanged() {
    let robot = Robot::lwa4p();
    let mut recordings: Vec<Recording> = (1..=4).map(|seed| Recording::new(&robot, seed)).collect();
    for recording in &mut recordings {
        let [q, qd, qdd, torques] = &mut recording.0;
        for rows in [&mut *q, qd, qdd] {
            rows.chunks_mut(N).for_each(|row| row[2] = row[1]);
        }
        for k in 0..SAMPLES {
            let at = k * N..(k + 1) * N;
            let links = robot.inverse_dynamics(&q[at.clone()], &qd[at.clone()], &qdd[at.clone()]);
            torques[at].copy_from_slice(links.as_slice());
        }
    }
    let signals = recordings.iter().map(Recording::signals).collect();
    let (found, _) = Described::new(&robot, Torque::Motor, signals).contradictions();
    assert!(found.len() == 1 && !found[0].is_certain, "{found:?}");
    assert!(found[0].text.starts_with("joint2, joint3 move alike"), "{found:?}");
}

#[test]
fn torques_that_nothing_explains_are_named() {
    let mut random = Random(9);
    let noise = found(&Robot::lwa4p(), |_, tau| tau.fill_with(|| random.next()));
    assert_named(&noise, "neither the robot's links of any mass nor friction");
    let mut late = vec![0.0; N];
    let shuffled = found(&Robot::lwa4p(), |_, tau| {
        tau.iter_mut().zip(&mut late).for_each(|(tau, late)| {
            *late = 0.9 * *late + random.next();
            *tau = *late;
        });
    });
    assert_named(&shuffled, "neither the robot's links");
}
