//! The question of a scenario, as every front end asks it.

use reachtube_arm::{ArmModel, OfArm, beyond_proof_of_stops};
use reachtube_conform::{CheckJob, Keep, Model, Opened, Progress, Setup};
use reachtube_files::SealedFile;
use reachtube_finding::{Finding, Report};
use reachtube_recordings::RunSource;
use reachtube_robot::Robot;
use reachtube_tracking::{Plan, TrackingModel};
use reachtube_verify::{
    Answer, Body, Capsules, Margin, Scenario, Scene, Verification, Witness, findings,
    links_without_capsule, report, verify, verify_plan,
};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use crate::error::Result;
use crate::followed::{beyond_proof_of_plans, body_of, followed, robot_of};
use crate::prepared::check_job;

/// A scenario whose model, capsules and obstacles were read.
#[derive(Debug)]
pub struct ScenarioJob {
    scenario: Scenario,
    motions: Moving,
    body: Body,
    scene: Scene,
}

/// What moves the links.
#[derive(Debug)]
enum Moving {
    /// A model of torques, over recordings.
    Recorded(Box<(Model, Setup)>),
    /// A model of the arm under its controller, over plans.
    Planned(Box<(TrackingModel, Robot)>),
}

/// The verdicts about the motions of a scenario.
#[derive(Debug)]
pub struct Verified {
    /// The model, the recordings and the reachable sets; `None` for plans.
    pub opened: Option<Opened>,
    /// How plans were read, and for what alone the verdict holds; recordings have notes of their
    /// own.
    pub notes: Vec<String>,
    /// The capsules around the links.
    pub body: Body,
    /// The obstacles.
    pub scene: Scene,
    /// The verdict about each motion.
    pub motions: Vec<Verification>,
    /// Why the verdicts say less of the robot than of the model: sets that are used for more than
    /// they were proved for, and links without a capsule.
    pub warnings: Vec<Finding>,
}

impl ScenarioJob {
    /// Reads what a scenario names, but for the recordings and plans.
    ///
    /// # Errors
    ///
    /// A model, robot or capsules that cannot be read; obstacles that are not possible; recordings
    /// or plans that the model cannot follow.
    pub fn new(scenario: Scenario) -> Result<Self> {
        if TrackingModel::is_at(&scenario.model) {
            let model = TrackingModel::open(&scenario.model)?;
            let (_, name) = scenario.planned()?;
            let robot = robot_of(&model, name)?;
            let body = body_of(&robot, name, scenario.capsules.as_deref())?;
            let scene = scenario.scene(&robot)?;
            let motions = Moving::Planned(Box::new((model, robot)));
            return Ok(Self { scenario, motions, body, scene });
        }
        let (model, setup) = reachtube_arm::open(&scenario.model)?;
        Self::with_model(scenario, model, setup)
    }

    /// Reads what a scenario names, but for the recordings, with a model of torques in memory.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn with_model(scenario: Scenario, model: Model, setup: Setup) -> Result<Self> {
        scenario.refuse_plan()?;
        let robot = Robot::from_description(&model.robot())?;
        let scene = scenario.scene(&robot)?;
        let body = Body::new(&robot, &Capsules::open(scenario.capsules.as_deref(), &robot)?);
        let motions = Moving::Recorded(Box::new((model, setup)));
        Ok(Self { scenario, motions, body, scene })
    }

    /// Reads the recordings or the plans, and decides for each motion whether the links stay clear.
    ///
    /// # Guarantee
    ///
    /// As [`verify`] and [`verify_plan`].
    ///
    /// # Errors
    ///
    /// As [`check_job`], [`CheckJob::open`], [`verify`], [`Plan::read`] and [`followed`].
    pub fn run(self, progress: &dyn Progress) -> Result<Verified> {
        let Self { scenario, motions, body, scene } = self;
        match motions {
            Moving::Planned(of) => planned(&of.0, &of.1, &scenario, (body, scene)),
            Moving::Recorded(of) => {
                let (model, setup) = *of;
                let job = check_job(model, setup, scenario.recordings()?)?;
                recorded(job, &scenario, (body, scene), progress)
            }
        }
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
        let Self { scenario, motions, body, scene } = self;
        match motions {
            Moving::Planned(of) => planned(&of.0, &of.1, &scenario, (body, scene)),
            Moving::Recorded(of) => {
                let job = CheckJob::new(of.0, of.1, source);
                recorded(job, &scenario, (body, scene), progress)
            }
        }
    }
}

fn recorded(
    job: CheckJob,
    scenario: &Scenario,
    (body, scene): (Body, Scene),
    progress: &dyn Progress,
) -> Result<Verified> {
    let job = job.suites(&scenario.suites).until(scenario.until).keep(Keep::Needed);
    let opened = job.open(progress)?;
    let Opened { model, problem, tube } = &opened;
    let input_set = |rates: &[f64]| problem.input_set_at(&tube.sets, rates);
    let rule = scenario.stop(problem.robot(), &input_set)?;
    let motions = verify(problem, tube, (&body, &scene), rule.as_ref())?;
    let mut warnings = match rule {
        Some(_) => beyond_proof_of_stops(model, problem),
        None => model.beyond_proof(problem),
    };
    warnings.extend(links_without_capsule(&body, &scene));
    Ok(Verified { opened: Some(opened), notes: vec![], body, scene, motions, warnings })
}

fn planned(
    model: &TrackingModel,
    robot: &Robot,
    scenario: &Scenario,
    (body, scene): (Body, Scene),
) -> Result<Verified> {
    let (path, _) = scenario.planned()?;
    let (plans, mut notes) = Plan::read(path, model, scenario.until)?;
    notes.extend(model.conditions());
    let decide = |plan: &Plan| {
        let at_speed = |part: f64| followed(model, &plan.slowed(part)).ok();
        Ok(verify_plan(robot, (&body, &scene), &at_speed, followed(model, plan)?)?)
    };
    let motions = plans.iter().map(decide).collect::<Result<_>>()?;
    let mut warnings = beyond_proof_of_plans(model);
    warnings.extend(links_without_capsule(&body, &scene));
    Ok(Verified { opened: None, notes, body, scene, motions, warnings })
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

    /// Returns the findings: the verdict, the warnings, and what would decide.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        let mut all = findings(&self.motions, &self.body, &self.scene);
        let second = all.len().min(1);
        all.splice(second..second, self.warnings.iter().cloned());
        all
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
    /// input, and during a stop the torque of the drives. An arm under its controller has none.
    #[must_use]
    pub fn csv(&self, found: &Witness) -> String {
        let n = self.body.joint_count();
        let names = |kind: &str| (1..=n).map(|i| format!(",{kind}{i}")).collect::<String>();
        let torques = if found.inputs.is_empty() { String::new() } else { names("tau") };
        let mut text = format!("t{}{}{torques}\n", names("q"), names("qd"));
        for (k, t) in found.times.iter().enumerate() {
            text += &t.to_string();
            let row = found.states[2 * n * k..2 * n * (k + 1)].iter();
            let inputs = found.inputs.get(n * k..n * (k + 1)).unwrap_or_default();
            row.chain(inputs).for_each(|x| text += &format!(",{x}"));
            text.push('\n');
        }
        text
    }
}
