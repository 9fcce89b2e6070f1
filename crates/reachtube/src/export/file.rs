/// A text file of an export.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExportFile {
    /// Its name in the folder of the case.
    pub name: String,
    /// Its text.
    pub text: String,
}

impl ExportFile {
    pub(crate) fn new(name: &str, text: String) -> Self {
        Self { name: name.into(), text }
    }
}
