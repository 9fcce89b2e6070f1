//! Friction (5) to (9) of each joint, with the gravity torque as its load.

use super::regression::{
    Triangle, huber_weight, robust_deviation, root_mean_square, samples_per_independent_one,
};
use nalgebra::DVector;
use reachtube_robot::FrictionDescription;
use serde::{Deserialize, Serialize};

/// Rounds of reweighting.
const ROUNDS: usize = 4;

/// A quadrant is seen with at least this part of a joint's samples, and this many of them
/// independent.
const SEEN: (f64, f64) = (0.02, 8.0);

/// A slope in the load is told from the offset where the load varies by more than this part of the
/// median friction.
const LOAD_RANGE: f64 = 0.3;

/// One sample of a moving joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionSample {
    /// Velocity \[rad/s\], not 0.
    pub qd: f64,
    /// Acceleration \[rad/s²\].
    pub qdd: f64,
    /// Gravity torque \[N m\].
    pub load: f64,
    /// Recorded torque less the gravity torque \[N m\].
    pub torque: f64,
}

impl FrictionSample {
    /// Motor quadrant in the order of a1 to a8: driving forward, driving backward, braking
    /// backward, braking forward.
    fn quadrant(&self) -> usize {
        match (self.qd > 0.0, self.load > 0.0) {
            (true, true) => 0,
            (false, false) if self.load < 0.0 => 1,
            (false, _) => 2,
            (true, false) => 3,
        }
    }
}

/// How Coulomb friction depends on the load: as much as the samples show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CoulombForm {
    /// A line in the load for each of the four quadrants, (6) to (9).
    Quadrants,
    /// sign(q̇) (a + b |load|) + offset: not every quadrant was seen.
    Symmetric,
    /// A value for each direction: the load does not vary enough.
    Constant,
}

/// The friction of one joint as fitted.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointFriction {
    /// The joint's name.
    pub joint: String,
    /// Coefficients a1 to a8 and v1 to v3.
    pub coefficients: FrictionDescription,
    /// Their standard errors, in the same order; those of coefficients that were not free are 0.
    pub standard_errors: FrictionDescription,
    /// How Coulomb friction was taken to depend on the load.
    pub form: CoulombForm,
    /// Samples in each quadrant, in the order of a1 to a8.
    pub quadrants: [usize; 4],
    /// Part of the torque's variance that gravity, friction and the joint's inertia explain.
    pub r2: f64,
    /// The same of the torque less gravity: what friction and inertia explain of what gravity
    /// leaves.
    pub r2_without_gravity: f64,
    /// Root mean square of the residuals \[N m\].
    pub residual: f64,
    /// Condition number of the regression, columns scaled to unit length.
    pub condition: f64,
    /// Inertia about the joint that was fitted beside \[kg m²\].
    pub inertia: f64,
    /// Samples, and how many of them are independent.
    pub samples: (usize, f64),
}

/// A joint's fit with what its figure shows.
#[derive(Debug, Clone)]
pub struct FrictionFit {
    /// The result.
    pub joint: JointFriction,
    /// The samples.
    pub samples: Vec<FrictionSample>,
    /// Torque that the fit leaves, by sample \[N m\].
    pub residuals: Vec<f64>,
}

