//! Flow*: a model file for version 2.1 if the model is affine and no recorded input changes it, and
//! otherwise a C++ program for its library that steps from sample to sample.

mod model_file;
mod program;

use super::case::ExportCase;
use super::meaning::Meaning;
use super::text::comment;
use super::{ExportFile, InputForm, Tool};

pub(super) fn files(case: &ExportCase, form: InputForm) -> Vec<ExportFile> {
    let paragraphs = Meaning::new(case, Tool::FlowStar, form).paragraphs;
    match &case.system.linear {
        Some(system) if form != InputForm::Recorded => {
            let text = comment("#", &paragraphs) + &model_file::linear(case, form, system);
            vec![ExportFile::new("flowstar.model", text)]
        }
        _ => {
            let text = comment("//", &paragraphs) + &program::stepping(case, form);
            vec![ExportFile::new("flowstar.cpp", text)]
        }
    }
}
