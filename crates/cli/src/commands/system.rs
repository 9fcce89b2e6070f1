//! `reachtube conform`, `check` and `reach` of a system that is no robot.

use std::path::{Path, PathBuf};

use reachtube::finding::Table;
use reachtube::number::significant;
use reachtube::systems::{MadeSystem, OutputSystem, OutputTube, SystemModel};
use reachtube::write;
use reachtube_files::SealedFile;
use schemars::JsonSchema;
use serde::Serialize;

use crate::data_arguments::{DataArguments, ModelArguments};
use crate::error::{Error, Result};
use crate::file_names;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;

/// Options do not fit a system.
pub(crate) const NO_ROBOT: &str = "a system has no torques, suites, notions and gaps; leave \
                                   --torque, --suites, --notion and --max-gap out";

/// What `conform --json` prints of a system.
#[derive(Serialize, JsonSchema)]
pub(crate) struct SystemOutput<'a> {
    /// Whether the sets are proved, and narrower than those without a model.
    useful: bool,
    /// The answer.
    #[serde(flatten)]
    made: &'a MadeSystem,
}

/// What `reach --json` prints of a system.
#[derive(Serialize, JsonSchema)]
pub(crate) struct TubesOutput {
    /// One entry for each recording.
    tubes: Vec<TubeOutput>,
}

/// The reachable outputs along a recording.
#[derive(Serialize, JsonSchema)]
struct TubeOutput {
    /// The recording.
    run: String,
    /// The number of samples.
    samples: usize,
    /// Time of the last sample, s.
    duration: f64,
    /// Widths of the outputs at the last sample.
    final_width: Vec<f64>,
    /// The file with the bounds at samples.
    csv: String,
}

/// Finds the smallest sets of a system.
pub(crate) fn conform(
    system: &Path,
    data: &DataArguments,
    out: Option<&Path>,
    json: bool,
) -> Result<Outcome> {
    refuse_options(data)?;
    out.map(output::claim).transpose()?;
    let system = OutputSystem::open(system)?;
    let runs = system.read(&data.data, data.until)?;
    let bar = Progress::of("finding sets");
    let made = system.conform(&runs)?;
    drop(bar);
    if let Some(path) = out {
        write::atomically(path, |file| file.write_all(made.model.to_json().as_bytes()))?;
    }
    let outcome = match (made.model.verified, made.is_useful()) {
        (false, _) => Outcome::NotConformant,
        (true, true) => Outcome::Done,
        (true, false) => Outcome::Vacuous,
    };
    if json {
        out.into_iter().for_each(output::wrote);
        output::print_json(&SystemOutput { useful: made.is_useful(), made: &made })?;
        return Ok(outcome);
    }
    let mut summary = made.summary();
    summary.next = Some(match out {
        Some(path) => {
            summary.fact("wrote", path.display().to_string());
            format!("`reachtube check --model {} --data OTHERS` tries it", path.display())
        }
        None => "`--out FILE` keeps the model".into(),
    });
    output::print_verdict(&summary.to_string(), &outcome)?;
    Ok(outcome)
}

/// Compares recordings with the model of a system.
pub(crate) fn check(args: &ModelArguments, json: bool) -> Result<Outcome> {
    refuse_options(&args.data)?;
    let model = SystemModel::open(&args.model)?;
    let runs = model.system()?.read(&args.data.data, args.data.until)?;
    let check = model.check(&runs)?;
    let outcome = match check.conformant {
        false => Outcome::NotConformant,
        true if model.is_useful() => Outcome::Done,
        true => Outcome::Vacuous,
    };
    match json {
        true => output::print_json(&check)?,
        false => output::print_verdict(&check.summary().to_string(), &outcome)?,
    }
    Ok(outcome)
}

/// Computes the reachable outputs of a system: of a model, or of a description whose sets are all
/// given; along recordings, or else from the start of the description on.
pub(crate) fn reach(
    system: Option<&Path>,
    args: &ModelArguments,
    (step, out): (Option<f64>, &Path),
    json: bool,
) -> Result<Outcome> {
    refuse_options(&args.data)?;
    let model = match system {
        Some(path) => SystemModel::given(&OutputSystem::open(path)?)?,
        None => SystemModel::open(&args.model)?,
    };
    let (data, until) = (&args.data.data, args.data.until);
    let tubes = match (system.is_some() && data == Path::new("-"), until) {
        (true, Some(until)) => vec![model.reach_until(until, step)?],
        (true, None) => {
            return Err(Error::setting(
                "without recordings, give the end of the motion: --until 5",
            ));
        }
        (false, _) => model.reach(&model.system()?.read(data, until)?)?,
    };
    let names = file_names::of_runs(tubes.iter().map(|tube| stem(&tube.run)));
    let files: Vec<PathBuf> = names.iter().map(|name| out.join(format!("{name}.csv"))).collect();
    output::claim_all(files.iter())?;
    for (tube, file) in tubes.iter().zip(&files) {
        let text = tube.to_csv(&model);
        write::atomically(file, |out| out.write_all(text.as_bytes()))?;
    }
    let listed: Vec<TubeOutput> =
        tubes.iter().zip(&files).map(|(tube, file)| TubeOutput::new(tube, &model, file)).collect();
    if json {
        output::print_json(&TubesOutput { tubes: listed })?;
        return Ok(Outcome::Done);
    }
    let outputs = model.system.outputs.iter().map(|of| format!("width of {}", of.name()));
    let first = ["recording", "samples"].map(String::from).into_iter();
    let header = first.chain(outputs).chain(["file".into()]);
    let row = |tube: &TubeOutput| {
        let widths = tube.final_width.iter().map(|width| significant(*width, 4));
        let first = [tube.run.clone(), tube.samples.to_string()];
        first.into_iter().chain(widths).chain([tube.csv.clone()]).collect()
    };
    let table = Table::new(header, listed.iter().map(row).collect());
    output::print(&format!("reachable outputs, with their widths at the last sample\n{table}"))?;
    Ok(Outcome::Done)
}

impl TubeOutput {
    fn new(tube: &OutputTube, model: &SystemModel, file: &Path) -> Self {
        let p = model.system.outputs.len();
        let last = tube.nominal.len() - p;
        Self {
            run: tube.run.clone(),
            samples: tube.times.len(),
            duration: tube.times.last().copied().unwrap_or_default(),
            final_width: (last..last + p)
                .map(|at| tube.bounds[1][at] - tube.bounds[0][at])
                .collect(),
            csv: file.display().to_string(),
        }
    }
}

fn stem(run: &str) -> String {
    let (file, number) = run.split_once(", run ").unwrap_or((run, ""));
    let stem = Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
    if number.is_empty() { stem.into_owned() } else { format!("{stem}_{number}") }
}

fn refuse_options(data: &DataArguments) -> Result<()> {
    match data.torque.is_some() || data.max_gap.is_some() || !data.suites.is_empty() {
        true => Err(Error::setting(NO_ROBOT)),
        false => Ok(()),
    }
}
