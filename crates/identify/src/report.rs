//! The result of an identification in words and tables, as the command and the page show it.

use reachtube_finding::{Report, Section, Table, Units};
use reachtube_robot::{FrictionDescription, JointKind};
use reachtube_scalar::number::significant;

use crate::fit::JointFit;
use crate::friction::fit::FrictionFit;
use crate::identification::Identification;
use crate::inertia::SaturatingFriction;
use crate::inertia::base::BaseParameter;
use crate::plausibility::gain::Gain;
use crate::plausibility::offset::PositionOffset;
use crate::validate::simulation::WindowErrors;
use crate::validate::torque::{JointError, LogValidation};

/// Largest number of recordings that are listed.
const MOST_RECORDINGS: usize = 20;

impl Identification {
    /// Returns the report: a section for each step of the identification, named as in the method,
    /// then the errors of the predicted torque and of simulated motions.
    #[must_use]
    pub fn report(&self) -> Report {
        let section = |title: &str, (tables, facts): Parts| {
            let facts = facts.into_iter().map(|(name, value)| (name.to_string(), value)).collect();
            Section { title: title.into(), tables, facts, ..Section::default() }
        };
        Report {
            sections: vec![
                section("Gravity", self.gravity_parts()),
                section("Friction", self.friction_parts()),
                section("Inertial parameters", self.inertia_parts()),
                section("Predicted torque", self.torque_parts()),
                section("Simulated motion", (vec![self.motion_table()], Vec::new())),
            ],
        }
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.description.joints.iter().map(|joint| joint.name.as_str())
    }

    fn unit(&self, unit: fn(JointKind) -> &'static str) -> Units {
        JointKind::column(&self.description.kinds(), unit)
    }

    fn gravity_parts(&self) -> Parts {
        let Some(gravity) = &self.gravity else {
            let why = "no poses at rest or slow motions are given; the inertial parameters show it";
            return (Vec::new(), vec![("not fitted", why.into())]);
        };
        let force = self.unit(JointKind::force_unit);
        let cells = |joint: usize, fit: Option<&JointFit>| match fit {
            None => ["-"; 3].map(String::from),
            Some(fit) => [
                force.cell(joint, significant(fit.torque, 4)),
                force.cell(joint, significant(fit.residual, 3)),
                percent(fit.relative()),
            ],
        };
        let row = |(joint, name): (usize, &str)| {
            let [rest, moving] = [&gravity.at_rest, &gravity.in_motion]
                .map(|fits| cells(joint, fits.get(joint)).to_vec());
            [vec![name.into()], rest, moving].concat()
        };
        let header = [
            "joint",
            &force.head("torque at rest, rms"),
            &force.head("residual"),
            "residual / torque",
            &force.head("moving: torque, rms"),
            &force.head("residual"),
            "residual / torque",
        ];
        let facts = vec![
            ("poses at rest", gravity.rests.to_string()),
            ("samples of slow motions", gravity.slow_samples.to_string()),
        ];
        (vec![Table::new(header, self.names().enumerate().map(row).collect())], facts)
    }

    fn friction_parts(&self) -> Parts {
        if self.friction.is_empty() {
            let why = "no slow motions of single joints are given; the inertial parameters include \
                       it";
            return (Vec::new(), vec![("not fitted", why.into())]);
        }
        let kind = |fit: &FrictionFit| {
            let own = self.description.joints.iter().find(|joint| joint.name == fit.joint.joint);
            own.map_or_else(JointKind::default, |joint| joint.kind)
        };
        let kinds: Vec<JointKind> = self.friction.iter().map(kind).collect();
        let force = JointKind::column(&kinds, JointKind::force_unit);
        let row = |name: &str, cell: &dyn Fn(usize, &FrictionFit) -> String| -> Vec<String> {
            let cells = self.friction.iter().enumerate().map(|(i, fit)| cell(i, fit));
            std::iter::once(name.to_string()).chain(cells).collect()
        };
        let names = (1..=8).map(|k| format!("a{k}")).chain((1..=3).map(|k| format!("v{k}")));
        let mut rows: Vec<Vec<String>> =
            names.enumerate().map(|(k, name)| row(&name, &|_, fit| coefficient(fit, k))).collect();
        let residual =
            |i: usize, fit: &FrictionFit| force.cell(i, significant(fit.joint.residual, 3));
        rows.extend([
            row("R²", &|_, fit| format!("{:.5}", fit.joint.r2)),
            row("R² without gravity", &|_, fit| format!("{:.4}", fit.joint.r2_without_gravity)),
            row(&force.head("residual"), &residual),
            row("samples (independent)", &|_, FrictionFit { joint, .. }| {
                format!("{} ({:.0})", joint.samples.0, joint.samples.1)
            }),
        ]);
        let joints = self.friction.iter().map(|fit| fit.joint.joint.as_str());
        let coefficients = Table::new(std::iter::once("coefficient").chain(joints), rows).titled(
            "Coefficients of Coulomb friction, eqs. (6) to (9), and of viscous friction, eq. (5), \
             with standard errors; the gravity torque is the load",
        );
        let row = |law: &SaturatingFriction| {
            let numbers = [law.held_out[0], law.held_out[1], law.builds_up, law.speed];
            let numbers = numbers.into_iter().map(|number| significant(number, 4));
            std::iter::once(law.joint.clone()).chain(numbers).collect()
        };
        let header = ["joint", "residual without", "held-out residual with", "builds up", "over"];
        let laws = Table::new(header, self.saturating.iter().map(row).collect());
        let laws = laws.titled("Joints whose friction saturates");
        let tables = [coefficients, laws].into_iter().filter(|table| !table.rows.is_empty());
        (tables.collect(), Vec::new())
    }

