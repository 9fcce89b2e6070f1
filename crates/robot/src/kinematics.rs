//! Link placements and energies.

use crate::link::Link;
use crate::placement::{Placement, rotation_x, rotation_z};
use crate::robot::Robot;
use nalgebra::Vector3;

impl Robot {
    /// Returns the placement of each link's original frame in the base frame, for q in rad.
    ///
    /// The original frame is the one of the description, not the working frame.
    ///
    /// # Examples
    ///
    /// ```
    /// let robot = reachtube_robot::Robot::lwa4p();
    /// let tip = &robot.link_placements(&[0.0; 6])[5];
    /// assert!((tip.translation.z - (0.35 + 0.3012 + 0.1548)).abs() < 1e-12);
    /// ```
    pub fn link_placements(&self, q: &[f64]) -> Vec<Placement> {
        let frames = self.working_placements(q);
        frames.iter().zip(&self.links).map(|(frame, link)| frame.then(&link.original)).collect()
    }

    /// Returns the placement of each working frame in the base frame.
    fn working_placements(&self, q: &[f64]) -> Vec<Placement> {
        let (sin, cos) = self.sin_cos(q);
        let mut frame = Placement::rotation(self.base);
        let links = self.links.iter().zip(sin.iter().zip(&cos));
        links
            .map(|(link, (sin, cos))| {
                let pose = link.pose(sin, cos);
                let rotation =
                    rotation_x((link.sin_twist, link.cos_twist)) * rotation_z((pose.sin, pose.cos));
                let translation = Vector3::new(pose.origin.x, pose.origin.y, pose.origin.z);
                frame = frame.then(&Placement { rotation, translation });
                frame.clone()
            })
            .collect()
    }

    /// Returns the kinetic energy ½ q̇ᵀ M_m(q) q̇ \[J\], rotors included, at q \[rad\] and q̇
    /// \[rad/s\].
    pub fn kinetic_energy(&self, q: &[f64], qd: &[f64]) -> f64 {
        let qd = nalgebra::DVectorView::from_slice(qd, qd.len());
        0.5 * (self.mass_matrix(q) * qd).dot(&qd)
    }

    /// Returns the potential energy of the gravity parameters \[J\] at q \[rad\]; it is zero for
    /// masses at the base's origin.
    pub fn potential_energy(&self, q: &[f64]) -> f64 {
        let gravity = Vector3::from(self.gravity_acceleration());
        let moment = |(frame, link): (&Placement, &Link)| {
            frame.rotation * Vector3::from(link.gravity_first_moment)
                + link.gravity_mass * frame.translation
        };
        -self
            .working_placements(q)
            .iter()
            .zip(&self.links)
            .map(moment)
            .sum::<Vector3<f64>>()
            .dot(&gravity)
    }
}
