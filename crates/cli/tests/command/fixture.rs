//! A small data set of a 2-joint arm, and the command run on it.
//!
//! The links weigh nothing, so that each joint is m q̈ = u - v q̇ exactly, and its motion under a
//! held input has a closed form.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// Samples of each run.
pub(crate) const SAMPLES: usize = 51;

/// Time between samples, s.
pub(crate) const STEP: f64 = 0.01;

const INERTIA: [f64; 2] = [1.0, 0.5];
const DAMPING: [f64; 2] = [2.0, 1.0];

/// Radius of the first positions about their mean, rad.
pub(crate) const START: f64 = 0.002;

/// Radius of the disturbance torque, N m.
pub(crate) const TORQUE: f64 = 0.1;

/// Returns the description of the robot that generated the recordings.
pub(crate) fn robot_toml() -> String {
    let joint = |j: usize| {
        format!(
            "[[joint]]\nname = \"axis{}\"\nplacement = {{ translation = [0.0, 0.0, 0.5] }}\n\
             armature = {}\nvelocity_limit = 3.0\nfriction = {{ viscous = [{}, 0.0, 0.0] }}\n",
            j + 1,
            INERTIA[j],
            DAMPING[j]
        )
    };
    format!(
        "schema_version = 1\nname = \"two axes\"\nparameters = \"base\"\n\n{}\n{}",
        joint(0),
        joint(1)
    )
}

/// A folder with `arm.toml`, and with the suites A and B of three runs each in `data`. Each suite
/// is a motion of its own.
pub(crate) struct Lab {
    folder: TempDir,
}

impl Lab {
    pub(crate) fn new() -> Self {
        let lab = Self { folder: tempfile::tempdir().unwrap() };
        std::fs::create_dir(lab.path("data")).unwrap();
        lab.write("arm.toml", robot_toml());
        let mut index = String::from("file,suite,motion\n");
        for (suite, frequency) in [("A", 4.0), ("B", 9.0)] {
            for run in 1..=3 {
                lab.write(
                    &format!("data/{suite}_{run}.csv"),
                    recording(frequency, run as f64 - 2.0),
                );
                index += &format!("{suite}_{run}.csv,{suite},motion {suite}\n");
            }
        }
        lab.write("data/runs.csv", &index);
        lab
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    pub(crate) fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), text).unwrap();
    }

    /// Changes the lines of a file.
    pub(crate) fn edit(&self, name: &str, change: impl FnOnce(&mut Vec<String>)) {
        let mut lines: Vec<String> = self.read(name).lines().map(String::from).collect();
        change(&mut lines);
        self.write(name, lines.join("\n") + "\n");
    }

    /// Returns the names in a folder, sorted.
    pub(crate) fn names(&self, folder: &str) -> Vec<String> {
        let entries = std::fs::read_dir(self.path(folder)).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    pub(crate) fn command(&self, arguments: &str) -> Command {
        command_in(self.folder.path(), arguments)
    }

    pub(crate) fn run(&self, arguments: &str) -> Run {
        Run::of(self.command(arguments).output().unwrap())
    }

    /// Runs `conform` with the required options and `more`.
    pub(crate) fn conform(&self, more: &str) -> Run {
        self.run(&format!("conform --robot arm.toml --data data --torque compensated {more}"))
    }

    /// Runs `check` of model.json.
    pub(crate) fn check(&self, more: &str) -> Run {
        self.run(&format!("check --model model.json --data data --torque compensated {more}"))
    }
}

/// Returns the command in a folder, with arguments separated by spaces.
pub(crate) fn command_in(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_reachtube"));
    command.current_dir(folder).args(arguments.split_whitespace());
    command
}