    fn inertia_parts(&self) -> Parts {
        let (fit, force) = (&self.inertia, self.unit(JointKind::force_unit));
        let row = |(j, name): (usize, &str)| {
            let joint = &fit.joints[j];
            let torque = |value| force.cell(j, significant(value, 3));
            let physical = fit.physical.as_ref().map(|physical| torque(physical.residuals[j][1]));
            vec![
                name.to_string(),
                format!("{} ({:.0})", joint.rows, joint.independent),
                torque(joint.torque),
                torque(joint.residual),
                percent(joint.relative()),
                physical.unwrap_or_else(|| "-".into()),
                percent(joint.outliers),
            ]
        };
        let header = [
            "joint",
            "samples (independent)",
            &force.head("torque, rms"),
            &force.head("residual, rms"),
            "residual / torque",
            &force.head("residual, physical"),
            "beyond three deviations",
        ];
        let joints = Table::new(header, self.names().enumerate().map(row).collect())
            .titled("Fit of the torque on the exciting motions");
        let header = [
            "value",
            "least squares",
            "standard error",
            "relative",
            "in the description",
            "combination (SI units)",
        ];
        let parameters = Table::new(header, fit.parameters.iter().map(parameter_row).collect())
            .titled("Identifiable combinations of parameters");
        (vec![joints, parameters], self.inertia_facts())
    }

    fn inertia_facts(&self) -> Vec<(&'static str, String)> {
        let fit = &self.inertia;
        let mut facts = vec![
            ("combinations determined", format!("{} of {}", fit.determined, fit.parameters.len())),
            ("condition number of the base regressor", significant(fit.condition, 4)),
            (
                "relative singular values beside the rank cut",
                format!("{:.0e} | {:.0e}", fit.gap[0], fit.gap[1]),
            ),
        ];
        if let Some(physical) = &fit.physical {
            facts.push((
                "plain least squares",
                match &physical.plain_impossible {
                    Some(why) => format!("a robot that cannot exist: {why}"),
                    None => "its mass matrix is positive definite".into(),
                },
            ));
            let [cost, gap] = [physical.cost, physical.gap].map(|value| significant(value, 3));
            facts.push((
                "increase of the sum of squares for physically consistent links",
                format!("{cost} standard deviations squared (within {gap} of the least)"),
            ));
        }
        let gain = |g: &Gain| format!("{} {:.3} ± {:.3}", g.joint, g.gain, g.standard_error);
        let gains: Vec<String> = self.gains.iter().map(gain).collect();
        facts.push(("torque gains with the best agreement of the joints", gains.join(", ")));
        facts.extend(self.offset_facts());
        facts
    }

    /// Returns the offsets of the positions, and the size from which on one would be reported.
    fn offset_facts(&self) -> Vec<(&'static str, String)> {
        let unit = self.unit(JointKind::position_unit);
        let shared = unit.shared().map_or_else(String::new, |unit| format!(" {unit}"));
        let list = |cell: &dyn Fn(&PositionOffset) -> Option<String>| {
            let cell = |(j, joint)| cell(joint).map_or("-".into(), |value| unit.cell(j, value));
            let cells = self.offsets.iter().enumerate().map(cell).collect::<Vec<_>>();
            cells.join(", ") + &shared
        };
        let own = |joint: &PositionOffset| {
            Some(format!("{:.4} ± {:.4}", joint.offset?, joint.standard_error?))
        };
        let limit = |joint: &PositionOffset| Some(format!("{:.3}", joint.limit?));
        match self.offsets.is_empty() {
            true => Vec::new(),
            false => vec![
                ("offsets of the positions that explain the torque best, each alone", list(&own)),
                ("smaller offsets may be errors of the model", list(&limit)),
            ],
        }
    }

