//! Viscous friction that falls with speed where it was not shown, and the nearest that rises.

use crate::bodies::{BodyProgram, RisingFriction};
use crate::regression::singular::UnitSingular;
use crate::regression::triangular_factor::TriangularFactor;
use nalgebra::{DMatrix, DVector};
use reachtube_robot::friction::Viscous;
use reachtube_robot::{Parameter, ParameterKind, Robot};
use schemars::JsonSchema;
use serde::Serialize;

/// Weight of the prior of friction that must rise, in squared standard deviations: rounding only.
const STRENGTH: f64 = 1e-6;

/// Viscous friction by least squares that falls with speed below a speed that the joint may reach.
/// Friction that rises up to there was used in its place.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct FallingFriction {
    /// Name of the joint.
    pub joint: String,
    /// Coefficients v1 to v3 of least squares.
    pub viscous: [f64; 3],
    /// Speed from which on they fall \[rad/s\].
    pub falls_beyond: f64,
    /// Speed up to which the friction that was used rises \[rad/s\].
    pub limit: f64,
    /// Root mean square of the residuals \[N m\] of least squares, and of the friction that was
    /// used.
    pub residuals: [f64; 2],
}

impl FallingFriction {
    /// Returns the speed from which on viscous friction falls, if it does below `limit` \[rad/s\].
    pub(crate) fn speed([v1, v2, v3]: [f64; 3], limit: f64) -> Option<f64> {
        Viscous { v1, v2, v3 }.falls_beyond(limit)
    }

    pub(crate) fn warning(&self, robot: &Robot) -> String {
        let Self { joint, falls_beyond, limit, residuals: [plain, used], .. } = self;
        let own = robot.joints().iter().find(|own| own.name == *joint);
        let kind = own.map(|own| own.kind).unwrap_or_default();
        let (speed, force) = (kind.velocity_unit(), kind.force_unit());
        format!(
            "viscous friction of {joint}: least squares falls with speed beyond \
             {falls_beyond:.2} {speed}, and would drive the joint at higher speeds; friction that \
             rises up to {limit:.2} {speed} is used, with a residual of {used:.3} {force} in place \
             of {plain:.3} {force}"
        )
    }
}

/// The columns of viscous friction in a regression, which must rise with speed.
pub(crate) struct ViscousColumns<'a> {
    /// The joints whose friction is fitted.
    pub joints: Vec<JointColumns>,
    /// The rows of the fit.
    pub data: &'a TriangularFactor,
}

/// The columns of the viscous friction of a joint.
pub(crate) struct JointColumns {
    /// The joint's place among the residuals, and its name.
    pub joint: (usize, String),
    /// The columns of v1, v2 and v3.
    pub columns: [Option<usize>; 3],
    /// What is added to their values.
    pub known: [f64; 3],
    /// Speed up to which the friction must rise \[rad/s\].
    pub limit: f64,
}

impl JointColumns {
    /// Returns the condition on the friction, which is `x` by least squares.
    fn condition(&self, x: &DVector<f64>, data: &TriangularFactor) -> RisingFriction {
        let condition = |own| rising(self.columns, self.known, own, self.limit, data);
        condition(condition(self.known).viscous(x.as_slice()))
    }
}

impl<'a> ViscousColumns<'a> {
    /// Takes the friction columns of a fit that corrects the friction of a known robot.
    pub(crate) fn of_robot(
        known: &Robot,
        columns: &[Parameter],
        limits: &[f64],
        data: &'a TriangularFactor,
    ) -> Self {
        let of_joint = |(joint, limit): (usize, &f64)| {
            let place = |kind| columns.iter().position(|own| *own == Parameter { joint, kind });
            let viscous = &known.joints()[joint].friction.viscous;
            JointColumns {
                joint: (joint, known.joints()[joint].name.clone()),
                columns: [
                    ParameterKind::Viscous1,
                    ParameterKind::Viscous2,
                    ParameterKind::Viscous3,
                ]
                .map(place),
                known: [viscous.v1, viscous.v2, viscous.v3],
                limit: *limit,
            }
        };
        let joints = limits.iter().enumerate().map(of_joint);
        Self { joints: joints.filter(|own| own.columns[0].is_some()).collect(), data }
    }

