use crate::prepare::log::PreparedLog;
use crate::samples::Sampling;
use reachtube_robot::Robot;
use reachtube_robot::friction::WarmingBy;

/// Stretches into which each recording is cut where there are few recordings.
const STRETCHES: usize = 6;

/// Number of recordings from which each is held out as a whole.
const ENOUGH_LOGS: usize = 4;

/// The friction of a joint at one sample.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrictionRow {
    /// Temperature \[°C\] or number of the recording.
    pub value: f64,
    /// Coulomb and viscous friction at the reference \[N m\].
    pub friction: [f64; 2],
    /// Recorded torque without the torque of the rigid links \[N m\].
    pub torque: f64,
}

/// The rows of every joint, in the parts that are held out in turn.
pub(crate) struct FrictionRows {
    /// Rows by joint and part.
    pub joints: Vec<Vec<Vec<FrictionRow>>>,
    /// Whether a part is a recording; otherwise it is a stretch of one.
    pub by_recording: bool,
}

impl FrictionRows {
    /// Takes the rows of motions for a law that depends on `by`. The result is the name of a
    /// recording that does not know it, where there is one.
    pub(crate) fn new(
        found: &Robot,
        logs: &[&PreparedLog],
        sampling: &Sampling,
        by: WarmingBy,
    ) -> Result<Self, String> {
        if let Some(log) = logs.iter().find(|log| log.warmth_value(by, 0, 0).is_none()) {
            return Err(log.name.clone());
        }
        let by_recording = logs.len() >= ENOUGH_LOGS;
        let stretches = if by_recording { 1 } else { STRETCHES };
        let mut joints = vec![Vec::new(); found.joint_count()];
        for log in logs {
            for (parts, rows) in joints.iter_mut().zip(rows_of(found, log, sampling, by)) {
                let length = rows.len().div_ceil(stretches).max(1);
                parts.extend(rows.chunks(length).map(<[FrictionRow]>::to_vec));
            }
        }
        Ok(Self { joints, by_recording })
    }
}

/// Returns the rows of each joint while it moves.
fn rows_of(
    found: &Robot,
    log: &PreparedLog,
    sampling: &Sampling,
    by: WarmingBy,
) -> Vec<Vec<FrictionRow>> {
    let mut rows = vec![Vec::new(); log.joints];
    let moves = log.moving_mask(&sampling.slow, sampling.margin);
    for k in (0..log.len()).step_by(sampling.stride(log)) {
        let rigid = found.inverse_dynamics(log.q(k), log.qd(k), log.qdd(k));
        let coulomb = found.coulomb_torque(log.q(k), log.qd(k));
        let viscous = found.viscous_torque(log.qd(k));
        for (j, rows) in rows.iter_mut().enumerate().filter(|(j, _)| moves[k * log.joints + j]) {
            if let Some(value) = log.warmth_value(by, j, k) {
                let friction = [coulomb[j], viscous[j]];
                rows.push(FrictionRow { value, friction, torque: log.tau(k)[j] - rigid[j] });
            }
        }
    }
    rows
}
