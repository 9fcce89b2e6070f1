//! Table III: the model of the LWA 4P, identified from the recordings of a campaign.

use std::path::{Path, PathBuf};

use reachtube_identify::prepare::{LogEntry, VelocitySource};
use reachtube_identify::{BaseParameter, Identification, IdentifySettings, identify};
use reachtube_robot::{BaseParameters, Parameter, ParameterKind, Robot};
use schemars::JsonSchema;
use serde::Serialize;

use super::figures::{PaperFigure, fig5};
use crate::campaign::campaign_options;
use crate::error::{Error, Result};
use crate::virtual_robot::VirtualRobotParameters;

/// A value that is 0 but for rounding.
const ROUNDING: f64 = 1e-9;

/// A part of Table III.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Part {
    /// Friction parameters.
    Friction,
    /// Gravity model.
    Gravity,
    /// Inertial parameters.
    Inertia,
}

/// What the virtual arm does and the model of Table III cannot show. It moves estimates away from
/// the truth, and no number of recordings brings them closer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Effect {
    /// Dry friction rises toward standstill; the law without this rise is higher elsewhere.
    Stribeck,
    /// Friction falls while the joints warm up; the law holds at the mean warmth.
    Warming,
    /// The motor's torque ripples with its angle. A slow ripple passes the low-pass and moves the
    /// joint, so that it is not noise.
    Ripple,
    /// The torque acts later than it is recorded, so that the inertia of a motor takes up a part of
    /// the viscous friction of its joint.
    Delay,
}

/// A row of Table III.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(crate) struct Table3Row {
    /// The part of the table.
    pub part: Part,
    /// A coefficient of a joint's friction, or a combination of parameters.
    pub name: String,
    /// Our estimate, by least squares, in SI units.
    pub estimate: f64,
    /// Its standard error; none if the recordings do not determine the coefficient, so that it is 0
    /// or another quadrant's.
    pub standard_error: Option<f64>,
    /// The value of the arm that moved.
    pub truth: f64,
    /// The estimate minus the truth, in standard errors.
    pub deviation: Option<f64>,
    /// Cause of differences between estimate and truth beyond the standard error.
    pub effects: Vec<Effect>,
    /// The value of the paper, where it prints one. The arm that moved is another one.
    pub paper: Option<f64>,
}

/// Table III.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Table3 {
    /// Number of static poses.
    pub poses: usize,
    /// The rows: friction joint by joint, gravity, inertial parameters.
    pub(crate) rows: Vec<Table3Row>,
    /// What identification warns of.
    pub warnings: Vec<String>,
}

impl Table3 {
    pub(crate) fn part(&self, part: Part) -> impl Iterator<Item = &Table3Row> {
        self.rows.iter().filter(move |row| row.part == part)
    }
}

/// Identifies the LWA 4P from the recordings of a [`campaign`](crate::campaign), and compares it
/// with the arm that moved and with the paper. Fig. 5 shows the same identification.
///
/// Gravity and friction come from static poses and slow motions, the inertial parameters from
/// exciting motions, as in the paper's appendix. The velocity is the derivative of the position,
/// because the recorded one lags behind by the time constant of its filter.
///
/// # Errors
///
/// Fails if the folder is not a campaign of the LWA 4P, as [`identify`], and for numbers that
/// cannot be drawn.
pub(super) fn table3_and_fig5(
    folder: &Path,
    progress: &dyn Fn(usize, usize),
) -> Result<(Table3, PaperFigure)> {
    let robot = Robot::lwa4p();
    let arm = campaign_options(folder)?.robot;
    let truth = Robot::load(&folder.join("truth.toml").display().to_string())?;
    if truth.name() != robot.name() {
        return Err(Error::OtherRobot { folder: folder.into(), robot: truth.name().into() });
    }
    let found = identify(&robot, &settings(folder), folder, progress)?;
    let mut rows = friction(&found, [&robot, &truth], &arm);
    rows.extend(gravity(&found, [&robot, &truth]));
    rows.extend(inertia(&found, [&robot, &truth], &arm));
    let poses = found.gravity.as_ref().map_or(0, |gravity| gravity.rests);
    let figure = fig5(&found)?;
    Ok((Table3 { poses, rows, warnings: found.warnings }, figure))
}

