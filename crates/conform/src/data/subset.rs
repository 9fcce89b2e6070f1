use std::sync::Arc;

use crate::data::problem::{Problem, Read, sensor_noise};
use crate::data::recordings::Recordings;

impl Problem {
    /// Returns the problem of some of the suites, as if no other had been read: it does not depend
    /// on the others.
    pub(crate) fn with_suites(&self, is_wanted: impl Fn(usize) -> bool) -> Self {
        let suites = self.recordings().suites.iter().enumerate();
        let wanted = suites.filter(|(index, _)| is_wanted(*index)).map(|(_, suite)| suite.clone());
        let Recordings { root, are_listed, compared, skipped, .. } = self.recordings();
        let (root, are_listed, skipped) = (root.clone(), *are_listed, *skipped);
        let compared = compared.clone();
        let (suites, notes) = (wanted.collect(), Vec::new());
        let recordings = Recordings { suites, notes, root, are_listed, compared, skipped };
        let read = Read {
            origin: self.read.origin.clone(),
            kept: Arc::clone(&self.read.kept),
            sensor_noise: sensor_noise(self.setup(), &recordings),
            input_key: self.read.input_key.clone(),
            recordings,
        };
        Self::of(self.setup().clone(), Arc::new(read))
    }
}