    /// Solves anew under conditions on the friction of joints whose friction falls in `x`, until
    /// none does. Returns the friction that was replaced; `sizes` are the root mean squares of the
    /// joints' residuals.
    pub(crate) fn rise<E>(
        &self,
        x: &mut DVector<f64>,
        solve: impl Fn(&[RisingFriction]) -> Result<DVector<f64>, E>,
        sizes: impl Fn(&DVector<f64>) -> Vec<f64>,
    ) -> Result<Vec<FallingFriction>, E> {
        let (plain, mut replaced): (_, Vec<(&JointColumns, f64)>) = (x.clone(), Vec::new());
        loop {
            let falls = |own: &&JointColumns| {
                let viscous = own.condition(x, self.data).viscous(x.as_slice());
                FallingFriction::speed(viscous, own.limit)
            };
            let is_new = |own: &&JointColumns| {
                replaced.iter().all(|(known, _)| known.joint.0 != own.joint.0)
            };
            let new = self.joints.iter().filter(is_new);
            let new: Vec<_> = new.filter_map(|own| Some((own, falls(&own)?))).collect();
            if new.is_empty() {
                break;
            }
            replaced.extend(new);
            let conditions = replaced.iter().map(|(own, _)| own.condition(&plain, self.data));
            *x = solve(&conditions.collect::<Vec<_>>())?;
        }
        let [before, after] = [&plain, x].map(sizes);
        let described = replaced.into_iter().map(|(own, falls_beyond)| FallingFriction {
            joint: own.joint.1.clone(),
            viscous: own.condition(&plain, self.data).viscous(plain.as_slice()),
            falls_beyond,
            limit: own.limit,
            residuals: [before[own.joint.0], after[own.joint.0]],
        });
        Ok(described.collect())
    }
}

/// Returns the condition on viscous friction with coefficients `viscous` by least squares of the
/// rows `data`.
///
/// Slow motions hardly show v3, and least squares may then give it any value. Friction that alone
/// would make up all of the torque is as large as friction counts.
fn rising(
    columns: [Option<usize>; 3],
    known: [f64; 3],
    viscous: [f64; 3],
    limit: f64,
    data: &TriangularFactor,
) -> RisingFriction {
    let [v1, v2, v3] = viscous.map(f64::abs);
    let size = v1.max(v2 * limit).max(3.0 * v3 * limit * limit);
    let most = columns[0].map_or(f64::INFINITY, |v1| data.z.norm() / data.r.column(v1).norm());
    let size = size.min(most).max(f64::MIN_POSITIVE);
    RisingFriction { columns, known, limit, size }
}

/// Returns the solution of least squares under conditions on friction. Rows of `factor` have errors
/// of standard deviation `deviation`.
pub(crate) fn nearest(
    factor: &TriangularFactor,
    deviation: f64,
    conditions: &[RisingFriction],
) -> DVector<f64> {
    let p = factor.r.ncols();
    let friction: Vec<usize> = conditions.iter().flat_map(|of| of.columns).flatten().collect();
    let others: Vec<usize> = (0..p).filter(|column| !friction.contains(column)).collect();
    // The columns of the friction come last, so that the last rows are about it alone; the others
    // are taken in the directions that the rows determine.
    let directions = determined(&factor.r, &others);
    let free = directions.ncols();
    let mut map = DMatrix::zeros(p, free + friction.len());
    others.iter().enumerate().for_each(|(row, column)| {
        map.view_mut((*column, 0), (1, free)).copy_from(&directions.row(row));
    });
    friction.iter().enumerate().for_each(|(k, column)| map[(*column, free + k)] = 1.0);
    let mapped = factor.with_mapped_columns(&map);
    let k = friction.len();
    let scale = 1.0 / deviation;
    let data = TriangularFactor {
        r: scale * mapped.r.view((free, free), (k, k)),
        z: scale * mapped.z.rows(free, k),
        residual: scale * mapped.residual,
    };
    let place = |column: usize| friction.iter().position(|own| *own == column);
    let own = |of: &RisingFriction| RisingFriction {
        columns: of.columns.map(|column| column.and_then(place)),
        ..*of
    };
    let rising: Vec<RisingFriction> = conditions.iter().map(own).collect();
    let program =
        BodyProgram { data: &data, prior: &[], strength: STRENGTH, positive: &[], rising: &rising };
    let found = program.solve().map_or_else(|| program.start(), |solution| solution.x);
    let found = found.rows(0, k).into_owned();
    // The others by least squares with this friction.
    let left = mapped.z.rows(0, free) - mapped.r.view((0, free), (free, k)) * &found;
    let own = mapped.r.view((0, 0), (free, free)).solve_upper_triangular(&left);
    let own = own.unwrap_or_else(|| DVector::zeros(free));
    let mut y = DVector::zeros(free + k);
    y.rows_mut(0, free).copy_from(&own);
    y.rows_mut(free, k).copy_from(&found);
    map * y
}

