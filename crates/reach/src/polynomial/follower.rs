//! The ways to follow a set from step to step.

use reachtube_scalar::{Interval, TaylorSpace};

use super::linearisation::Linearisation;
use super::set::Set;
use super::step::{Exhausted, Stepper};
use super::taylor::{TaylorSet, TaylorStepper};
use super::{FlowpipeMethod, FlowpipeSettings, PolynomialSystem};
use crate::{ReachError, Zonotope};

/// A set that follows the system.
pub(super) trait Follower {
    /// Over a step of length h, under any input in u.
    fn advance(&mut self, h: Interval, u: &[Interval]) -> Result<(), Exhausted>;

    /// Appends a box of all states of the step just made.
    fn tube(&self, out: &mut Vec<Interval>);

    /// Appends the hull.
    fn hull(&self, out: &mut Vec<Interval>);

    /// A copy for others.
    fn zonotope(&self) -> Zonotope;

    /// Generators that are stored.
    fn generators(&self) -> usize;
}

/// The set of initial states, ready to be followed as the settings say.
pub(super) fn follower<'a>(
    system: &'a PolynomialSystem,
    sides: &[Interval],
    settings: &FlowpipeSettings,
) -> Result<Box<dyn Follower + 'a>, ReachError> {
    let most = settings.order.map_or(usize::MAX, |order| order.saturating_mul(sides.len()));
    Ok(match settings.method {
        FlowpipeMethod::Linearisation => {
            let (center, radius) = sides.iter().map(|x| (x.mid(), x.rad())).unzip();
            let set = Set::new(center, radius, system.inputs(), system.directions.len());
            Box::new(Zonotopes {
                set,
                stepper: Stepper::new(Linearisation::new(system, settings.corners), most),
            })
        }
        FlowpipeMethod::TaylorModels { .. } if !system.angles.states.is_empty() => {
            return Err(ReachError::Trigonometric);
        }
        FlowpipeMethod::TaylorModels { order } => {
            let space = TaylorSpace::new(sides.len(), order.max(1))?;
            let set = TaylorSet::new(&space, sides, most);
            Box::new(TaylorModels { set, stepper: TaylorStepper::new(system, space.order()) })
        }
    })
}

struct Zonotopes<'a> {
    set: Set,
    stepper: Stepper<'a>,
}

impl Follower for Zonotopes<'_> {
    fn advance(&mut self, h: Interval, u: &[Interval]) -> Result<(), Exhausted> {
        self.stepper.advance(&mut self.set, h, u)
    }

    fn tube(&self, out: &mut Vec<Interval>) {
        out.extend(self.stepper.tube());
    }

    fn hull(&self, out: &mut Vec<Interval>) {
        let sides = self.set.center.iter().zip(&self.set.radius);
        out.extend(sides.map(|(center, radius)| Interval::centered(*center, *radius)));
    }

    fn zonotope(&self) -> Zonotope {
        self.set.zonotope(self.stepper.directions())
    }

    fn generators(&self) -> usize {
        self.set.generators.len()
    }
}

struct TaylorModels {
    set: TaylorSet,
    stepper: TaylorStepper,
}

impl Follower for TaylorModels {
    fn advance(&mut self, h: Interval, u: &[Interval]) -> Result<(), Exhausted> {
        self.stepper.advance(&mut self.set, h, u)
    }

    fn tube(&self, out: &mut Vec<Interval>) {
        out.extend_from_slice(self.stepper.tube());
    }

    fn hull(&self, out: &mut Vec<Interval>) {
        out.extend(self.set.hull());
    }

    fn zonotope(&self) -> Zonotope {
        self.set.zonotope()
    }

    fn generators(&self) -> usize {
        self.set.generators()
    }
}
