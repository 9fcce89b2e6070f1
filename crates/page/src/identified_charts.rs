//! The charts of an identified robot: torque over time, and friction over load and velocity.

use super::chart::{Chart, Series};
use super::svg::{BLUE, GREY, RED};
use reachtube_identify::{FrictionFit, TorqueTrace};
use reachtube_robot::JointKind;
use reachtube_robot::friction::{Coulomb, Viscous};

/// Light orange, over blue dots.
const FITTED: [u8; 3] = [255, 170, 60];

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
    let whole = trace.times.iter().copied().zip(recorded.iter().copied()).collect();
    let moving = |value: &dyn Fn(usize) -> f64, colour| -> Vec<Series> {
        let moves = &trace.moves[joint];
        let samples: Vec<usize> = (0..moves.len()).collect();
        let parts = samples.chunk_by(|a, b| moves[*a] == moves[*b]).filter(|k| moves[k[0]]);
        let points = |part: &[usize]| part.iter().map(|k| (trace.times[*k], value(*k))).collect();
        parts.map(|part| Series::line(points(part), colour)).collect()
    };
    let mut torque = vec![Series::line(whole, GREY)];
    torque.extend(moving(&|k| predicted[k], BLUE));
    // The line at 0 gives both charts the same times.
    let zero = [trace.times.first(), trace.times.last()].into_iter().flatten().map(|t| (*t, 0.0));
    let mut residuals = vec![Series::line(zero.collect(), GREY)];
    residuals.extend(moving(&|k| recorded[k] - predicted[k], RED));
    [
        Chart::new(name, "time [s]", format!("torque [{unit}]"), torque),
        Chart::new("", "time [s]", format!("residual [{unit}]"), residuals),
    ]
}

/// Returns the plots of Fig. 5: Coulomb friction over the load, and viscous friction over the
/// velocity, each as recorded torque minus the other part and inertia, and the fit.
pub fn friction_charts(fit: &FrictionFit, kind: JointKind) -> [Chart; 2] {
    let coulomb = Coulomb::from_coefficients(fit.joint.coefficients.coulomb);
    let [v1, v2, v3] = fit.joint.coefficients.viscous;
    let viscous = Viscous { v1, v2, v3 };
    let over_load = |k: usize| {
        let sample = &fit.samples[k];
        (sample.load, coulomb.torque(sample.load, sample.qd))
    };
    let over_velocity = |k: usize| (fit.samples[k].qd, viscous.torque(&fit.samples[k].qd));
    let load = format!("load torque [{}]", kind.force_unit());
    let velocity = format!("velocity [{}]", kind.velocity_unit());
    [
        friction_chart(fit, "Coulomb", load, kind, over_load),
        friction_chart(fit, "viscous", velocity, kind, over_velocity),
    ]
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
    let series = vec![Series::dots(points(1.0), BLUE), Series::dots(points(0.0), FITTED)];
    let y = format!("friction [{}]", kind.force_unit());
    Chart::new(format!("{}, {part}", fit.joint.joint), x, y, series)
}
