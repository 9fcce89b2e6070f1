//! Scenarios as TOML.

use std::path::{Path, PathBuf};

use reachtube_reach::Hyperrectangle;
use reachtube_robot::Robot;
use serde::Deserialize;
use toml::Spanned;

use crate::error::{Error, Result, line_of};
use crate::scene::obstacle::Obstacle;
use crate::scene::obstacle_table::ObstacleTable;
use crate::stop::brakes::Brakes;
use crate::stop::category::Category;
use crate::stop::rule::StopRule;

/// The speed at which a person approaches, m/s (ISO 13855, walking).
pub(crate) const WALKING: f64 = 1.6;

/// Number of parts into which a step is divided, at most, where its enclosure comes too close.
const REFINE: u32 = 8;

/// A question: a model, recorded or planned motions, and what the robot must stay clear of.
#[derive(Debug)]
pub struct Scenario {
    /// The model file.
    pub model: PathBuf,
    /// The recordings whose inputs the model moves under; none if there are plans.
    pub data: Option<PathBuf>,
    /// Plans that the arm follows under its controller: a CSV file, or a folder of them.
    pub plan: Option<PathBuf>,
    /// The robot that follows plans: an embedded one, or a TOML or URDF file.
    pub robot: Option<String>,
    /// The suites to use; all if empty.
    pub suites: Vec<String>,
    /// The time after which samples are not used, s.
    pub until: Option<f64>,
    /// What `capsules` names: a TOML or URDF file; `None` for the capsules that are known for the
    /// robot.
    pub capsules: Option<PathBuf>,
    text: String,
    origin: String,
    folder: PathBuf,
    file: File,
}

/// The obstacles that a robot must stay clear of, and the effort of the proof.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The obstacles, at least one.
    pub obstacles: Vec<Obstacle>,
    /// The distance to keep, m.
    pub clearance: f64,
    /// Number of parts into which a step is divided, at most, where its enclosure comes too close.
    pub refine: u32,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    model: PathBuf,
    data: Option<PathBuf>,
    plan: Option<PathBuf>,
    robot: Option<String>,
    #[serde(default)]
    suites: Vec<String>,
    until: Option<Spanned<f64>>,
    capsules: Option<PathBuf>,
    clearance: Option<Spanned<f64>>,
    refine: Option<Spanned<u32>>,
    #[serde(default)]
    obstacle: Vec<Spanned<ObstacleTable>>,
    #[serde(default)]
    person: Vec<Spanned<ObstacleTable>>,
    stop: Option<Spanned<StopTable>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct StopTable {
    brakes: PathBuf,
    #[serde(default)]
    category: u8,
    distance: Option<f64>,
}

/// Returns the path of a robot's file from the working directory; the name of an embedded robot
/// stays.
fn in_folder(folder: &Path, name: &str) -> String {
    match Path::new(name).extension() {
        Some(_) => folder.join(name).display().to_string(),
        None => name.into(),
    }
}

impl Scenario {
    /// Reads a scenario; its paths are relative to its folder.
    ///
    /// # Errors
    ///
    /// A file that cannot be read; [`Error::Syntax`] and [`Error::Invalid`], with the line.
    pub fn open(path: &Path) -> Result<Self> {
        let text =
            reachtube_files::read_text(path, "write a scenario, as docs/verify.md describes")?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::parse(text, &path.display().to_string(), folder)
    }

    /// Reads a scenario from TOML; `origin` names the text in errors, and paths are relative to
    /// `folder`.
    ///
    /// # Errors
    ///
    /// [`Error::Syntax`].
    pub fn parse(text: String, origin: &str, folder: &Path) -> Result<Self> {
        let file: File = toml::from_str(&text)
            .map_err(|e| Error::Syntax { origin: origin.into(), message: e.to_string() })?;
        let until = file.until.as_ref().map(|until| *until.get_ref());
        let within = |path: &PathBuf| folder.join(path);
        Ok(Self {
            model: folder.join(&file.model),
            data: file.data.as_ref().map(within),
            plan: file.plan.as_ref().map(within),
            robot: file.robot.as_ref().map(|name| in_folder(folder, name)),
            suites: file.suites.clone(),
            until,
            capsules: file.capsules.as_ref().map(within),
            text,
            origin: origin.into(),
            folder: folder.into(),
            file,
        })
    }

