use std::collections::BTreeSet;
use std::path::Path;

use exmex::Express;
use nalgebra::{DMatrix, DVector};
use reachtube_files::read_text;
use reachtube_reach::{LinearSystem, Propagation, PropagationStep, TimeGrid, step};
use reachtube_scalar::Interval;

use crate::description::{
    BoxCentre, MatrixEntry, MatrixRows, NamedSignal, NominalStartRule, SetDescription, SimpleSet,
    SystemDescription, SystemKind, SystemParameter,
};
use crate::error::{Error, Result};
use crate::form::GeneratorForm;

/// Names that formulas have for constants.
const CONSTANTS: [&str; 6] = ["e", "E", "PI", "π", "TAU", "τ"];

/// A linear system that is seen through its outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputSystem {
    /// What it was made of.
    pub(crate) description: SystemDescription,
    pub(crate) a: DMatrix<f64>,
    pub(crate) b: DMatrix<f64>,
    pub(crate) e: DMatrix<f64>,
    pub(crate) c: DMatrix<f64>,
    pub(crate) d: DMatrix<f64>,
    pub(crate) f: DMatrix<f64>,
    /// X0, W and V.
    pub(crate) forms: [GeneratorForm; 3],
    /// The delay of each input, s.
    pub(crate) delays: Vec<f64>,
}

impl OutputSystem {
    /// Opens a description in TOML.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, and [`Error::System`] with line and column.
    pub fn open(path: &Path) -> Result<Self> {
        let text = read_text(path, "name a TOML file with a system")?;
        let of_file = |problem: String| Error::System { file: Some(path.into()), problem };
        let description =
            toml::from_str(&text).map_err(|error| of_file(error.to_string().trim_end().into()))?;
        Self::new(description).map_err(|error| match error {
            Error::System { problem, .. } => of_file(problem),
            other => other,
        })
    }

    /// Makes the system of a description.
    ///
    /// # Errors
    ///
    /// [`Error::System`] where its parts do not fit together.
    pub fn new(description: SystemDescription) -> Result<Self> {
        Self::of_parts(description).map_err(|problem| Error::System { file: None, problem })
    }

    fn of_parts(description: SystemDescription) -> Result<Self, String> {
        let SystemDescription { kind, step, states, inputs, outputs, .. } = &description;
        if *kind != SystemKind::Continuous && !step.is_some_and(|h| h > 0.0 && h.is_finite()) {
            return Err("a discrete system needs its step, a time above 0 s: step = 0.4".into());
        }
        if *kind == SystemKind::Continuous && step.is_some() {
            return Err("a continuous system has no step; leave it out".into());
        }
        if outputs.is_empty() {
            return Err("the system has no outputs; name the columns that are compared".into());
        }
        let names = states.iter().chain(inputs).map(NamedSignal::name);
        refuse_twice(names)?;
        refuse_twice(outputs.iter().map(NamedSignal::name))?;
        if *kind == SystemKind::Arx {
            return Self::to_identify(description);
        }
        let [n, m, p] = [states.len(), inputs.len(), outputs.len()];
        if n == 0 {
            return Err("the system has no states; name them: states = [\"x\"]".into());
        }
        check_parameters(&description)?;
        let of = |name: &str, given: &Option<MatrixRows>, rows: usize, columns: Option<usize>| {
            let given = given.as_ref().map(|given| evaluated(name, given, &description));
            given.transpose()?.map(|given| matrix(name, &given, rows, columns)).transpose()
        };
        let needed = |name: &str, given: &Option<MatrixRows>, [rows, columns]: [usize; 2]| {
            of(name, given, rows, Some(columns))
        };
        let a = needed("A", &description.a, [n, n])?.ok_or("A is missing")?;
        let b = needed("B", &description.b, [n, m])?;
        let e = of("E", &description.e, n, None)?;
        let e = e.or_else(|| b.clone().filter(|_| m > 0)).unwrap_or(DMatrix::identity(n, n));
        let c = match needed("C", &description.c, [p, n])? {
            Some(c) => c,
            None => selected(states, outputs)?,
        };
        let d = needed("D", &description.d, [p, m])?.unwrap_or(DMatrix::zeros(p, m));
        let f = of("F", &description.f, p, None)?;
        let f = f.unwrap_or(DMatrix::identity(p, p));
        let set = |given: &Option<SetDescription>, default: SimpleSet, dimension, name| {
            let default = SetDescription::Simple(default);
            GeneratorForm::new(given.as_ref().unwrap_or(&default), dimension, name)
        };
        let sets = &description.sets;
        let mut forms = [
            set(&sets.start, SimpleSet::Box, n, "X0")?,
            set(&sets.disturbance, SimpleSet::Box, e.ncols(), "W")?,
            set(&sets.noise, SimpleSet::None, f.ncols(), "V")?,
        ];
        if sets.centre == BoxCentre::Zero {
            forms.iter_mut().for_each(|form| form.is_box = false);
        }
        forms[2].is_box = false;
        let delays = delays(&description)?;
        check_lists(&description)?;
        let b = b.unwrap_or(DMatrix::zeros(n, m));
        Ok(Self { a, b, e, c, d, f, forms, delays, description })
    }

