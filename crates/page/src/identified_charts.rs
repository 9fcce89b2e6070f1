//! The charts of an identified robot: torque over time, and friction over load and velocity.

use super::chart::{Chart, Series};
use reachtube_identify::{FrictionFit, TorqueTrace};
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

/// Height of the chart of a residual \[px\].
pub(super) const RESIDUAL_HEIGHT: f64 = 130.0;

/// Returns the torque of a joint over time, recorded throughout, and below it the residual. The
/// prediction and the residual are drawn only where the joint moves, because friction at standstill
/// has no unique value.
pub(super) fn torque_charts(
    trace: &TorqueTrace,
    joint: usize,
    name: &str,
    kind: JointKind,
) -> [Chart; 2] {
    let (recorded, predicted) = (&trace.recorded[joint], &trace.predicted[joint]);
    let unit = kind.force_unit();
    let whole = Series {
        points: trace.times.iter().copied().zip(recorded.iter().copied()).collect(),
        dots: false,
        colour: RECORDED,
    };
    let moving = |value: &dyn Fn(usize) -> f64, colour| -> Vec<Series> {
        let moves = &trace.moves[joint];
        let samples: Vec<usize> = (0..moves.len()).collect();
        let parts = samples.chunk_by(|a, b| moves[*a] == moves[*b]).filter(|k| moves[k[0]]);
        let points = |part: &[usize]| part.iter().map(|k| (trace.times[*k], value(*k))).collect();
        parts.map(|part| Series { points: points(part), dots: false, colour }).collect()
    };
    let mut torque = vec![whole];
    torque.extend(moving(&|k| predicted[k], PREDICTED));
    let torque = Chart {
        title: name.into(),
        x: "time [s]".into(),
        y: format!("torque [{unit}]"),
        area: Vec::new(),
        series: torque,
    };
    // The line at 0 gives both charts the same times.
    let zero = [trace.times.first(), trace.times.last()].into_iter().flatten().map(|t| (*t, 0.0));
    let mut residuals = vec![Series { points: zero.collect(), dots: false, colour: RECORDED }];
    residuals.extend(moving(&|k| recorded[k] - predicted[k], RESIDUAL));
    let residual = Chart {
        title: String::new(),
        x: "time [s]".into(),
        y: format!("residual [{unit}]"),
        area: Vec::new(),
        series: residuals,
    };
    [torque, residual]
}

/// Returns Coulomb friction over the load, as in the upper plot of Fig. 5: recorded torque minus
/// viscous friction and inertia, and the fit.
pub fn load_chart(fit: &FrictionFit, kind: JointKind) -> Chart {
    let coulomb = Coulomb::from_coefficients(fit.joint.coefficients.coulomb);
    let fitted = |k: usize| {
        let sample = &fit.samples[k];
        (sample.load, coulomb.torque(sample.load, sample.qd))
    };
    friction_chart(fit, "Coulomb", format!("load torque [{}]", kind.force_unit()), kind, fitted)
}

/// Returns viscous friction over the velocity, as in the lower plot of Fig. 5: recorded torque
/// minus Coulomb friction and inertia, and the fit.
pub fn viscous_chart(fit: &FrictionFit, kind: JointKind) -> Chart {
    let [v1, v2, v3] = fit.joint.coefficients.viscous;
    let viscous = Viscous { v1, v2, v3 };
    let fitted = |k: usize| {
        let sample = &fit.samples[k];
        (sample.qd, viscous.torque(&sample.qd))
    };
    friction_chart(fit, "viscous", format!("velocity [{}]", kind.velocity_unit()), kind, fitted)
}

/// Plots one part of friction: the fit plus the residual at each sample, and over it the fit.
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
        area: Vec::new(),
        series: vec![
            Series { points: points(1.0), dots: true, colour: MEASURED },
            Series { points: points(0.0), dots: true, colour: FITTED },
        ],
    }
}
