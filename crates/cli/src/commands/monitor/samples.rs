//! Samples as lines of CSV or JSON.

use serde_json::{Map, Value};

/// Kinds of numbers that samples of a model have, one of each for each joint.
pub(super) type Kinds = &'static [&'static str];

/// A sample.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sample {
    pub t: f64,
    /// The numbers of each kind.
    pub parts: Vec<Vec<f64>>,
}

/// Format of the lines.
#[derive(Debug, PartialEq)]
enum Form {
    /// One JSON object per line.
    Json,
    /// CSV: which cell each number has: t, then the numbers of each kind, joint by joint.
    Csv(Vec<usize>),
}

/// Lines as they come: the first one tells their format.
pub(super) struct Samples {
    form: Option<Form>,
    joints: usize,
    kinds: Kinds,
}

impl Samples {
    pub(super) fn new(joints: usize, kinds: Kinds) -> Self {
        Self { form: None, joints, kinds }
    }

    /// Reads a line; a header is no sample.
    ///
    /// # Errors
    ///
    /// The problem and the remedy.
    pub(super) fn read(&mut self, line: &str) -> Result<Option<Sample>, String> {
        let form = match &self.form {
            Some(form) => form,
            None => {
                let form = self.form.insert(Form::of(line, self.joints, self.kinds)?);
                if matches!(form, Form::Csv(_)) {
                    return Ok(None);
                }
                form
            }
        };
        form.sample(line, self.kinds).map(Some)
    }
}

impl Form {
    /// Understands the first line, which is a sample in JSON or the header of CSV.
    ///
    /// # Errors
    ///
    /// The problem and the remedy.
    fn of(line: &str, joints: usize, kinds: Kinds) -> Result<Self, String> {
        if line.trim_start().starts_with('{') {
            return Ok(Self::Json);
        }
        let names: Vec<&str> = line.split(',').map(str::trim).collect();
        let of_kind = |kind: &'static str| (1..=joints).map(move |joint| format!("{kind}{joint}"));
        let wanted = kinds.iter().flat_map(|kind| of_kind(kind));
        let wanted = std::iter::once("t".to_string()).chain(wanted);
        let cell = |name: String| {
            names.iter().position(|known| *known == name).ok_or_else(|| {
                format!(
                    "the header has no column {name}; begin with a header that names t, {}.. up to \
                     {joints}, or give one JSON object per line",
                    kinds.iter().map(|kind| format!("{kind}1")).collect::<Vec<_>>().join(".., ")
                )
            })
        };
        let cells = wanted.map(cell).collect::<Result<_, _>>()?;
        let more = |name: &&&str| **name == format!("{}{}", kinds[0], joints + 1);
        if let Some(more) = names.iter().find(more) {
            return Err(format!(
                "the header has a column {more}, but the model has {joints} joints"
            ));
        }
        Ok(Self::Csv(cells))
    }

    /// Reads a line.
    ///
    /// # Errors
    ///
    /// The problem and the remedy.
    fn sample(&self, line: &str, kinds: Kinds) -> Result<Sample, String> {
        let Self::Csv(cells) = self else {
            return of_json(line, kinds).map_err(|problem| {
                let names = kinds.join(", ");
                format!("{problem}; give an object with t, {names}, all numbers finite")
            });
        };
        let values: Vec<&str> = line.split(',').map(str::trim).collect();
        let number = |cell: &usize| {
            let text = values.get(*cell).copied().ok_or_else(|| {
                format!("the line has {} cells, fewer than the header", values.len())
            })?;
            text.parse::<f64>().map_err(|_| format!("\"{text}\" is not a number"))
        };
        let numbers = cells.iter().map(number).collect::<Result<Vec<f64>, _>>()?;
        let n = (numbers.len() - 1) / kinds.len();
        let parts = numbers[1..].chunks_exact(n).map(<[f64]>::to_vec).collect();
        Ok(Sample { t: numbers[0], parts })
    }
}

/// Reads a sample that is a JSON object.
fn of_json(line: &str, kinds: Kinds) -> Result<Sample, String> {
    let object: Map<String, Value> =
        serde_json::from_str(line).map_err(|error| error.to_string())?;
    let field = |name: &str| object.get(name).ok_or_else(|| format!("missing field `{name}`"));
    let wrong = |name: &str| format!("field `{name}` has something else");
    let t = field("t")?.as_f64().ok_or_else(|| wrong("t"))?;
    let part = |name: &&'static str| {
        let numbers = field(name)?.as_array();
        let numbers = numbers.and_then(|all| all.iter().map(Value::as_f64).collect());
        numbers.ok_or_else(|| wrong(name))
    };
    Ok(Sample { t, parts: kinds.iter().map(part).collect::<Result<_, _>>()? })
}

#[cfg(test)]
mod tests {
    use super::{Form, Kinds, Sample};

    #[test]
    fn columns_are_found_by_their_names() {
        let kinds: Kinds = &["q", "qd", "tau"];
        let form = Form::of("t, tau1,q1,extra,qd1", 1, kinds).unwrap();
        let sample = Sample { t: 0.5, parts: vec![vec![1.0], vec![2.0], vec![3.0]] };
        assert_eq!(form.sample("0.5,3,1,x,2", kinds), Ok(sample.clone()));
        assert_eq!(
            form.sample("0.5,3,1", kinds),
            Err("the line has 3 cells, fewer than the header".into())
        );
        assert_eq!(form.sample("0.5,3,x,y,2", kinds), Err("\"x\" is not a number".into()));
        let json = Form::of(" {\"t\"", 1, kinds).unwrap();
        let line = "{\"t\":0.5,\"q\":[1],\"qd\":[2],\"tau\":[3]}";
        assert_eq!(json.sample(line, kinds), Ok(sample));
        let problem = json.sample(&line.replace("[2]", "[null]"), kinds).unwrap_err();
        assert!(problem.contains("field `qd`") && problem.contains("t, q, qd, tau"), "{problem}");
        assert!(Form::of("t,q1,qd1", 1, kinds).unwrap_err().contains("no column tau1"));
        assert!(Form::of("t,q1,q2,qd1,tau1", 1, kinds).unwrap_err().contains("a column q2"));
    }
}