    /// Returns a system whose factors are not known yet.
    fn to_identify(description: SystemDescription) -> Result<Self, String> {
        let SystemDescription { a, b, c, d, e, f, states, delay, start, sets, .. } = &description;
        let has_matrix = [a, b, c, d, e, f].iter().any(|given| given.is_some());
        if has_matrix
            || !description.parameters.is_empty()
            || !states.is_empty()
            || !delay.is_empty()
            || start.is_some()
        {
            let words = "an arx system has a step, inputs and outputs; its matrices, states, delay \
                         and start are found: leave them out";
            return Err(words.into());
        }
        if sets.start.is_some() || sets.disturbance.is_some() {
            return Err("X0 and W of an arx system are found; leave them out".into());
        }
        let none = || DMatrix::zeros(0, 0);
        let form = || GeneratorForm::new(&SetDescription::Simple(SimpleSet::None), 0, "");
        let forms = [form()?, form()?, form()?];
        check_lists(&description)?;
        let [a, b, e, c, d, f] = [none(), none(), none(), none(), none(), none()];
        Ok(Self { a, b, e, c, d, f, forms, delays: vec![], description })
    }

    /// Returns what it was made of.
    #[must_use]
    pub fn description(&self) -> &SystemDescription {
        &self.description
    }

    /// Returns the names of the states, the inputs or the outputs.
    pub(crate) fn names(signals: &[NamedSignal]) -> Vec<String> {
        signals.iter().map(|signal| signal.name().into()).collect()
    }

    /// Returns the number of outputs p.
    pub(crate) fn outputs(&self) -> usize {
        self.description.outputs.len()
    }

    /// Returns, for each input, whole steps and the part of a step from 0 to 1 by which it comes
    /// later.
    pub(crate) fn delays_in(&self, step: f64) -> Vec<(usize, f64)> {
        let of = |delay: &f64| {
            let steps = delay / step;
            // A delay of whole steps is one in double precision too.
            let whole =
                if (steps - steps.round()).abs() < 1e-9 { steps.round() } else { steps.floor() };
            (whole as usize, (steps - whole).max(0.0))
        };
        self.delays.iter().map(of).collect()
    }

