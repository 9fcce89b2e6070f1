//! Whether the parts of a model file fit together.

use nalgebra::{DMatrix, DVector};
use reachtube_reach::{Hyperrectangle, LinearSystem, System};

use crate::claim::verdict::SuiteVerdict;
use crate::data::settings::check_allowance;
use crate::data::setup::Setup;
use crate::model::file::{Loader, Model};
use crate::model::records::SuiteRecord;

/// Relative difference up to which numbers that were computed twice count as the same.
const SAME: f64 = 1e-9;

impl Model {
    fn check_sizes(&self) -> Result<(), String> {
        let n = self.signals.inputs.len();
        let is = |matrix: &[Vec<f64>], columns: usize| {
            matrix.len() == 2 * n && matrix.iter().all(|row| row.len() == columns)
        };
        let set =
            |set: &Hyperrectangle, dimension: usize| set.is_valid() && set.dimension() == dimension;
        // Sets that were widened are not the smallest, so nothing bounds their cost from below.
        let are_wider = self.calibration.is_some() || !self.allowance.is_empty();
        let lower_bound = self.cost_lower_bound.or(are_wider.then_some(0.0));
        let costs = [self.cost, lower_bound, self.cost_paper, self.hull_volume];
        let is_linear = !self.a.is_empty();
        let linear = is(&self.a, 2 * n) && is(&self.b, n) && self.drift.len() == 2 * n;
        let none = self.a.is_empty() && self.b.is_empty() && self.drift.is_empty();
        let sets = set(&self.initial_set, 2 * n)
            && set(&self.input_set, n)
            && self.noise_set.as_ref().is_none_or(|noise| set(noise, 2 * n));
        let problem = if is_linear && costs.contains(&None) {
            "it has no cost, cost_lower_bound, cost_paper or hull_volume, as every linear model \
             does"
                .into()
        } else if !(if is_linear { linear } else { none }) {
            format!("a, b or drift has not the size for {n} inputs")
        } else if !sets {
            format!(
                "initial_set, input_set or noise_set has not the size for {n} inputs, or a \
                 negative radius"
            )
        } else if self.data.suites.iter().any(|suite| !suite.fits(n)) {
            format!(
                "a nominal_start is not one of {} states, or the runs of a suite are neither \
                 listed nor counted",
                2 * n
            )
        } else if !self.allowance.is_empty() && check_allowance(&self.allowance, n).is_err() {
            format!("its allowance is not {} radii", 3 * n)
        } else if self.stiction.iter().any(|rest| !(1..=n).contains(&rest.part)) {
            format!("its stiction names a {} that is not one of {n}", self.signals.noun)
        } else {
            return self.settings.validate(n).map_err(|error| error.to_string());
        };
        Err(format!("{problem}; run conform again"))
    }

    /// Checks that what is in the file twice is the same: if it is not, a part was changed. Returns
    /// the drive, its system and the settings.
    ///
    /// # Errors
    ///
    /// What speaks against the file.
    pub(super) fn checked_setup(&self, loader: &dyn Loader) -> Result<Setup, String> {
        self.check_sizes()?;
        if self.data.sha256 != self.data.digest() {
            return Err(changed("data.sha256 does not match the recordings it lists"));
        }
        let holds = self.proof.conformant;
        let all_hold =
            self.proof.violations.count == 0 && self.proof.suites.iter().all(SuiteVerdict::holds);
        if self.verified != holds || holds && !all_hold {
            return Err(changed("verified does not agree with proof"));
        }
        let (drive, made) = loader.load(self)?;
        let dynamics = self.dynamics(made)?;
        if self.sha256 != self.digest() {
            return Err(changed("sha256 does not match the content"));
        }
        if *drive.signals() != self.signals {
            return Err(changed("signals does not agree with drive"));
        }
        let start = |suite: &SuiteRecord| Some((suite.name.clone(), suite.nominal_start.clone()?));
        let nominal_starts = self.data.suites.iter().filter_map(start).collect();
        let settings = self.settings.clone();
        Ok(Setup { drive, dynamics, settings, nominal_starts, condition: None })
    }

    /// Returns the system bit by bit as the file has it, or what speaks against it; `made` is the
    /// one that the drive makes.
    fn dynamics(&self, made: System) -> Result<System, String> {
        let mismatch =
            || changed("it has not the matrices or polynomials that its settings ask for");
        let expected = match (made.linear_system(), self.a.is_empty()) {
            (None, true) => return Ok(made),
            (Some(expected), false) => expected,
            _ => return Err(mismatch()),
        };
        let drift = DVector::from_vec(self.drift.clone());
        let own = LinearSystem::new(matrix(&self.a), matrix(&self.b), drift)
            .map_err(|error| error.to_string())?;
        if !is_near(expected, &own) {
            return Err(changed(
                "a, b or drift does not agree with its robot at its expansion \
                point",
            ));
        }
        Ok(System::Linear(own))
    }
}

/// Returns the message about a file whose parts contradict each other.
fn changed(what: &str) -> String {
    format!("{what}: the file was changed after it was written; run conform again")
}

fn is_near(made: &LinearSystem, own: &LinearSystem) -> bool {
    let near = |x: &DMatrix<f64>, y: &DMatrix<f64>| (x - y).amax() <= SAME * x.amax().max(y.amax());
    let drift = (made.drift() - own.drift()).amax() <= SAME * made.drift().amax();
    near(made.a(), own.a()) && near(made.b(), own.b()) && drift
}

fn matrix(rows: &[Vec<f64>]) -> DMatrix<f64> {
    let columns = rows.first().map_or(0, Vec::len);
    DMatrix::from_row_iterator(rows.len(), columns, rows.iter().flatten().copied())
}