    /// Returns the scene for a robot, whose joints name its links.
    ///
    /// # Errors
    ///
    /// [`Error::Invalid`], with the line.
    pub fn scene(&self, robot: &Robot) -> Result<Scene> {
        let File { obstacle, person, clearance, refine, until, .. } = &self.file;
        if obstacle.is_empty() && person.is_empty() {
            let remedy = "give at least one [[obstacle]] or [[person]]";
            return Err(self.invalid(0, "", "there is nothing to stay clear of", remedy));
        }
        for number in [until, clearance].into_iter().flatten() {
            if !(*number.get_ref() >= 0.0 && number.get_ref().is_finite()) {
                let (at, remedy) = (number.span().start, "give a finite number, not below 0");
                return Err(self.invalid(
                    at,
                    "",
                    &format!("{} is no number here", number.get_ref()),
                    remedy,
                ));
            }
        }
        let parts = refine.as_ref().map_or(REFINE, |refine| *refine.get_ref());
        if !(1..=4096).contains(&parts) {
            let at = refine.as_ref().map_or(0, |refine| refine.span().start);
            return Err(self.invalid(at, "", &format!("refine = {parts}"), "give 1 to 4096"));
        }
        let still = obstacle.iter().map(|table| self.obstacle(table, 0.0, robot));
        let people = person.iter().map(|table| self.obstacle(table, WALKING, robot));
        let obstacles: Vec<Obstacle> = still.chain(people).collect::<Result<_>>()?;
        for (index, table) in obstacle.iter().chain(person).enumerate() {
            if obstacles[..index].iter().any(|known| known.name == obstacles[index].name) {
                let place = format!("obstacle `{}`: ", obstacles[index].name);
                let remedy = "give each its own name";
                return Err(self.invalid(
                    table.span().start,
                    &place,
                    "the name occurs twice",
                    remedy,
                ));
            }
        }
        let clearance = clearance.as_ref().map_or(0.0, |clearance| *clearance.get_ref());
        Ok(Scene { obstacles, clearance, refine: parts })
    }

    /// Returns the recordings.
    ///
    /// # Errors
    ///
    /// [`Error::Invalid`] without any.
    pub fn recordings(&self) -> Result<&Path> {
        let remedy = "give `data = \"FOLDER\"`, the recordings that the model moves under";
        self.data.as_deref().ok_or_else(|| self.invalid(0, "", "there is no `data`", remedy))
    }

    /// Refuses a plan, and a robot to follow it, where the model is of torques and has its robot.
    ///
    /// # Errors
    ///
    /// [`Error::Invalid`].
    pub fn refuse_plan(&self) -> Result<()> {
        let remedy = "the model is of torques, and has its robot: leave them out; a plan needs a \
                      model of commanded and actual positions";
        match self.plan.is_some() || self.robot.is_some() {
            true => Err(self.invalid(0, "", "it has a `plan` or a `robot`", remedy)),
            false => Ok(()),
        }
    }

    /// Returns the plans and the robot of a scenario whose model is of an arm under its controller.
    ///
    /// # Errors
    ///
    /// [`Error::Invalid`] without one of them, and with recordings or stops.
    pub fn planned(&self) -> Result<(&Path, &str)> {
        let invalid = |problem: &str, remedy: &str| self.invalid(0, "", problem, remedy);
        let Some(plan) = &self.plan else {
            let remedy = "the model is of an arm under its controller: give `plan = \"FILE\"`, a \
                          CSV file of commanded positions, or a folder of them";
            return Err(invalid("there is no `plan`", remedy));
        };
        let Some(robot) = &self.robot else {
            let remedy = "give `robot = \"FILE\"`, the URDF or TOML file of the arm";
            return Err(invalid("there is no `robot`, whose links follow the plan", remedy));
        };
        if self.data.is_some() || !self.suites.is_empty() {
            return Err(invalid("it has `data` or `suites` beside a `plan`", "leave them out"));
        }
        if let Some(stop) = &self.file.stop {
            let remedy = "stops need a model of torques; leave [stop] out";
            return Err(self.invalid(
                stop.span().start,
                "stop: ",
                "the model has no torques",
                remedy,
            ));
        }
        Ok((plan, robot))
    }

