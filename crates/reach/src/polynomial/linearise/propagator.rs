//! Propagation of zonotopes by conservative linearisation.

use reachtube_scalar::Interval;

use crate::polynomial::linearise::linearisation::FlowLinearisation;
use crate::polynomial::linearise::reachable_zonotope::ReachableZonotope;
use crate::polynomial::linearise::step::LinearisedStep;
use crate::polynomial::propagator::{SetPropagator, StepFailure};
use crate::polynomial::system::PolynomialSystem;
use crate::sets::zonotope::Zonotope;

/// A zonotope and the linearised steps that propagate it.
pub(crate) struct ZonotopePropagator<'a> {
    set: ReachableZonotope,
    step: LinearisedStep<'a>,
}

impl<'a> ZonotopePropagator<'a> {
    /// Starts from the box with the given sides.
    pub(crate) fn new(
        system: &'a PolynomialSystem,
        sides: &[Interval],
        vertex_variables: usize,
        most_generators: usize,
    ) -> Self {
        let (centre, radius) = sides.iter().map(|x| (x.mid(), x.rad())).unzip();
        let (inputs, directions) = (system.inputs(), system.directions.len());
        let linearisation = FlowLinearisation::new(system, vertex_variables);
        Self {
            set: ReachableZonotope::new(centre, radius, inputs, directions),
            step: LinearisedStep::new(linearisation, most_generators),
        }
    }
}

impl SetPropagator for ZonotopePropagator<'_> {
    fn advance(&mut self, h: Interval, u: &[Interval]) -> Result<(), StepFailure> {
        self.step.advance(&mut self.set, h, u)
    }

    fn tube(&self, out: &mut Vec<Interval>) {
        out.extend(self.step.tube());
    }

    fn hull(&self, out: &mut Vec<Interval>) {
        let sides = self.set.centre.iter().zip(&self.set.radius);
        out.extend(sides.map(|(centre, radius)| Interval::centred(*centre, *radius)));
    }

    fn zonotope(&self) -> Zonotope {
        self.set.zonotope(self.step.directions())
    }
}
