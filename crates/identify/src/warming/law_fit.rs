use crate::regression::residuals::{
    autocorrelation_time, huber_row_factor, robust_standard_deviation, root_mean_square,
};
use crate::regression::triangular_factor::TriangularFactor;
use crate::warming::rows::FrictionRow;
use reachtube_robot::friction::Warming;

/// Rounds of Gauss and Newton with new weights; rates of some percent converge in a few.
const ROUNDS: usize = 5;

/// Robust standard deviations beyond which a residual is an outlier, as in the fit of the links.
const OUTLIER_DEVIATIONS: f64 = 4.0;

/// Largest magnitude of the logarithm of a factor in a step, which keeps a wild step finite.
const MOST_LOG: f64 = 3.0;

/// Which friction changes with warmth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    /// No friction.
    Constant,
    /// Viscous friction.
    Viscous,
    /// Coulomb friction.
    Coulomb,
    /// Both, at one rate.
    Common,
    /// Both, each at its own rate.
    Separate,
}

impl Shape {
    /// All shapes that change.
    pub(crate) const CHANGING: [Self; 4] =
        [Self::Viscous, Self::Coulomb, Self::Common, Self::Separate];

    /// Returns the rows of the map from free rates to the rates of Coulomb and viscous friction.
    fn rates(self) -> &'static [[f64; 2]] {
        match self {
            Self::Constant => &[],
            Self::Viscous => &[[0.0, 1.0]],
            Self::Coulomb => &[[1.0, 0.0]],
            Self::Common => &[[1.0, 1.0]],
            Self::Separate => &[[1.0, 0.0], [0.0, 1.0]],
        }
    }
}

/// A law fitted to the friction of a joint: y = α_c f_c C + α_v f_v V + o, where C and V are
/// Coulomb and viscous friction at the reference and f_c, f_v the factors of the law.
#[derive(Debug, Clone)]
pub(super) struct LawFit {
    /// The law with the fitted rates.
    pub law: Warming,
    /// α_c, α_v and o \[N m\].
    linear: [f64; 3],
    /// Standard errors of the rates of Coulomb and viscous friction; 0 for a rate that is fixed.
    pub standard_errors: [f64; 2],
}

impl LawFit {
    /// Fits the rates of `law` that `shape` frees, from rate 0. The result is `None` where the rows
    /// do not determine them.
    pub(super) fn new(shape: Shape, law: Warming, rows: &[FrictionRow]) -> Option<Self> {
        let law = Warming { coulomb: 0.0, viscous: 0.0, ..law };
        let mut fit = Self { law, linear: [1.0, 1.0, 0.0], standard_errors: [0.0; 2] };
        let map = shape.rates();
        let mut solution = None;
        for _ in 0..ROUNDS {
            let (residuals, weights) = fit.weighted(rows);
            let all: Vec<usize> = (0..rows.len()).collect();
            let columns = 3 + map.len();
            let step = TriangularFactor::from_written_rows(&all, columns, |k, out| {
                out[..columns].copy_from_slice(&fit.slopes(&rows[k], map));
                out[columns] = residuals[k];
                out.iter_mut().for_each(|value| *value *= weights[k]);
            })
            .solve();
            if (3..columns).any(|k| !step.covariance[(k, k)].is_finite()) {
                return None;
            }
            (0..3).for_each(|k| fit.linear[k] += step.x[k]);
            for (free, rates) in map.iter().enumerate() {
                let change = step.x[3 + free].clamp(-1.0, 1.0);
                fit.law.coulomb += rates[0] * change;
                fit.law.viscous += rates[1] * change;
            }
            solution = Some(step);
        }
        let errors = solution?.standard_errors();
        let (residuals, weights) = fit.weighted(rows);
        let time = autocorrelation_time(&[&residuals]);
        let size = root_mean_square(residuals.iter().zip(&weights).map(|(r, w)| r * w));
        let scale = robust_standard_deviation(&residuals).max(size) * time.sqrt();
        for (free, rates) in map.iter().enumerate() {
            (0..2).for_each(|k| fit.standard_errors[k] += rates[k] * scale * errors[3 + free]);
        }
        Some(fit)
    }

    /// Returns the residual of each row \[N m\] and its weight.
    fn weighted(&self, rows: &[FrictionRow]) -> (Vec<f64>, Vec<f64>) {
        let residuals: Vec<f64> = rows.iter().map(|row| self.residual(row)).collect();
        let limit = OUTLIER_DEVIATIONS * robust_standard_deviation(&residuals);
        let weights = residuals.iter().map(|r| huber_row_factor(*r, limit)).collect();
        (residuals, weights)
    }

    /// Returns the factors of a row, kept finite while the fit is under way.
    fn factors(&self, row: &FrictionRow) -> [f64; 2] {
        let warmth = self.law.warmth(row.value);
        let factor = |rate: f64| (-rate * warmth).clamp(-MOST_LOG, MOST_LOG).exp();
        [factor(self.law.coulomb), factor(self.law.viscous)]
    }

    /// Returns recorded minus predicted friction \[N m\].
    pub(super) fn residual(&self, row: &FrictionRow) -> f64 {
        let ([c, v], [coulomb, viscous]) = (self.factors(row), row.friction);
        let [alpha_c, alpha_v, offset] = self.linear;
        row.torque - alpha_c * c * coulomb - alpha_v * v * viscous - offset
    }

    /// Returns the derivatives of the prediction with respect to α_c, α_v, o and the free rates.
    fn slopes(&self, row: &FrictionRow, map: &[[f64; 2]]) -> Vec<f64> {
        let ([c, v], warmth) = (self.factors(row), self.law.warmth(row.value));
        let (coulomb, viscous) = (c * row.friction[0], v * row.friction[1]);
        let by_rate = [-warmth * self.linear[0] * coulomb, -warmth * self.linear[1] * viscous];
        let free = map.iter().map(|rates| rates[0] * by_rate[0] + rates[1] * by_rate[1]);
        [coulomb, viscous, 1.0].into_iter().chain(free).collect()
    }
}