    /// Returns the stops of the scenario, with their brakes; `None` if it has none. The torque of
    /// the drives may be off by any vector of the set that `input_set` returns for decelerations.
    ///
    /// # Errors
    ///
    /// A file that cannot be read; [`Error::Syntax`] and [`Error::Invalid`], with the line.
    pub fn stop(
        &self,
        robot: &Robot,
        input_set: &dyn Fn(&[f64]) -> Hyperrectangle,
    ) -> Result<Option<StopRule>> {
        let Some(table) = &self.file.stop else { return Ok(None) };
        let at = table.span().start;
        let invalid = |problem: &str, remedy: &str| self.invalid(at, "stop: ", problem, remedy);
        let StopTable { brakes, category, distance } = table.get_ref();
        let path = self.folder.join(brakes);
        let remedy = "write the brakes, as docs/verify.md describes";
        let text = reachtube_files::read_text(&path, remedy)?;
        let brakes = Brakes::from_toml(&text, &path.display().to_string(), robot)?;
        let category = match category {
            0 => Category::Zero,
            1 => Category::one(&brakes, input_set).ok_or_else(|| {
                let problem = "the brakes' file has no deceleration";
                invalid(problem, "add `deceleration = [...]`, in rad/s² for each joint")
            })?,
            other => return Err(invalid(&format!("category = {other}"), "give 0 or 1")),
        };
        if let Some(wrong) = distance.filter(|distance| !(*distance > 0.0 && distance.is_finite()))
        {
            return Err(invalid(&format!("distance = {wrong}"), "give a number above 0, in m"));
        }
        Ok(Some(StopRule { brakes, category, distance: *distance }))
    }

    fn obstacle(
        &self,
        table: &Spanned<ObstacleTable>,
        speed: f64,
        robot: &Robot,
    ) -> Result<Obstacle> {
        let (at, table) = (table.span().start, table.get_ref());
        let place = format!("obstacle `{}`: ", table.name);
        let invalid = |problem: &str, remedy: &str| self.invalid(at, &place, problem, remedy);
        let solid = table.solid(&self.folder);
        let solid = solid.map_err(|(problem, remedy)| invalid(&problem, remedy))?;
        let speed = table.speed.unwrap_or(speed);
        if !(speed >= 0.0 && speed.is_finite()) {
            return Err(invalid(
                &format!("speed = {speed}"),
                "give a finite number of m/s, not below 0",
            ));
        }
        let joint = |name: &String| {
            let found = robot.joints().iter().position(|joint| joint.name == *name);
            found.ok_or_else(|| {
                let names: Vec<_> =
                    robot.joints().iter().map(|j| format!("`{}`", j.name)).collect();
                let remedy =
                    format!("a link is named by the joint that moves it: {}", names.join(", "));
                invalid(&format!("no joint is named `{name}`"), &remedy)
            })
        };
        if table.links.as_ref().is_some_and(Vec::is_empty) {
            return Err(invalid("links = []", "name links, or omit the line for all links"));
        }
        let joints = table.links.as_ref().map(|links| links.iter().map(joint).collect());
        Ok(Obstacle { name: table.name.clone(), solid, speed, joints: joints.transpose()? })
    }

    fn invalid(&self, at: usize, place: &str, problem: &str, remedy: &str) -> Error {
        Error::Invalid {
            origin: self.origin.clone(),
            line: line_of(&self.text, at),
            place: place.into(),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }
}