fn settings(folder: &Path) -> IdentifySettings {
    let entry = |name: &str| -> Vec<LogEntry> {
        folder.join(name).exists().then(|| PathBuf::from(name).into()).into_iter().collect()
    };
    let mut settings = IdentifySettings {
        rest: entry("rest"),
        one_joint: entry("one-joint"),
        excitation: entry("excitation"),
        validate: entry("validation"),
        ..IdentifySettings::default()
    };
    settings.prepare.velocity = VelocitySource::Differentiated;
    settings
}

fn present<const N: usize>(effects: [(Effect, f64); N]) -> Vec<Effect> {
    let some = effects.into_iter().filter(|(_, size)| *size != 0.0);
    some.map(|(effect, _)| effect).collect()
}

/// Returns the rows a1 to a8 and v1 to v3 of each joint, from the slow motions.
fn friction(
    found: &Identification,
    [paper, truth]: [&Robot; 2],
    arm: &VirtualRobotParameters,
) -> Vec<Table3Row> {
    let coefficients = |robot: &Robot, name: &str| {
        let joints = &robot.description().joints;
        let own = joints.iter().find(|joint| joint.name == name).map(|joint| joint.friction);
        let own = own.unwrap_or_default();
        [&own.coulomb[..], &own.viscous[..]].concat()
    };
    let names = (1..=8).map(|k| format!("a{k}")).chain((1..=3).map(|k| format!("v{k}")));
    let names: Vec<String> = names.collect();
    let of_joint = |fit: &reachtube_identify::FrictionFit| {
        let joint = &fit.joint;
        let (found, errors) = (joint.coefficients, joint.standard_errors);
        let found = [&found.coulomb[..], &found.viscous[..]].concat();
        let errors = [&errors.coulomb[..], &errors.viscous[..]].concat();
        let [papers, true_values] = [paper, truth].map(|robot| coefficients(robot, &joint.joint));
        let row = |k: usize| {
            let rate = if k < 8 { arm.coulomb_rate } else { arm.viscous_rate };
            let effects = present([
                (Effect::Stribeck, arm.breakaway_ratio),
                (Effect::Warming, rate),
                (Effect::Ripple, arm.ripple_ratio),
            ]);
            let name = format!("{} of {}", names[k], joint.joint);
            let estimate = [found[k], errors[k]];
            row(Part::Friction, name, estimate, true_values[k], effects, Some(papers[k]))
        };
        (0..names.len()).map(row).collect::<Vec<_>>()
    };
    found.friction.iter().flat_map(of_joint).collect()
}

/// Returns the mass moments that gravity shows, from the static poses.
fn gravity(found: &Identification, [paper, truth]: [&Robot; 2]) -> Vec<Table3Row> {
    let Some(gravity) = &found.gravity else { return Vec::new() };
    let columns = Parameter::of_joints(paper.joint_count(), &ParameterKind::INERTIAL);
    let base = BaseParameters::at_rest(paper, &columns);
    let true_values = base.reduce(&truth.parameter_values(&columns));
    let mut papers = paper.parameter_values(&columns);
    for (link, joint) in papers.chunks_exact_mut(10).zip(&paper.description().joints) {
        if let Some(moments) = joint.gravity_moments {
            link[0] = moments.mass;
            link[1..4].copy_from_slice(&moments.first_moment);
        }
    }
    let papers = base.reduce(&papers);
    let rows = gravity.parameters.iter().enumerate();
    rows.map(|(k, own)| combination(Part::Gravity, own, true_values[k], vec![], papers[k]))
        .collect()
}

fn inertia(
    found: &Identification,
    [paper, truth]: [&Robot; 2],
    arm: &VirtualRobotParameters,
) -> Vec<Table3Row> {
    let columns = &found.inertia.columns;
    let base = BaseParameters::of_robot(paper, columns);
    let [papers, true_values] =
        [paper, truth].map(|robot| base.reduce(&robot.parameter_values(columns)));
    let is_inertia = |k: &usize| {
        let kind = columns[base.independent()[*k]].kind;
        kind.is_inertial() || kind == ParameterKind::MotorInertia
    };
    let has_motor = |k: usize| {
        let row = base.combinations().row(k);
        columns.iter().zip(row.iter()).any(|(column, part)| {
            column.kind == ParameterKind::MotorInertia && part.abs() > ROUNDING
        })
    };
    let row = |k: usize| {
        let own = &found.inertia.parameters[k];
        let delay = if has_motor(k) { arm.delay_cycles } else { 0.0 };
        let effects = present([(Effect::Delay, delay)]);
        combination(Part::Inertia, own, true_values[k], effects, papers[k])
    };
    (0..base.count()).filter(is_inertia).map(row).collect()
}

