//! The charts of an identified robot: torque over time, and friction over load and velocity.

use super::chart::{Chart, Series};
use reachtube_identify::TorqueTrace;
use reachtube_identify::friction::FrictionFit;
use reachtube_robot::JointKind;
use reachtube_robot::friction::{Coulomb, Viscous};

/// Grey.
const RECORDED: [u8; 3] = [120, 128, 138];
/// Blue.
const PREDICTED: [u8; 3] = [18, 70, 200];
/// Blue.
const MEASURED: [u8; 3] = PREDICTED;
/// Orange.
const FITTED: [u8; 3] = [255, 170, 60];
/// Red.
const RESIDUAL: [u8; 3] = [222, 30, 30];

/// Returns the torque of a joint over time: recorded throughout, predicted and residual only where
/// the joint moves, because friction at standstill has no unique value.
pub(super) fn torque_chart(
    trace: &TorqueTrace,
    joint: usize,
    name: &str,
    kind: JointKind,
) -> Chart {
    let (recorded, predicted, moves) =
        (&trace.recorded[joint], &trace.predicted[joint], &trace.moves[joint]);
    let mut series = vec![Series {
        points: trace.times.iter().copied().zip(recorded.iter().copied()).collect(),
        dots: false,
        colour: RECORDED,
    }];
    let samples: Vec<usize> = (0..moves.len()).collect();
    let moving = samples.chunk_by(|a, b| moves[*a] == moves[*b]).filter(|part| moves[part[0]]);
    for part in moving {
        let line = |value: &dyn Fn(usize) -> f64, colour| Series {
            points: part.iter().map(|k| (trace.times[*k], value(*k))).collect(),
            dots: false,
            colour,
        };
        series.push(line(&|k| predicted[k], PREDICTED));
        series.push(line(&|k| recorded[k] - predicted[k], RESIDUAL));
    }
    let y = format!("torque [{}]", kind.force_unit());
    Chart { title: name.into(), x: "time [s]".into(), y, series }
}

/// Returns Coulomb friction over the load, as in the upper plot of Fig. 5: recorded torque minus
/// viscous friction and inertia, and the fit.
pub(super) fn load_chart(fit: &FrictionFit, kind: JointKind) -> Chart {
    let coulomb = Coulomb::from_coefficients(fit.joint.coefficients.coulomb);
    let fitted = |k: usize| {
        let sample = &fit.samples[k];
        (sample.load, coulomb.torque(sample.load, sample.qd))
    };
    friction_chart(fit, "Coulomb", format!("load torque [{}]", kind.force_unit()), kind, fitted)
}

/// Returns viscous friction over the velocity, as in the lower plot of Fig. 5: recorded torque
/// minus Coulomb friction and inertia, and the fit.
pub(super) fn viscous_chart(fit: &FrictionFit, kind: JointKind) -> Chart {
    let [v1, v2, v3] = fit.joint.coefficients.viscous;
    let viscous = Viscous { v1, v2, v3 };
    let fitted = |k: usize| {
        let sample = &fit.samples[k];
        (sample.qd, viscous.torque(&sample.qd))
    };
    friction_chart(fit, "viscous", format!("velocity [{}]", kind.velocity_unit()), kind, fitted)
}

/// Plots one part of friction: the fit at each sample, and over it the fit plus the residual.
fn friction_chart(
    fit: &FrictionFit,
    part: &str,
    x: String,
    kind: JointKind,
    fitted: impl Fn(usize) -> (f64, f64),
) -> Chart {
    let points = |residual: f64| {
        let point = |k: usize| (fitted(k).0, fitted(k).1 + residual * fit.residuals[k]);
        (0..fit.samples.len()).map(point).collect()
    };
    Chart {
        title: format!("{}, {part}", fit.joint.joint),
        x,
        y: format!("friction [{}]", kind.force_unit()),
        series: vec![
            Series { points: points(0.0), dots: true, colour: FITTED },
            Series { points: points(1.0), dots: true, colour: MEASURED },
        ],
    }
}
