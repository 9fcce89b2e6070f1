//! Propagation of Taylor models.

use std::sync::Arc;

use reachtube_scalar::{Interval, TaylorSpace};

use crate::polynomial::propagator::{SetPropagator, StepFailure};
use crate::polynomial::system::PolynomialSystem;
use crate::polynomial::taylor::set::TaylorSet;
use crate::polynomial::taylor::step::TaylorStep;
use crate::sets::zonotope::Zonotope;

/// A set of Taylor models and the steps that propagate it.
pub(crate) struct TaylorPropagator {
    set: TaylorSet,
    step: TaylorStep,
}

impl TaylorPropagator {
    /// Starts from the box with the given sides.
    pub(crate) fn new(
        system: &PolynomialSystem,
        space: &Arc<TaylorSpace>,
        sides: &[Interval],
        most_generators: usize,
    ) -> Self {
        Self {
            set: TaylorSet::new(space, sides, most_generators),
            step: TaylorStep::new(system, space.order()),
        }
    }
}

impl SetPropagator for TaylorPropagator {
    fn advance(&mut self, h: Interval, u: &[Interval]) -> Result<(), StepFailure> {
        self.step.advance(&mut self.set, h, u)
    }

    fn tube(&self, out: &mut Vec<Interval>) {
        out.extend_from_slice(self.step.tube());
    }

    fn hull(&self, out: &mut Vec<Interval>) {
        out.extend(self.set.hull());
    }

    fn zonotope(&self) -> Zonotope {
        self.set.zonotope()
    }
}
