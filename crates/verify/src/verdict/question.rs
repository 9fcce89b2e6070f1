use reachtube_conform::{Problem, Tube};

use crate::body::body::Body;
use crate::scene::scenario::Scene;

/// A question about the motions of a model.
pub(super) struct Question<'a> {
    pub problem: &'a Problem,
    pub tube: &'a Tube,
    pub body: &'a Body,
    pub scene: &'a Scene,
}