/// Fits (5) to (9) to the samples of one joint: Coulomb friction by quadrants as far as they were
/// seen, a cubic in q̇, and the joint's inertia.
///
/// None where fewer than 50 samples are left to fit.
pub fn fit(name: &str, samples: &[FrictionSample]) -> Option<FrictionFit> {
    if samples.len() < 50 {
        return None;
    }
    let form = form_shown(samples);
    let columns = form.coulomb_columns() + 4;
    let row = |s: &FrictionSample| form.row(s);
    let mut weights = vec![1.0; samples.len()];
    let all: Vec<usize> = (0..samples.len()).collect();
    let solve = |weights: &[f64]| {
        Triangle::of_rows(&all, columns, |k, out| {
            let (row, w) = (row(&samples[k]), weights[k]);
            out[..columns].iter_mut().zip(&row).for_each(|(o, v)| *o = w * v);
            out[columns] = w * samples[k].torque;
        })
        .solve()
    };
    let residuals = |x: &DVector<f64>| -> Vec<f64> {
        let left = |s: &FrictionSample| {
            s.torque - row(s).iter().zip(x.iter()).map(|(a, x)| a * x).sum::<f64>()
        };
        samples.iter().map(left).collect()
    };
    for _ in 0..ROUNDS {
        let left = residuals(&solve(&weights).x);
        let deviation = robust_deviation(&left);
        weights = left.iter().map(|r| huber_weight(*r, deviation)).collect();
    }
    let solution = solve(&weights);
    let left = residuals(&solution.x);
    let alike = samples_per_independent_one(&[&left]);
    let scale = robust_deviation(&left)
        .max(root_mean_square(left.iter().zip(&weights).map(|(r, w)| r * w)))
        * alike.sqrt();
    let errors: Vec<f64> = solution.standard_errors().iter().map(|e| e * scale).collect();
    let spread = |values: Vec<f64>| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter().map(|v| (v - mean).powi(2)).sum::<f64>()
    };
    let unexplained = spread(left.clone());
    let joint = JointFriction {
        joint: name.into(),
        coefficients: form.description(solution.x.as_slice()),
        standard_errors: form.errors(&errors),
        form,
        quadrants: counts(samples),
        r2: 1.0 - unexplained / spread(samples.iter().map(|s| s.torque + s.load).collect()),
        r2_without_gravity: 1.0 - unexplained / spread(samples.iter().map(|s| s.torque).collect()),
        residual: root_mean_square(left.iter().copied()),
        condition: solution.condition,
        inertia: solution.x[columns - 1],
        samples: (samples.len(), samples.len() as f64 / alike),
    };
    Some(FrictionFit { joint, samples: samples.to_vec(), residuals: left })
}

fn counts(samples: &[FrictionSample]) -> [usize; 4] {
    let mut counts = [0; 4];
    samples.iter().for_each(|s| counts[s.quadrant()] += 1);
    counts
}

/// The form that the samples can tell: all four quadrants with loads that vary, else loads that
/// vary at all.
fn form_shown(samples: &[FrictionSample]) -> CoulombForm {
    let counts = counts(samples);
    let range = |quadrant: Option<usize>| {
        let own = samples
            .iter()
            .filter(|s| quadrant.is_none_or(|q| s.quadrant() == q))
            .map(|s| s.load.abs());
        own.clone().fold(0.0, f64::max) - own.fold(f64::INFINITY, f64::min)
    };
    let mut sizes: Vec<f64> = samples.iter().map(|s| s.torque.abs()).collect();
    let middle = sizes.len() / 2;
    let usual = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
    let varies = |range: f64| range > LOAD_RANGE * usual;
    let (share, least) = SEEN;
    let seen = |q: usize| counts[q] as f64 > (share * samples.len() as f64).max(least);
    if (0..4).all(|q| seen(q) && varies(range(Some(q)))) {
        CoulombForm::Quadrants
    } else if varies(range(None)) {
        CoulombForm::Symmetric
    } else {
        CoulombForm::Constant
    }
}

impl CoulombForm {
    fn coulomb_columns(self) -> usize {
        match self {
            Self::Quadrants => 8,
            Self::Symmetric => 3,
            Self::Constant => 2,
        }
    }

    /// Coulomb columns, q̇, q̇², q̇³, q̈.
    fn row(self, s: &FrictionSample) -> Vec<f64> {
        let mut row = vec![0.0; self.coulomb_columns()];
        let sign = s.qd.signum();
        match self {
            Self::Quadrants => (row[2 * s.quadrant()], row[2 * s.quadrant() + 1]) = (1.0, s.load),
            Self::Symmetric => row.copy_from_slice(&[sign, sign * s.load.abs(), 1.0]),
            Self::Constant => row[usize::from(sign < 0.0)] = 1.0,
        }
        row.extend([s.qd, s.qd.powi(2), s.qd.powi(3), s.qdd]);
        row
    }