/// Returns the row of a combination. The paper prints the parameters that are not 0.
fn combination(
    part: Part,
    own: &BaseParameter,
    truth: f64,
    effects: Vec<Effect>,
    paper: f64,
) -> Table3Row {
    let paper = (paper.abs() > ROUNDING).then_some(paper);
    let truth = if truth.abs() > ROUNDING { truth } else { 0.0 };
    let estimate = [own.least_squares, own.standard_error];
    row(part, own.name.clone(), estimate, truth, effects, paper)
}

fn row(
    part: Part,
    name: String,
    [estimate, error]: [f64; 2],
    truth: f64,
    effects: Vec<Effect>,
    paper: Option<f64>,
) -> Table3Row {
    let standard_error = (error > 0.0 && error.is_finite()).then_some(error);
    let deviation = standard_error.map(|error| (estimate - truth) / error);
    Table3Row { part, name, estimate, standard_error, truth, deviation, effects, paper }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::{CampaignOptions, record};

    fn recorded(robot: VirtualRobotParameters) -> Table3 {
        let folder = tempfile::tempdir().unwrap();
        let few =
            CampaignOptions { motions: 1, start_points: 1, runs: 1, robot, ..Default::default() };
        let options = CampaignOptions { rest: 300, excitation: 4, validation: 0, ..few };
        record(&Robot::lwa4p(), &options, folder.path(), &|_, _| ()).unwrap();
        table3_and_fig5(folder.path(), &|_, _| ()).unwrap().0
    }

    fn largest<'a>(rows: impl Iterator<Item = &'a Table3Row>) -> f64 {
        let deviations = rows.filter_map(|row| row.deviation.map(f64::abs));
        deviations.max_by(f64::total_cmp).unwrap()
    }

    /// Friction at rest and its slopes in the load used to bias gravity by up to 38 standard
    /// errors.
    #[test]
    fn the_truth_is_recovered_but_for_what_the_model_cannot_show() {
        let table = recorded(VirtualRobotParameters::default());
        assert_eq!(
            (table.poses, table.rows.iter().filter(|row| row.paper.is_some()).count()),
            (300, 66 + 4 + 23)
        );
        assert_eq!(table.part(Part::Gravity).count(), 10);
        let worst = largest(table.part(Part::Gravity));
        assert!(worst < 3.5, "{worst} standard errors: {:#?}", table.rows);
        // The paper's rows of gravity are known to a few per cent.
        let near = |row: &Table3Row, part: f64| (row.estimate / row.truth - 1.0).abs() < part;
        let printed = table.part(Part::Gravity).filter(|row| row.paper.is_some());
        assert_eq!(printed.filter(|row| near(row, 0.04)).count(), 4, "{:#?}", table.rows);
        // Warming and the Stribeck effect move Coulomb friction beyond its standard error.
        let worst = largest(table.part(Part::Friction));
        assert!(worst > 4.0, "{worst} standard errors");
        let offsets = table.part(Part::Friction).filter(|row| row.name.starts_with("a1 "));
        assert_eq!(offsets.filter(|row| near(row, 0.1)).count(), 6, "{:#?}", table.rows);
    }

    /// An arm with the friction of Table III, without delay: all that is left is the noise.
    #[test]
    fn an_arm_that_is_its_model_is_recovered() {
        let ideal = VirtualRobotParameters::ideal();
        let ripple = VirtualRobotParameters { ripple_ratio: 0.05, ..ideal };
        let table = recorded(ripple);
        let bodies = || table.rows.iter().filter(|row| row.part != Part::Friction);
        assert!(bodies().all(|row| row.effects.is_empty()));
        let found: Vec<f64> = bodies().filter_map(|row| row.deviation).collect();
        let size = (found.iter().map(|own| own * own).sum::<f64>() / found.len() as f64).sqrt();
        assert!(found.len() >= 45 && size < 1.5, "{size} standard errors, {:#?}", table.rows);
        assert!(largest(bodies()) < 4.0, "{:#?}", table.rows);
        assert_eq!(table.part(Part::Friction).count(), 66);
        assert!(table.part(Part::Friction).all(|row| row.effects == [Effect::Ripple]));
        // The offsets of Coulomb friction and the linear part of viscous friction.
        let large = || table.part(Part::Friction).filter(|row| row.truth.abs() > 1.5);
        assert!(large().count() >= 24, "{:#?}", table.rows);
        for row in large() {
            assert!((row.estimate / row.truth - 1.0).abs() < 0.04, "{row:?}");
        }
    }
}
