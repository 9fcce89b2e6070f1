//! Samples as lines of CSV or JSON.

use serde::Deserialize;

/// A sample.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct Sample {
    pub t: f64,
    pub q: Vec<f64>,
    pub qd: Vec<f64>,
    pub tau: Vec<f64>,
}

/// Format of the lines.
#[derive(Debug, PartialEq)]
pub(super) enum Form {
    /// One JSON object per line.
    Json,
    /// CSV: which cell each number has: t, then q, q̇ and tau of each joint.
    Csv(Vec<usize>),
}

impl Form {
    /// Understands the first line, which is a sample in JSON or the header of CSV.
    ///
    /// # Errors
    ///
    /// The problem and the remedy.
    pub(super) fn of(line: &str, joints: usize) -> Result<Self, String> {
        if line.trim_start().starts_with('{') {
            return Ok(Self::Json);
        }
        let names: Vec<&str> = line.split(',').map(str::trim).collect();
        let of_kind = |kind: &'static str| (1..=joints).map(move |joint| format!("{kind}{joint}"));
        let wanted = std::iter::once("t".to_string())
            .chain(["q", "qd", "tau"].into_iter().flat_map(of_kind));
        let cell = |name: String| {
            names.iter().position(|known| *known == name).ok_or_else(|| {
                format!(
                    "the header has no column {name}; begin with a header that names t, q1.., \
                     qd1.., tau1.. up to {joints}, or give one JSON object per line"
                )
            })
        };
        let cells = wanted.map(cell).collect::<Result<_, _>>()?;
        if let Some(more) = names.iter().find(|name| **name == format!("q{}", joints + 1)) {
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
    pub(super) fn sample(&self, line: &str) -> Result<Sample, String> {
        let Self::Csv(cells) = self else {
            return serde_json::from_str(line).map_err(|error| {
                format!("{error}; give an object with t, q, qd and tau, all numbers finite")
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
        let (n, rows) = ((numbers.len() - 1) / 3, &numbers[1..]);
        let part = |index: usize| rows[index * n..(index + 1) * n].to_vec();
        Ok(Sample { t: numbers[0], q: part(0), qd: part(1), tau: part(2) })
    }
}

#[cfg(test)]
mod tests {
    use super::{Form, Sample};

    #[test]
    fn columns_are_found_by_their_names() {
        let form = Form::of("t, tau1,q1,extra,qd1", 1).unwrap();
        let sample = Sample { t: 0.5, q: vec![1.0], qd: vec![2.0], tau: vec![3.0] };
        assert_eq!(form.sample("0.5,3,1,x,2"), Ok(sample.clone()));
        assert_eq!(
            form.sample("0.5,3,1"),
            Err("the line has 3 cells, fewer than the header".into())
        );
        assert_eq!(form.sample("0.5,3,x,y,2"), Err("\"x\" is not a number".into()));
        let json = Form::of(" {\"t\"", 1).unwrap();
        assert_eq!(json.sample("{\"t\":0.5,\"q\":[1],\"qd\":[2],\"tau\":[3]}"), Ok(sample));
        assert!(Form::of("t,q1,qd1", 1).unwrap_err().contains("no column tau1"));
        assert!(Form::of("t,q1,q2,qd1,tau1", 1).unwrap_err().contains("a column q2"));
    }
}
