use std::sync::Arc;

use crate::problem::problem::{Problem, Read, sensor_noise};
use crate::problem::recordings::Recordings;

impl Problem {
    /// Returns the problem of some of the suites, as if no other had been read: nothing in it
    /// depends on the others.
    #[must_use]
    pub(crate) fn with_suites(&self, is_wanted: impl Fn(usize) -> bool) -> Self {
        let suites = self.recordings().suites.iter().enumerate();
        let wanted = suites.filter(|(index, _)| is_wanted(*index)).map(|(_, suite)| suite.clone());
        let recordings = Recordings { suites: wanted.collect(), notes: Vec::new() };
        let read = Read {
            source: Arc::clone(&self.read.source),
            kept: Arc::clone(&self.read.kept),
            sensor_noise: sensor_noise(self.setup(), &recordings),
            robot: self.read.robot.clone(),
            recordings,
        };
        Self::of(self.setup().clone(), Arc::new(read))
    }
}
