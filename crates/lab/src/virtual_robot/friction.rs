//! Friction of a joint of the virtual robot.

use reachtube_robot::Joint;
use reachtube_robot::friction::Friction;

use super::elementary::exp;

/// Friction of one joint at one temperature.
#[derive(Debug, Clone, Copy)]
pub(super) struct JointFriction {
    law: Friction,
    /// Speed up to which the cubic of viscous friction holds \[rad/s\].
    limit: f64,
    /// Factors of Coulomb and viscous friction at the temperature \[-\].
    factors: [f64; 2],
}

impl JointFriction {
    pub(super) fn new(joint: &Joint) -> Self {
        let limit = joint.velocity_limit.unwrap_or(f64::INFINITY);
        Self { law: joint.friction, limit, factors: [1.0; 2] }
    }

    pub(super) fn warm_to(&mut self, temperature: f64) {
        let Some(warming) = self.law.warming else { return };
        let warmth = temperature - warming.reference;
        self.factors = [warming.coulomb, warming.viscous].map(|rate| exp(-rate * warmth));
    }

    /// Returns the limits of dry friction \[N m\] at a load \[N m\] and a speed |q̇| \[rad/s\]: the
    /// torque of a joint that moves backward and of a joint that moves forward. A joint at rest has
    /// any torque between them.
    pub(super) fn limits(&self, load: f64, speed: f64) -> [f64; 2] {
        let excess = self.law.stribeck.map_or(0.0, |stribeck| {
            let ratio = speed / stribeck.speed;
            stribeck.excess * exp(-ratio * ratio)
        });
        let coulomb = |direction: f64| self.law.coulomb.torque(load, direction);
        let [backward, forward] = [coulomb(-1.0) - excess, coulomb(1.0) + excess];
        [self.factors[0] * backward.min(0.0), self.factors[0] * forward.max(0.0)]
    }

    /// Returns viscous friction \[N m\] at a velocity \[rad/s\].
    ///
    /// Beyond the joint's speed limit, where its cubic was not identified, it continues along the
    /// tangent: a cubic that falls at last would drive the joint.
    pub(super) fn viscous(&self, qd: f64) -> f64 {
        let (law, inside) = (&self.law.viscous, qd.clamp(-self.limit, self.limit));
        self.factors[1] * (law.torque(&inside) + law.slope(&inside) * (qd - inside))
    }
}