    /// Returns the step matrices for samples that are `h` apart, and their solution for `count` of
    /// them. The input columns are: B of a continuous system for what acts last in a step; for
    /// each input with a delay of parts of a step, what acts first; E.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn propagation(&self, h: f64, count: usize) -> Result<Propagation> {
        if self.description.kind != SystemKind::Continuous {
            let entry = |x: f64| Interval::point(x);
            let gamma = joined(&self.b, &self.e).map(entry);
            let drift = DVector::from_element(self.a.nrows(), Interval::ZERO);
            let step = PropagationStep { phi: self.a.map(entry), gamma, drift };
            return Ok(Propagation::of_step(step, h, count)?);
        }
        let late: Vec<(usize, f64)> = self
            .delays_in(h)
            .into_iter()
            .enumerate()
            .filter_map(|(i, (_, part))| (part > 0.0).then_some((i, part)))
            .collect();
        let n = self.a.nrows();
        let columns: Vec<usize> = late.iter().map(|(i, _)| *i).collect();
        let input = joined(&joined(&self.b, &self.b.select_columns(&columns)), &self.e);
        let system = LinearSystem::new(self.a.clone(), input, DVector::zeros(n))?;
        if late.is_empty() {
            return Ok(Propagation::new(&system, &TimeGrid::uniform(h, count))?);
        }
        // A delayed input changes within a step: after `part` of it.
        let mut whole = step(&system, Interval::point(h));
        for (at, (i, part)) in late.iter().enumerate() {
            let rest = step(&system, Interval::point(h) * (Interval::ONE - Interval::point(*part)));
            for row in 0..n {
                let (last, all) = (rest.gamma[(row, *i)], whole.gamma[(row, *i)]);
                whole.gamma[(row, *i)] = last;
                whole.gamma[(row, self.b.ncols() + at)] = all - last;
            }
        }
        Ok(Propagation::of_step(whole, h, count)?)
    }

    /// Returns the nominal start that is given for all recordings, if one is.
    pub(crate) fn fixed_start(&self) -> Option<&[f64]> {
        match &self.description.start {
            Some(NominalStartRule::At(start)) => Some(start),
            _ => None,
        }
    }
}

fn joined(left: &DMatrix<f64>, right: &DMatrix<f64>) -> DMatrix<f64> {
    let columns = left.column_iter().chain(right.column_iter()).map(|column| column.into_owned());
    match columns.collect::<Vec<_>>() {
        none if none.is_empty() => DMatrix::zeros(left.nrows(), 0),
        columns => DMatrix::from_columns(&columns),
    }
}

/// Returns a matrix that is given row by row.
fn matrix(
    name: &str,
    rows: &[Vec<f64>],
    needed: usize,
    columns: Option<usize>,
) -> Result<DMatrix<f64>, String> {
    let width = columns.unwrap_or_else(|| rows.first().map_or(0, Vec::len));
    let shape = match columns {
        Some(columns) => format!("{needed} rows of {columns} entries"),
        None => format!("{needed} rows of equally many entries"),
    };
    if rows.len() != needed || rows.iter().any(|row| row.len() != width) {
        let found: Vec<String> = rows.iter().map(|row| row.len().to_string()).collect();
        let found = found.join(", ");
        return Err(format!("{name} needs {shape}, but has {} rows of {found}", rows.len()));
    }
    if !rows.iter().flatten().all(|entry| entry.is_finite()) {
        return Err(format!("{name} has an entry that is not finite"));
    }
    Ok(DMatrix::from_row_iterator(needed, width, rows.iter().flatten().copied()))
}

/// Returns C if each output is the state of its name.
fn selected(states: &[NamedSignal], outputs: &[NamedSignal]) -> Result<DMatrix<f64>, String> {
    let mut c = DMatrix::zeros(outputs.len(), states.len());
    for (i, output) in outputs.iter().enumerate() {
        let state = states.iter().position(|state| state.name() == output.name());
        let state = state.ok_or_else(|| {
            format!("C is missing, and the output {} is no state; give C", output.name())
        })?;
        c[(i, state)] = 1.0;
    }
    Ok(c)
}

fn refuse_twice<'a>(names: impl Iterator<Item = &'a str>) -> Result<(), String> {
    let mut sorted: Vec<&str> = names.collect();
    sorted.sort_unstable();
    match sorted.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(format!("two states, inputs or outputs have the name {}", pair[0])),
        None => Ok(()),
    }
}

/// Returns the delay of each input.
fn delays(description: &SystemDescription) -> Result<Vec<f64>, String> {
    let known = |name: &String| description.inputs.iter().any(|input| input.name() == name);
    if let Some((name, _)) = description.delay.iter().find(|(name, _)| !known(name)) {
        return Err(format!("delay names {name}, which is no input"));
    }
    let of = |input: &NamedSignal| {
        let Some(given) = description.delay.get(input.name()) else { return Ok(0.0) };
        let delay = entry("delay", given, description)?;
        let name = input.name();
        let is_time = delay.is_finite() && delay >= 0.0;
        let wrong = || format!("the delay of {name} is {delay}; it must be a time of 0 s or more");
        is_time.then_some(delay).ok_or_else(wrong)
    };
    description.inputs.iter().map(of).collect()
}

