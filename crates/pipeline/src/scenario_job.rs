//! The question of a scenario, as every front end asks it.

use reachtube_arm::{ArmModel, OfArm, beyond_proof_of_stops};
use reachtube_conform::{CheckJob, Keep, Model, Opened, Progress, Setup};
use reachtube_finding::{Finding, Report};
use reachtube_recordings::RunSource;
use reachtube_robot::Robot;
use reachtube_verify::{
    Answer, Body, Capsules, Margin, Scenario, Scene, Verification, Witness, findings,
    links_without_capsule, report, verify,
};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use crate::error::Result;
use crate::prepared::check_job;

/// A scenario whose model, capsules and obstacles were read.
#[derive(Debug)]
pub struct ScenarioJob {
    scenario: Scenario,
    model: Model,
    setup: Setup,
    body: Body,
    scene: Scene,
}

/// The verdicts about the motions of a scenario.
#[derive(Debug)]
pub struct Verified {
    /// The model, the recordings and the reachable sets.
    pub opened: Opened,
    /// The capsules around the links.
    pub body: Body,
    /// The obstacles.
    pub scene: Scene,
    /// The verdict about each motion.
    pub motions: Vec<Verification>,
}

impl ScenarioJob {
    /// Reads what a scenario names, but for the recordings.
    ///
    /// # Errors
    ///
    /// A model, robot or capsules that cannot be read; obstacles that are not possible.
    pub fn new(scenario: Scenario) -> Result<Self> {
        let (model, setup) = reachtube_arm::open(&scenario.model)?;
        Self::with_model(scenario, model, setup)
    }

    /// Reads what a scenario names, but for the recordings, with a model in memory.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn with_model(scenario: Scenario, model: Model, setup: Setup) -> Result<Self> {
        let robot = Robot::from_description(&model.robot())?;
        let scene = scenario.scene(&robot)?;
        let body = Body::new(&robot, &Capsules::open(scenario.capsules.as_deref(), &robot)?);
        Ok(Self { scenario, model, setup, body, scene })
    }

    /// Reads the recordings, and decides for each motion whether the links stay clear.
    ///
    /// # Guarantee
    ///
    /// As [`verify`].
    ///
    /// # Errors
    ///
    /// As [`check_job`], [`CheckJob::open`] and [`verify`].
    pub fn run(self, progress: &dyn Progress) -> Result<Verified> {
        let Self { scenario, model, setup, body, scene } = self;
        let job = check_job(model, setup, &scenario.data)?;
        verified(job, &scenario, (body, scene), progress)
    }

    /// Decides as [`run`](Self::run) does over recordings that were opened, or prepared, already.
    ///
    /// # Guarantee
    ///
    /// As [`verify`].
    ///
    /// # Errors
    ///
    /// As [`CheckJob::open`] and [`verify`].
    pub fn run_over(
        self,
        source: impl RunSource + 'static,
        progress: &dyn Progress,
    ) -> Result<Verified> {
        let Self { scenario, model, setup, body, scene } = self;
        verified(CheckJob::new(model, setup, source), &scenario, (body, scene), progress)
    }
}

fn verified(
    job: CheckJob,
    scenario: &Scenario,
    (body, scene): (Body, Scene),
    progress: &dyn Progress,
) -> Result<Verified> {
    let job = job.suites(&scenario.suites).until(scenario.until).keep(Keep::Needed);
    let opened = job.open(progress)?;
    let robot = opened.problem.robot();
    let input_set = |rates: &[f64]| opened.problem.input_set_at(&opened.tube.sets, rates);
    let rule = scenario.stop(robot, &input_set)?;
    let motions = verify(&opened.problem, &opened.tube, (&body, &scene), rule.as_ref())?;
    Ok(Verified { opened, body, scene, motions })
}

/// The answer of `verify` as JSON.
#[derive(Serialize, JsonSchema)]
pub struct VerifyOutput<'a> {
    /// The worst answer of all motions.
    answer: Answer,
    /// The verdict about each motion.
    motions: Vec<MotionOutput<'a>>,
    /// What the answer says, statement by statement: the verdict first.
    findings: Vec<Finding>,
}

/// The verdict about a motion.
#[derive(Serialize, JsonSchema)]
struct MotionOutput<'a> {
    /// The verdict.
    #[serde(flatten)]
    verification: &'a Verification,
    /// How far each link can be from its nominal motion.
    margins: Vec<MarginOutput>,
}

/// How far a link can be from its nominal motion.
#[derive(Serialize, JsonSchema)]
struct MarginOutput {
    /// The joint that moves the link.
    link: String,
    /// The distance, m, rounded up; null without a bound.
    #[schemars(with = "Option<f64>")]
    margin: f64,
    /// Start of the step in which it is the largest, s.
    time: f64,
}

impl Verified {
    /// Returns the worst answer.
    #[must_use]
    pub fn answer(&self) -> Answer {
        self.motions.iter().map(|one| one.answer).max().unwrap_or(Answer::Undecided)
    }

    /// Returns the findings: the verdict, [`warnings`](Self::warnings), and what would decide.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        let mut all = findings(&self.motions, &self.body, &self.scene);
        all.splice(all.len().min(1)..all.len().min(1), self.warnings());
        all
    }

    /// Returns why the verdicts say less of the robot than of the model: sets that are used for
    /// more than they were proved for, and links without a capsule.
    #[must_use]
    pub fn warnings(&self) -> Vec<Finding> {
        let Opened { model, problem, .. } = &self.opened;
        let mut warnings = match self.motions.iter().any(|one| one.stops.is_some()) {
            true => beyond_proof_of_stops(model, problem),
            false => model.beyond_proof(problem),
        };
        warnings.extend(links_without_capsule(&self.body, &self.scene));
        warnings
    }

    /// Returns the answer as a report.
    #[must_use]
    pub fn report(&self) -> Report {
        report(&self.motions, &self.body, &self.scene)
    }

    /// Returns the answer as JSON.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let margin = |margin: &Margin| MarginOutput {
            link: self.body.joint_name(margin.joint).into(),
            margin: margin.distance,
            time: margin.time,
        };
        let motion = |verification| MotionOutput {
            verification,
            margins: verification.margins.iter().map(margin).collect(),
        };
        let motions = self.motions.iter().map(motion).collect();
        let output = VerifyOutput { answer: self.answer(), motions, findings: self.findings() };
        serde_json::to_value(output).expect("an answer has string keys")
    }

    /// Returns a simulated motion as CSV, `t,q1,..,qd1,..,tau1,..`, whose torque is the model's
    /// input, and during a stop the torque of the drives.
    #[must_use]
    pub fn csv(&self, found: &Witness) -> String {
        let n = self.body.joint_count();
        let names = |kind: &str| (1..=n).map(|i| format!(",{kind}{i}")).collect::<String>();
        let mut text = format!("t{}{}{}\n", names("q"), names("qd"), names("tau"));
        for (k, t) in found.times.iter().enumerate() {
            text += &t.to_string();
            let row = found.states[2 * n * k..2 * n * (k + 1)].iter();
            row.chain(&found.inputs[n * k..n * (k + 1)]).for_each(|x| text += &format!(",{x}"));
            text.push('\n');
        }
        text
    }
}
