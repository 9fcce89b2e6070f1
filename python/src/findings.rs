//! The findings of an answer, with settings as users of Python write them.

use pyo3::prelude::*;
use reachtube::conform::Model;
use reachtube::finding::{Finding, FrontEnd, Report};
use serde_json::{Value, json};

use crate::failure::{Failure, Result};

/// Returns the findings of a model, of its text: a JSON list.
#[pyfunction]
pub(crate) fn model_findings(py: Python<'_>, text: &str) -> PyResult<String> {
    let found = model(text).map(|model| list(&model.findings()));
    found.map_err(|failure| failure.raised(py))
}

/// Returns the findings of a check, of its text: a JSON list.
#[pyfunction]
pub(crate) fn check_findings(py: Python<'_>, text: &str) -> PyResult<String> {
    let parsed = || -> Result<Vec<Finding>> {
        let check: Value = serde_json::from_str(text).map_err(Failure::setting)?;
        serde_json::from_value(check["findings"].clone()).map_err(Failure::setting)
    };
    parsed().map(|findings| list(&findings)).map_err(|failure| failure.raised(py))
}

/// Returns the report of a model, of its text: as text, and as JSON.
#[pyfunction]
pub(crate) fn model_report(py: Python<'_>, text: &str) -> PyResult<(String, String)> {
    let report = model(text).map(|model| model.report());
    let report: Report = report.map_err(|failure| failure.raised(py))?;
    let sections: Vec<Value> = report
        .sections
        .iter()
        .map(|section| {
            let findings: Vec<Value> = section.findings.iter().map(value).collect();
            json!({
                "title": section.title, "findings": findings, "tables": section.tables,
                "facts": section.facts,
            })
        })
        .collect();
    let sections = json!({ "sections": sections }).to_string();
    Ok((report.written_for(FrontEnd::Python), sections))
}

/// Reads the text of a model that was checked when Python got it.
fn model(text: &str) -> Result<Model> {
    serde_json::from_str(text).map_err(|error| Failure::ModelFile(error.to_string()))
}

pub(crate) fn list(findings: &[Finding]) -> String {
    Value::from(findings.iter().map(value).collect::<Vec<_>>()).to_string()
}

/// Returns a finding as JSON; `written` is the sentence with its remedy, as Python writes it.
fn value(finding: &Finding) -> Value {
    let mut value = serde_json::to_value(finding).expect("a finding has string keys");
    value["written"] = finding.written_for(FrontEnd::Python).into();
    value
}
