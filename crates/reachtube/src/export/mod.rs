//! Models and robots as other tools read them.
//!
//! [`ExportCase::all`] takes a model over recorded inputs, and [`files`] writes one case for a
//! [`Tool`]. The first lines of each file say what the tool computes from it and where this differs
//! from the model. [`robot::mjcf_files`] and [`robot::urdf_files`] write a robot for simulators,
//! and [`shield::Shield`] what the safety shield SaRA reads. `docs/export.md` has a table of
//! models, tools and their meaning.
//!
//! # Examples
//!
//! ```
//! use reachtube::arm::{ArmSettings, setup};
//! use reachtube::conform::{Tube, Settings, UncertaintySets};
//! use reachtube::export::{ExportCase, InputForm, Tool, files};
//! use reachtube::{
//!     Hyperrectangle, Keep, MemoryRuns, Problem, Robot, Run, Silent, Torque,
//! };
//!
//! let states = [0.0; 12].repeat(3);
//! let run = Run::new(6, vec![0.0, 0.004, 0.008], states, vec![0.0; 18])?;
//! let mut runs = MemoryRuns::default();
//! runs.push("rest", Some("A"), None, run);
//! let arm = ArmSettings::new(Torque::Compensated, 6);
//! let setup = setup(Robot::lwa4p(), arm, Settings::default())?;
//! let problem = Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent)?;
//! let box_of = |n, radius| Hyperrectangle { centre: vec![0.0; n], radius: vec![radius; n] };
//! let (initial_set, input_set) = (box_of(12, 1e-3), box_of(6, 0.5));
//! let sets = UncertaintySets { initial_set, input_set, noise_set: None };
//! let tube = Tube::new(&problem, sets)?;
//! let cases = ExportCase::all(&problem, &tube)?;
//! let written = files(&cases[0], Tool::HyLaa, InputForm::Deviation)?;
//! assert!(written.iter().any(|file| file.name == "hylaa_reach.py"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod case;
mod cora;
mod draws;
pub(crate) mod error;
mod file;
mod flowstar;
mod hylaa;
mod juliareach;
mod meaning;
mod moveit;
pub mod robot;
pub mod shield;
mod spaceex;
mod system;
mod tables;
mod text;
mod tool;

pub use case::{ExportCase, InitialState, bounds};
pub use error::ExportError;
pub use file::ExportFile;
pub use meaning::Meaning;
pub use moveit::{LinkPadding, Paddings};
pub use system::{Factor, Polynomial, System, Term};
pub use tool::{InputForm, Tool};

impl Tool {
    /// Returns the form of the input that [`files`] takes without a wish: the tightest that the
    /// tool can mean.
    #[must_use]
    pub fn default_form(self, case: &ExportCase) -> InputForm {
        match self {
            Self::Cora => InputForm::Recorded,
            _ if case.system.linear.is_some() => InputForm::Deviation,
            Self::FlowStar | Self::SpaceEx => InputForm::Recorded,
            Self::HyLaa | Self::XSpeed | Self::JuliaReach => InputForm::Range,
        }
    }

    /// Checks that the tool can mean the case with its input in this form.
    ///
    /// # Errors
    ///
    /// [`ExportError`], which names the tool and what to do.
    pub fn check(self, case: &ExportCase, form: InputForm) -> Result<(), ExportError> {
        let (affine, model) = (case.system.linear.is_some(), || case.model.clone());
        if !affine && matches!(self, Self::HyLaa | Self::XSpeed) {
            let degree = case.system.degree();
            return Err(ExportError::NotAffine { tool: self, model: model(), degree });
        }
        if !affine && self == Self::JuliaReach {
            return Err(ExportError::NoDisturbance { tool: self, model: model() });
        }
        if !affine && form == InputForm::Deviation {
            let remedy = self.default_form(case);
            return Err(ExportError::DeviationOfPolynomial { model: model(), remedy });
        }
        if form == InputForm::Recorded {
            match self {
                Self::HyLaa | Self::XSpeed | Self::JuliaReach => {
                    let remedy = self.default_form(case);
                    return Err(ExportError::RecordedInput { tool: self, remedy });
                }
                Self::Cora => {
                    case.fixed_step(self, "flowstar, or to cora with --input deviation or range")?;
                }
                Self::FlowStar | Self::SpaceEx => {}
            }
        }
        if self == Self::HyLaa {
            case.fixed_step(self, "cora, spaceex or juliareach")?;
        }
        Ok(())
    }
}

/// Writes a case for a tool: the tool's own files, and beside them our bounds at samples
/// (`bounds.csv`) and between them (`tube.csv`), and the recorded input (`inputs.csv`).
///
/// # Errors
///
/// As [`Tool::check`].
pub fn files(
    case: &ExportCase,
    tool: Tool,
    form: InputForm,
) -> Result<Vec<ExportFile>, ExportError> {
    tool.check(case, form)?;
    let mut files = match tool {
        Tool::Cora => cora::files(case, form),
        Tool::SpaceEx | Tool::XSpeed => spaceex::files(case, tool, form),
        Tool::FlowStar => flowstar::files(case, form),
        Tool::HyLaa => hylaa::files(case, form),
        Tool::JuliaReach => juliareach::files(case, form),
    };
    files.extend(tables::files(case));
    Ok(files)
}