    /// a1 to a8 and v1 to v3 of a solution.
    fn description(self, x: &[f64]) -> FrictionDescription {
        let coulomb = match self {
            Self::Quadrants => *x.first_chunk().expect("eight columns"),
            Self::Symmetric => {
                let (f, b, o) = (x[0], x[1], x[2]);
                [o + f, b, o - f, b, o - f, -b, o + f, -b]
            }
            Self::Constant => [x[0], 0.0, x[1], 0.0, x[1], 0.0, x[0], 0.0],
        };
        self.with_viscous(coulomb, x)
    }

    fn errors(self, e: &[f64]) -> FrictionDescription {
        let coulomb = match self {
            Self::Symmetric => [
                e[0].hypot(e[2]),
                e[1],
                e[0].hypot(e[2]),
                e[1],
                e[0].hypot(e[2]),
                e[1],
                e[0].hypot(e[2]),
                e[1],
            ],
            _ => return self.description(e),
        };
        self.with_viscous(coulomb, e)
    }

    fn with_viscous(self, coulomb: [f64; 8], x: &[f64]) -> FrictionDescription {
        let v = self.coulomb_columns();
        FrictionDescription { coulomb, viscous: [x[v], x[v + 1], x[v + 2]] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use reachtube_robot::friction::{Coulomb, Viscous};

    const A: [f64; 8] = [4.46, 0.38, -5.46, 0.32, -4.64, 0.041, 4.08, -0.0019];

    /// A joint that swings through its loads; `noise` is added to each torque.
    fn swings(a: [f64; 8], load: f64, noise: f64) -> Vec<FrictionSample> {
        let (coulomb, viscous) =
            (Coulomb::from_coefficients(a), Viscous { v1: 10.08, v2: 0.1, v3: -1.02 });
        let mut state = 7u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let sample = |k: usize| {
            let t = 0.01 * k as f64;
            let (qd, qdd, load) = ((0.7 * t).sin(), 0.7 * (0.7 * t).cos(), load * (0.11 * t).cos());
            let torque = coulomb.torque(load, qd)
                + viscous.torque(&qd)
                + 1.7 * qdd
                + noise * random() * 12f64.sqrt();
            FrictionSample { qd, qdd, load, torque }
        };
        (1..12_000).map(sample).filter(|s| s.qd.abs() > 0.02).collect()
    }

    #[test]
    fn the_quadrants_of_joint_2_of_the_paper_are_found() {
        let found = fit("joint2", &swings(A, 30.0, 0.3)).unwrap().joint;
        assert_eq!(found.form, CoulombForm::Quadrants);
        let (mut within, mut count) = (0, 0);
        let true_values = A.iter().chain(&[10.08, 0.1, -1.02]);
        let found_values = found.coefficients.coulomb.iter().chain(&found.coefficients.viscous);
        let errors = found.standard_errors.coulomb.iter().chain(&found.standard_errors.viscous);
        for ((value, found), error) in true_values.zip(found_values).zip(errors) {
            assert!(
                (value - found).abs() < 4.0 * error && *error < 0.3,
                "{value}: {found} ± {error}"
            );
            within += usize::from((value - found).abs() < 2.0 * error);
            count += 1;
        }
        assert!(within >= count - 2, "{within} of {count} within two standard errors");
        assert!((found.inertia - 1.7).abs() < 0.05 && found.r2 > 0.99);
    }

    #[test]
    fn a_joint_without_load_has_a_value_for_each_direction() {
        let found = fit("joint1", &swings(A, 0.0, 0.1)).unwrap().joint;
        assert_eq!(found.form, CoulombForm::Constant);
        let [_, _, a3, _, a5, _, a7, _] = found.coefficients.coulomb;
        assert!(
            (a3 + 4.64).abs() < 0.05 && a3 == a5 && (a7 - 4.08).abs() < 0.05,
            "{:?}",
            found.coefficients
        );
    }

    #[test]
    fn outliers_do_not_bend_the_fit() {
        let mut samples = swings(A, 30.0, 0.1);
        let clean = fit("j", &samples).unwrap().joint.coefficients;
        samples.iter_mut().step_by(25).for_each(|s| s.torque += 80.0);
        let bent = fit("j", &samples).unwrap().joint.coefficients;
        let off =
            clean.coulomb.iter().zip(&bent.coulomb).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 0.1, "{off}");
        assert!(fit("j", &samples[..40]).is_none());
    }
}
