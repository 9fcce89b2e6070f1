//! All friction of one joint.

use super::coulomb::{Coulomb, LoadLine, NEAR_STANDSTILL};
use super::stribeck::Stribeck;
use super::viscous::Viscous;
use super::warming::Warming;
use reachtube_scalar::{Interval, Lanewise};

/// Parts into which a range of velocities is cut. The Stribeck effect falls with speed where
/// viscous friction rises, and only small parts show that both do so together.
const PARTS: usize = 16;

/// Number of speeds at which the sign of friction is looked at.
const SPEEDS: usize = 64;

/// Friction of one joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Friction {
    /// Load-dependent Coulomb friction tau_c.
    pub coulomb: Coulomb,
    /// Viscous friction tau_v.
    pub viscous: Viscous,
    /// Rise of dry friction toward standstill, or its fall, if there is one. It is part of tau_c.
    pub stribeck: Option<Stribeck>,
    /// Change of friction while the joint warms up, if it is known. Torques hold at the law's
    /// reference; [`Robot::at_temperature`](crate::Robot::at_temperature) and
    /// [`Robot::at_run`](crate::Robot::at_run) apply the law.
    pub warming: Option<Warming>,
}

impl Friction {
    /// Returns dry friction \[N m\] where it holds a joint near standstill, at a load torque
    /// \[N m\], a joint velocity \[rad/s\] and the torque \[N m\] that would move the joint
    /// without it, the motor torque less gravity.
    ///
    /// At rest, friction balances that torque as far as it can. From 0.02 rad/s or m/s on it
    /// is [`Friction::dry_torque`], and in between it passes from one to the other.
    #[must_use]
    pub fn holding_torque(&self, load: f64, qd: f64, driving: f64) -> f64 {
        let limit = |direction: f64| self.dry_torque(load, direction * f64::MIN_POSITIVE);
        let (one, other) = (limit(-1.0), limit(1.0));
        let held = driving.clamp(one.min(other), one.max(other));
        let moving = (qd.abs() / NEAR_STANDSTILL).min(1.0);
        moving * self.dry_torque(load, qd) + (1.0 - moving) * held
    }

    /// Returns dry friction \[N m\], Coulomb friction with the Stribeck effect, at a load torque
    /// \[N m\] and a joint velocity \[rad/s\]. It is 0 at standstill.
    pub fn dry_torque<S: Lanewise>(&self, load: S, qd: S) -> S {
        let coulomb = self.coulomb.torque(load, qd);
        match &self.stribeck {
            None => coulomb,
            Some(stribeck) => coulomb + stribeck.torque(qd),
        }
    }

    /// Returns dry friction \[N m\] as [`Friction::dry_torque`] does, but without steps:
    /// [`Coulomb::softened_torque`], and the Stribeck effect in proportion to the velocity below
    /// 0.02 rad/s or m/s.
    #[must_use]
    pub fn softened_dry_torque(&self, load: f64, qd: f64) -> f64 {
        let coulomb = self.coulomb.softened_torque(load, qd, [1.0; 4]);
        let moving = (qd.abs() / NEAR_STANDSTILL).min(1.0);
        coulomb + self.stribeck.map_or(0.0, |stribeck| moving * stribeck.torque(qd))
    }

    /// Returns the velocity \[rad/s\], in either direction and up to `limit`, at which friction at
    /// no load drives the joint most; `None` if it brakes everywhere. Coulomb friction, whose lines
    /// may differ at no load, counts by its mean magnitude.
    pub(crate) fn drives_at(&self, limit: f64) -> Option<f64> {
        let speeds = (1..=SPEEDS).map(|k| limit * k as f64 / SPEEDS as f64);
        let velocities = speeds.flat_map(|speed| [-speed, speed]);
        let driving = |qd: f64| {
            let parts = [
                qd.signum() * self.coulomb.magnitude_at_no_load(),
                self.stribeck.map_or(0.0, |stribeck| stribeck.torque(qd)),
                self.viscous.torque(&qd),
            ];
            let rounding = 1e-9 * parts.iter().map(|part| part.abs()).sum::<f64>();
            -qd.signum() * parts.iter().sum::<f64>() - rounding
        };
        let most = velocities.max_by(|a, b| driving(*a).total_cmp(&driving(*b)));
        most.filter(|qd| driving(*qd) > 0.0)
    }