/// Returns the directions of the parameters `columns` that rows with the factor `r` determine.
fn determined(r: &DMatrix<f64>, columns: &[usize]) -> DMatrix<f64> {
    if columns.is_empty() {
        return DMatrix::zeros(0, 0);
    }
    let UnitSingular { unit, singular, cut } = UnitSingular::of(&r.select_columns(columns));
    let kept: Vec<usize> = (0..columns.len()).filter(|k| singular.values[*k] > cut).collect();
    DMatrix::from_diagonal(&unit) * singular.v.select_columns(&kept)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a joint with Coulomb friction 2 N m, inertia 1.5 kg m² and this viscous friction,
    /// moved up to `speed` \[rad/s\], with torques that are off by up to `noise` \[N m\]: columns
    /// sign, q̇, q̇², q̇³, q̈.
    fn rows(viscous: [f64; 3], speed: f64, noise: f64) -> TriangularFactor {
        let row = |k: usize| {
            let t = 0.01 * k as f64;
            let (qd, qdd) = (speed * t.sin(), speed * t.cos() + (3.0 * t).sin());
            let columns = [qd.signum(), qd, qd * qd, qd.powi(3), qdd];
            let x = [2.0, viscous[0], viscous[1], viscous[2], 1.5];
            let torque: f64 = columns.iter().zip(x).map(|(a, x)| a * x).sum();
            [&columns[..], &[torque + noise * (2.3 * k as f64).sin()]].concat()
        };
        let rows: Vec<f64> = (1..2000).flat_map(row).collect();
        TriangularFactor::from_rows(&rows, 5)
    }

    fn condition(limit: f64, viscous: [f64; 3], data: &TriangularFactor) -> RisingFriction {
        rising([Some(1), Some(2), Some(3)], [0.0; 3], viscous, limit, data)
    }

    /// The cubic part of slow motions is rounding beside their noise.
    #[test]
    fn motions_that_are_too_slow_for_the_cubic_part_still_give_friction_that_rises() {
        for speed in [1e-2, 1e-4, 1e-6] {
            let factor = rows([3.0, 0.0, 0.0], speed, 0.1);
            let plain = factor.solve().x;
            let own = condition(3.2, [plain[1], plain[2], plain[3]], &factor);
            // It counts at most as friction that alone makes up the torque.
            let most = factor.z.norm() / factor.r.column(1).norm();
            assert!(own.size <= 1.001 * most, "{speed}: {} {most}", own.size);
            let found = nearest(&factor, 0.1, &[own]);
            let falls = FallingFriction::speed([found[1], found[2], found[3]], 3.2);
            assert_eq!(falls, None, "{speed}: {found}");
            // Nothing but Coulomb friction and inertia rises, too.
            let linear = factor.sum_of_squares(&DVector::from_vec(vec![2.0, 3.0, 0.0, 0.0, 1.5]));
            let cost = factor.sum_of_squares(&found);
            assert!(cost < linear + 0.01, "{speed}: {cost} {linear} {found}");
        }
    }

    #[test]
    fn friction_that_rises_is_found_as_least_squares_finds_it() {
        for viscous in [[3.0, 0.1, -0.15], [3.0, 0.0, 1.0], [0.5, -0.1, 0.3]] {
            let factor = rows(viscous, 1.0, 0.0);
            let found = nearest(&factor, 1.0, &[condition(2.0, [3.0, 0.5, 1.0], &factor)]);
            let expected = [2.0, viscous[0], viscous[1], viscous[2], 1.5];
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-3, "{viscous:?}: {found} {expected}");
            }
        }
    }

    #[test]
    fn friction_that_falls_is_replaced_by_the_nearest_that_rises() {
        for viscous in [[3.0, 0.0, -1.0], [3.0, 1.5, 0.0], [2.0, -0.8, -0.4], [-1.0, 0.0, 2.0]] {
            let factor = rows(viscous, 1.0, 0.0);
            let found = nearest(&factor, 1.0, &[condition(2.0, [3.0, 0.5, 1.0], &factor)]);
            let [v1, v2, v3] = [found[1], found[2], found[3]];
            assert_eq!(FallingFriction::speed([v1, v2, v3], 2.0), None, "{viscous:?}");
            // Nothing that rises is nearer: neither a smaller slope of any kind nor a mixture.
            let cost = factor.sum_of_squares(&found);
            let tried = (0..4000).map(|k| {
                let step = |base: u64| ((k * base % 4001) as f64 / 2000.5 - 1.0) * 0.4;
                let mut x = found.clone();
                (x[1], x[2], x[3]) = (v1 + step(977), v2 + step(1601), v3 + step(2503));
                x
            });
            let rises =
                |x: &DVector<f64>| FallingFriction::speed([x[1], x[2], x[3]], 2.0).is_none();
            let best = tried.filter(rises).map(|x| factor.sum_of_squares(&x));
            assert!(best.fold(f64::INFINITY, f64::min) > cost - 1e-3, "{viscous:?}");
        }
    }
}