/// Returns the numbers of a matrix.
fn evaluated(
    name: &str,
    rows: &MatrixRows,
    description: &SystemDescription,
) -> Result<Vec<Vec<f64>>, String> {
    let row = |row: &Vec<MatrixEntry>| row.iter().map(|of| entry(name, of, description)).collect();
    rows.iter().map(row).collect()
}

/// Returns the number of an entry, with parameters at their values.
fn entry(name: &str, entry: &MatrixEntry, description: &SystemDescription) -> Result<f64, String> {
    let text = match entry {
        MatrixEntry::Number(number) => return Ok(*number),
        MatrixEntry::Formula(text) => text,
    };
    let wrong = |problem: String| format!("{name} has the formula \"{text}\": {problem}");
    let formula = exmex::parse::<f64>(text).map_err(|error| wrong(error.to_string()))?;
    let value = |variable: &String| {
        let known: Vec<&str> = description.parameters.keys().map(String::as_str).collect();
        let parameter = description.parameters.get(variable).map(|of| of.start);
        let missing = || match known.is_empty() {
            true => wrong(format!("{variable} is no parameter; add it to [parameters]")),
            false => wrong(format!("{variable} is no parameter; there are {}", known.join(", "))),
        };
        parameter.ok_or_else(missing)
    };
    let values = formula.var_names().iter().map(value).collect::<Result<Vec<f64>, _>>()?;
    formula.eval(&values).map_err(|error| wrong(error.to_string()))
}

/// Checks the bounds of parameters.
fn check_parameters(description: &SystemDescription) -> Result<(), String> {
    let is_sound = |of: &SystemParameter| {
        of.low.is_finite() && of.high.is_finite() && (of.low..=of.high).contains(&of.start)
    };
    if let Some((name, _)) = description.parameters.iter().find(|(_, of)| !is_sound(of)) {
        return Err(format!("the parameter {name} needs low <= start <= high"));
    }
    let SystemDescription { a, b, c, d, e, f, delay, .. } = description;
    let rows = [a, b, c, d, e, f].into_iter().flatten().flatten().flatten();
    let names = |entry: &MatrixEntry| match entry {
        MatrixEntry::Number(_) => vec![],
        MatrixEntry::Formula(text) => {
            exmex::parse::<f64>(text).map_or(vec![], |formula| formula.var_names().to_vec())
        }
    };
    let used: BTreeSet<String> = rows.chain(delay.values()).flat_map(names).collect();
    match description.parameters.keys().find(|name| !used.contains(*name)) {
        // In formulas, e is Euler's number.
        Some(name) if CONSTANTS.contains(&name.as_str()) => {
            Err(format!("in formulas {name} is a constant; give the parameter another name"))
        }
        Some(name) => Err(format!("no matrix and no delay has the parameter {name}; leave it out")),
        None => Ok(()),
    }
}

/// Checks the lengths of weights and of a start that is given.
fn check_lists(description: &SystemDescription) -> Result<(), String> {
    let (outputs, states) = (description.outputs.len(), description.states.len());
    if let Some(weights) = &description.weights {
        let are_sound = weights.iter().all(|weight| (1e-9..=1e9).contains(weight));
        if weights.len() != outputs || !are_sound {
            return Err(format!("weights needs {outputs} numbers from 1e-9 to 1e9"));
        }
    }
    match &description.start {
        Some(NominalStartRule::At(start)) if start.len() != states => {
            Err(format!("start needs {states} numbers, one for each state"))
        }
        Some(NominalStartRule::At(start)) if !start.iter().all(|x| x.is_finite()) => {
            Err("start has an entry that is not finite".into())
        }
        Some(NominalStartRule::Samples(0)) => Err("start needs one sample at least".into()),
        _ => Ok(()),
    }
}