    /// Returns a range of the friction torque \[N m\], dry and viscous, over loads \[N m\] and
    /// velocities \[rad/s\] that may cross zero.
    ///
    /// Friction at standstill is a set: every torque from the limit of backward motion to the limit
    /// of forward motion, breakaway torques included. The range contains this set where 0 is among
    /// the velocities.
    ///
    /// # Guarantee
    ///
    /// Outer: the range encloses the torques of the formulas for all loads and velocities, with
    /// directed rounding.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::friction::{Coulomb, Friction, Stribeck};
    /// use reachtube_scalar::Interval;
    ///
    /// let friction = Friction {
    ///     coulomb: Coulomb::constant(2.0),
    ///     stribeck: Some(Stribeck { excess: 0.5, speed: 0.1 }),
    ///     ..Friction::default()
    /// };
    /// let no_load = Interval::point(0.0);
    /// let range = friction.range_near_zero(no_load, Interval::new(-0.01, 0.02).unwrap());
    /// assert!(range.contains(-2.5) && range.contains(0.0) && range.contains(2.5));
    /// let forward = friction.range_near_zero(no_load, Interval::new(0.5, 0.6).unwrap());
    /// assert!(!forward.contains(0.0));
    /// ```
    pub fn range_near_zero(&self, load: Interval, velocity: Interval) -> Interval {
        let positive = Interval::new(0.0, f64::MAX).expect("an interval");
        let negative = Interval::new(-f64::MAX, 0.0).expect("an interval");
        let forward = velocity.intersection(positive).map(|v| self.moving(load, v, true));
        let backward = velocity.intersection(negative).map(|v| self.moving(load, v, false));
        // Standstill lies between the limits of both directions, which the hull contains.
        match (forward, backward) {
            (Some(forward), Some(backward)) => forward.hull(backward).hull(Interval::point(0.0)),
            (forward, backward) => forward.or(backward).expect("a velocity has a sign or is 0"),
        }
    }

    /// Encloses the torque \[N m\] for velocities of one direction, with its limit at standstill.
    fn moving(&self, load: Interval, velocity: Interval, forward: bool) -> Interval {
        let coulomb = self.coulomb_moving(load, forward);
        let Some(Stribeck { excess, speed }) = self.stribeck else {
            return coulomb + self.viscous_range(velocity);
        };
        let excess = Interval::point(if forward { excess } else { -excess });
        let of_part = |v: Interval| {
            let decay = (-(v / Interval::point(speed)).sqr()).exp();
            coulomb + self.viscous.torque(&v) + excess * decay
        };
        parts(velocity).map(of_part).reduce(Interval::hull).expect("there are parts")
    }

    /// Encloses Coulomb friction \[N m\] in one direction of motion.
    fn coulomb_moving(&self, load: Interval, forward: bool) -> Interval {
        let of_line = |line: LoadLine, load: Option<Interval>| {
            load.map(|load| Interval::point(line.offset) + Interval::point(line.slope) * load)
        };
        let positive = Interval::new(0.0, f64::MAX).and_then(|sign| load.intersection(sign));
        let negative = Interval::new(-f64::MAX, 0.0).and_then(|sign| load.intersection(sign));
        let Coulomb { driving_forward, driving_backward, braking_backward, braking_forward } =
            self.coulomb;
        let lines = if forward {
            [of_line(driving_forward, positive), of_line(braking_forward, negative)]
        } else {
            [of_line(braking_backward, positive), of_line(driving_backward, negative)]
        };
        lines.into_iter().flatten().reduce(Interval::hull).unwrap_or(Interval::point(0.0))
    }

    /// Encloses viscous friction \[N m\]: between its values at both ends where it rises all over
    /// the velocities, and by parts elsewhere.
    fn viscous_range(&self, velocity: Interval) -> Interval {
        let torque = |v: Interval| self.viscous.torque(&v);
        if self.viscous.slope(&velocity).lo() >= 0.0 {
            let [low, high] = [velocity.lo(), velocity.hi()].map(Interval::point);
            return torque(low).hull(torque(high));
        }
        parts(velocity).map(torque).reduce(Interval::hull).expect("there are parts")
    }
}

/// Returns consecutive parts that cover an interval: each starts where the one before ends.
fn parts(whole: Interval) -> impl Iterator<Item = Interval> {
    let cut = move |k: usize| match k {
        0 => whole.lo(),
        PARTS => whole.hi(),
        _ => (whole.lo() + whole.width() * k as f64 / PARTS as f64).min(whole.hi()),
    };
    (0..PARTS).map(move |k| Interval::new(cut(k), cut(k + 1)).expect("cuts increase"))
}