/// The result of a run of the command.
#[derive(Debug)]
pub(crate) struct Run {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

/// Returns the file of a model whose content was changed, with the SHA-256 of the new content.
pub(crate) fn sealed(model: serde_json::Value) -> String {
    serde_json::from_value::<reachtube::Model>(model).unwrap().to_json()
}

impl Run {
    pub(crate) fn of(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Self {
            code: output.status.code().unwrap(),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }

    /// Asserts the exit code.
    #[track_caller]
    pub(crate) fn exits(self, code: i32) -> Self {
        assert_eq!(self.code, code, "{self:#?}");
        self
    }

    /// Asserts an error: exit code 2, nothing on standard output, and each of `parts` in the text.
    #[track_caller]
    pub(crate) fn fails_with(self, parts: &[&str]) -> Self {
        assert_eq!((self.code, self.stdout.as_str()), (2, ""), "{self:#?}");
        assert!(self.stderr.lines().all(|line| line.starts_with("error: ")), "{}", self.stderr);
        parts.iter().for_each(|part| {
            assert!(self.stderr.contains(part), "{part:?} is not in\n{}", self.stderr)
        });
        self
    }

    /// Asserts an error after a result: exit code 2, and each of `parts` in the lines of the error.
    #[track_caller]
    pub(crate) fn fails_after_result(mut self, parts: &[&str]) -> Self {
        assert!(!self.stdout.is_empty(), "{self:#?}");
        self.stdout.clear();
        self.fails_with_last(parts)
    }

    /// Asserts an error in JSON: exit code 2, nothing on standard output, and an object of this
    /// kind, with each of `parts` in its message, as the last line of standard error.
    #[track_caller]
    pub(crate) fn fails_in_json(self, kind: &str, parts: &[&str]) -> Self {
        assert_eq!((self.code, self.stdout.as_str()), (2, ""), "{self:#?}");
        let error: Value = serde_json::from_str(self.stderr.lines().last().unwrap()).unwrap();
        assert_eq!((&error["kind"], &error["exit_code"]), (&kind.into(), &2.into()), "{error}");
        let message = error["error"].as_str().unwrap();
        parts.iter().for_each(|part| assert!(message.contains(part), "{part:?} is not in {error}"));
        self
    }

    /// Asserts an error as [`fails_with`](Self::fails_with) does, after notes.
    #[track_caller]
    pub(crate) fn fails_with_last(mut self, parts: &[&str]) -> Self {
        self.stderr = self
            .stderr
            .lines()
            .filter(|line| !line.starts_with("note: "))
            .collect::<Vec<_>>()
            .join("\n");
        self.fails_with(parts)
    }

    /// Asserts that a note on standard error contains `part`.
    #[track_caller]
    pub(crate) fn notes(self, part: &str) -> Self {
        assert!(
            self.stderr.lines().any(|line| line.starts_with("note: ") && line.contains(part)),
            "{}",
            self.stderr
        );
        self
    }

    #[track_caller]
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.stdout)
            .unwrap_or_else(|error| panic!("{error}: {}", self.stdout))
    }
}

/// Returns a recording whose start and input deviate by `deviation` (-1, 0, 1) radii.
fn recording(frequency: f64, deviation: f64) -> String {
    let mut text = String::from("t,q1,q2,qd1,qd2,tau1,tau2\n");
    let (mut q, mut qd) = ([0.1, -0.2].map(|q| q + deviation * START), [0.0; 2]);
    for k in 0..SAMPLES {
        let t = k as f64 * STEP;
        let u = [3.0, -2.0].map(|torque| torque * (frequency * t).cos());
        text += &format!(
            "{t:.3},{:?},{:?},{:?},{:?},{:?},{:?}\n",
            q[0], q[1], qd[0], qd[1], u[0], u[1]
        );
        for j in 0..2 {
            (q[j], qd[j]) = step(j, q[j], qd[j], u[j] + deviation * TORQUE);
        }
    }
    text
}

/// Returns the state after one step under the torque `u`, in closed form.
fn step(j: usize, q: f64, qd: f64, u: f64) -> (f64, f64) {
    let (steady, rate) = (u / DAMPING[j], DAMPING[j] / INERTIA[j]);
    let left = (-rate * STEP).exp();
    (q + steady * STEP + (qd - steady) * (1.0 - left) / rate, steady + (qd - steady) * left)
}

/// Replaces a cell of a CSV line.
pub(crate) fn set_cell(line: &mut String, column: usize, value: &str) {
    let mut cells: Vec<&str> = line.split(',').collect();
    cells[column] = value;
    *line = cells.join(",");
}

/// Returns a cell of a CSV line as a number.
pub(crate) fn cell(line: &str, column: usize) -> f64 {
    line.split(',').nth(column).unwrap().parse().unwrap()
}

/// Returns the text of a page without its tags.
pub(crate) fn text_of(page: &str) -> String {
    page.split('<').map(|part| part.split_once('>').map_or(part, |(_, text)| text)).collect()
}