    fn torque_parts(&self) -> Parts {
        let which = match self.held_out {
            true => "held out from the fits",
            false => "the same as in the fits, since none were held out",
        };
        let facts = vec![("recordings", which.to_string())];
        // The last row is for all recordings.
        let Some((all, logs)) = self.validation.split_last() else { return (Vec::new(), facts) };
        let names: Vec<&str> = self.names().collect();
        let force = self.unit(JointKind::force_unit);
        let row = |(j, error): (usize, &JointError)| {
            vec![
                names[j].to_string(),
                force.cell(j, significant(error.torque, 3)),
                force.cell(j, significant(error.residual, 3)),
                part(error.relative),
                part(error.relative_plain),
                part(error.relative_all),
                error.r2.map_or("-".into(), |r2| format!("{r2:.4}")),
            ]
        };
        let header = [
            "joint",
            &force.head("torque, rms"),
            &force.head("error, rms"),
            "error / torque",
            "of plain least squares",
            "with standstill",
            "R²",
        ];
        let whole = Table::new(header, all.joints.iter().enumerate().map(row).collect())
            .titled("Error of the predicted torque over all recordings, where a joint moves");
        if logs.is_empty() {
            return (vec![whole], facts);
        }
        let mut shown: Vec<&LogValidation> = logs.iter().collect();
        let mut title = "Error / torque in each recording".to_string();
        if logs.len() > MOST_RECORDINGS {
            let worst = |log: &LogValidation| {
                log.joints.iter().filter_map(|joint| joint.relative).fold(0.0, f64::max)
            };
            shown.sort_by(|a, b| worst(b).total_cmp(&worst(a)));
            title = "Error / torque in the worst recordings".into();
        }
        let cell = |joint: &JointError| match joint.samples {
            0 => "at rest".into(),
            _ => part(joint.relative),
        };
        let row = |log: &&LogValidation| {
            std::iter::once(log.log.clone()).chain(log.joints.iter().map(cell)).collect()
        };
        let header = std::iter::once("recording").chain(names.iter().copied());
        let each = Table::new(header, shown.iter().map(row).collect()).titled(title);
        (vec![whole, each.cut_to(MOST_RECORDINGS)], facts)
    }

    fn motion_table(&self) -> Table {
        let names: Vec<&str> = self.names().collect();
        let [q, qd] = [JointKind::position_unit, JointKind::velocity_unit].map(|of| self.unit(of));
        let [position, motion] =
            ["position error at the end", "motion of the joint"].map(|name| q.head(name));
        let velocity = qd.head("velocity error");
        let row = |window: &WindowErrors, joint: usize| {
            let WindowErrors { duration, windows, diverged, .. } = window;
            let name = format!("{duration} s ({windows}, {diverged} diverged)");
            let has_end = diverged < windows;
            let error = |unit: &Units, error: f64| match has_end {
                true => unit.cell(joint, significant(error, 3)),
                false => "-".into(),
            };
            vec![
                if joint == 0 { name } else { String::new() },
                names[joint].to_string(),
                error(&q, window.q[joint]),
                q.cell(joint, significant(window.motion[joint], 3)),
                error(&qd, window.qd[joint]),
            ]
        };
        let of_window = |window| (0..names.len()).map(move |joint| (window, joint));
        let rows = self.windows.iter().flat_map(of_window);
        let rows = rows.map(|(window, joint)| row(window, joint)).collect();
        Table::new(["window", "joint", &position, &motion, &velocity], rows)
            .titled("Root mean squares over windows driven by the recorded torque")
    }
}

/// The tables and the facts of a section.
type Parts = (Vec<Table>, Vec<(&'static str, String)>);

fn percent(part: f64) -> String {
    format!("{:.1} %", 100.0 * part)
}

fn part(part: Option<f64>) -> String {
    part.map_or("-".into(), percent)
}

/// Returns coefficient `k` of a1 to a8 and v1 to v3 with its standard error.
fn coefficient(fit: &FrictionFit, k: usize) -> String {
    let of = |friction: &FrictionDescription| {
        if k < 8 { friction.coulomb[k] } else { friction.viscous[k - 8] }
    };
    let [value, error] = [&fit.joint.coefficients, &fit.joint.standard_errors].map(of);
    let value = significant(value, 3);
    if error > 0.0 { format!("{value} ± {}", significant(error, 1)) } else { value }
}

fn parameter_row(parameter: &BaseParameter) -> Vec<String> {
    let BaseParameter { name, value, least_squares, standard_error, described } = parameter;
    let relative = standard_error / least_squares.abs();
    let error = match standard_error.is_finite() {
        true => significant(*standard_error, 2),
        false => "not identifiable".into(),
    };
    vec![
        significant(*value, 4),
        significant(*least_squares, 4),
        error,
        if relative < 10.0 { percent(relative) } else { "-".into() },
        significant(*described, 4),
        name.clone(),
    ]
}
