//! The description of a joint and the link that it moves.

use crate::friction::coulomb::Coulomb;
use crate::friction::joint_friction::Friction;
use crate::friction::stribeck::Stribeck;
use crate::friction::viscous::Viscous;
use crate::friction::warming::Warming;
use crate::inertia::LinkInertia;
use crate::joint::Joint;
use crate::joint_geometry::JointGeometry;
use crate::joint_kind::JointKind;
use crate::placement::Placement;
use core::f64::consts::PI;
use nalgebra::{Matrix3, Rotation3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A Denavit-Hartenberg convention.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Convention {
    /// Rz(q + theta) Tz(d) Tx(a) Rx(alpha).
    #[default]
    Standard,
    /// Craig: Rx(alpha) Tx(a) Rz(q + theta) Tz(d).
    Modified,
}

/// Denavit-Hartenberg parameters.
///
/// Angles within 1e-12 rad of a multiple of pi/2 are taken as exactly that multiple.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dh {
    /// Link length \[m\].
    pub a: f64,
    /// Link twist \[rad\].
    pub alpha: f64,
    /// Joint offset added to q \[rad\]; the constant angle of a prismatic joint.
    pub theta: f64,
    /// Link offset \[m\]; q of a prismatic joint is added to it.
    pub d: f64,
}

/// The placement of a joint frame in the frame of the previous link; the default of each part is
/// the identity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlacementDescription {
    /// Rotation matrix from child to parent, row by row.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<[[f64; 3]; 3]>,
    /// Roll, pitch, yaw \[rad\]: Rz(yaw) Ry(pitch) Rx(roll), as in URDF.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rpy: Option<[f64; 3]>,
    /// Translation \[m\].
    #[serde(default)]
    pub translation: [f64; 3],
}

/// The reference point of an inertia tensor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum InertiaPoint {
    /// The link's centre of mass.
    #[default]
    Com,
    /// The origin of the link's frame.
    Origin,
}

/// Mass moments that only gravity acts on, for robots whose gravity parameters were identified
/// separately from the inertial ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GravityMoments {
    /// Mass \[kg\].
    pub mass: f64,
    /// Mass times centre of mass \[kg m\], in the link's frame.
    pub first_moment: [f64; 3],
}

/// Friction coefficients of a joint, (5) to (9).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrictionDescription {
    /// Coulomb coefficients a1 to a8: offset \[N m\] and slope of driving forward, driving
    /// backward, braking backward, braking forward. Offsets of a prismatic joint are in N.
    #[serde(default)]
    pub coulomb: [f64; 8],
    /// Viscous coefficients v1 \[N m s/rad\], v2 \[N m s²/rad²\], v3 \[N m s³/rad³\]; \[N s/m\],
    /// \[N s²/m²\], \[N s³/m³\] for a prismatic joint.
    #[serde(default)]
    pub viscous: [f64; 3],
    /// Rise of dry friction toward standstill, or its fall with a negative excess; none by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stribeck: Option<Stribeck>,
    /// Change of friction while the joint warms up; unknown by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub warming: Option<Warming>,
    /// Standard errors of the identified coefficients; unknown by default. Nothing is computed from
    /// them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_errors: Option<FrictionErrors>,
    /// Lowest and highest velocity of the samples that the coefficients were fitted to \[rad/s;
    /// m/s\]; unknown by default. Nothing is computed from them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fitted_velocities: Option<[f64; 2]>,
}

/// Standard errors of identified friction, in the units of the coefficients; 0 if one is unknown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrictionErrors {
    /// Standard errors of a1 to a8.
    #[serde(default)]
    pub coulomb: [f64; 8],
    /// Standard errors of v1, v2 and v3.
    #[serde(default)]
    pub viscous: [f64; 3],
}

impl FrictionDescription {
    /// Returns whether a part of dry friction builds up with speed: a Stribeck effect with a
    /// negative excess.
    #[must_use]
    pub fn saturates(&self) -> bool {
        self.stribeck.is_some_and(|law| law.excess < 0.0)
    }

    /// Returns whether dry friction without load, in the mean over the quadrants, does not drive
    /// the joint near standstill.
    #[must_use]
    pub fn dissipates_at_standstill(&self) -> bool {
        let mean = self.coulomb.iter().step_by(2).map(|offset| offset.abs()).sum::<f64>() / 4.0;
        // Rounding of a sum that is 0.
        self.stribeck.is_none_or(|law| mean * (1.0 + 1e-9) + law.excess >= 0.0)
    }

    /// Returns the friction where Coulomb and viscous friction have these factors, without the law
    /// of warming.
    #[must_use]
    pub(crate) fn scaled(&self, [coulomb, viscous]: [f64; 2]) -> Self {
        let scaled = |law: Stribeck| Stribeck { excess: coulomb * law.excess, ..law };
        Self {
            coulomb: self.coulomb.map(|a| coulomb * a),
            viscous: self.viscous.map(|v| viscous * v),
            stribeck: self.stribeck.map(scaled),
            ..Self::default()
        }
    }

    /// Returns the friction that the algorithms use.
    pub(crate) fn friction(&self) -> Friction {
        let [v1, v2, v3] = self.viscous;
        Friction {
            coulomb: Coulomb::from_coefficients(self.coulomb),
            viscous: Viscous { v1, v2, v3 },
            stribeck: self.stribeck,
            warming: self.warming,
        }
    }
}

/// A joint and the link that it moves.
///
/// The link's frame is the joint frame moved by q (`placement`), or the Denavit-Hartenberg frame
/// of the link (`dh`).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointDescription {
    /// The joint's name, unique in the robot.
    pub name: String,
    /// Kind of the joint, `revolute` or `prismatic`; the default is `revolute`.
    #[serde(default, rename = "type", skip_serializing_if = "JointKind::is_revolute")]
    pub kind: JointKind,
    /// Geometry as Denavit-Hartenberg parameters, in place of `placement` and `axis`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dh: Option<Dh>,
    /// Geometry as the placement of the joint frame in the previous link.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub placement: Option<PlacementDescription>,
    /// Axis in the joint frame, of any positive length; the default is z.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 3]>,
    /// Mass of the link \[kg\].
    #[serde(default)]
    pub mass: f64,
    /// Centre of mass in the link's frame \[m\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub com: Option<[f64; 3]>,
    /// Mass times centre of mass \[kg m\], in place of `com`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_moment: Option<[f64; 3]>,
    /// Inertia tensor ixx, ixy, ixz, iyy, iyz, izz in the link's axes \[kg m²\].
    #[serde(default)]
    pub inertia: [f64; 6],
    /// Reference point of `inertia`.
    #[serde(default)]
    pub about: InertiaPoint,
    /// Mass moments for gravity, in place of `mass` and `com`; either all joints have them or none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity_moments: Option<GravityMoments>,
    /// Gear ratio k_r (dimensionless; rad/m for a prismatic joint).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gear_ratio: Option<f64>,
    /// Rotor inertia I_m on the motor side \[kg m²\]; the armature is k_r² I_m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotor_inertia: Option<f64>,
    /// Motor inertia on the link side \[kg m²; kg for a prismatic joint\], in place of
    /// `rotor_inertia`; the default is 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub armature: Option<f64>,
    /// Lowest and highest position \[rad; m\]; the default is ±pi. A prismatic joint has no
    /// default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position_limits: Option<[f64; 2]>,
    /// Highest speed \[rad/s; m/s\]; unknown by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity_limit: Option<f64>,
    /// Friction; the default is none.
    #[serde(default)]
    pub friction: FrictionDescription,
}

impl PlacementDescription {
    fn placement(&self) -> Placement {
        let [roll, pitch, yaw] = self.rpy.unwrap_or_default();
        let rotation = match self.rotation {
            Some(rows) => Matrix3::from_row_slice(rows.as_flattened()),
            None => Rotation3::from_euler_angles(roll, pitch, yaw).into_inner(),
        };
        Placement { rotation, translation: self.translation.into() }
    }
}

impl JointDescription {
    /// Returns the geometry of the joint.
    pub(crate) fn geometry(&self, convention: Convention) -> JointGeometry {
        match (self.dh, convention) {
            (Some(p), Convention::Standard) => {
                JointGeometry::standard_dh(p.a, p.alpha, p.theta, p.d)
            }
            (Some(p), Convention::Modified) => {
                JointGeometry::modified_dh(p.a, p.alpha, p.theta, p.d)
            }
            (None, _) => {
                let axis = Vector3::from(self.axis.unwrap_or([0.0, 0.0, 1.0]));
                JointGeometry::explicit(
                    self.placement.unwrap_or_default().placement(),
                    axis.normalize(),
                )
            }
        }
    }

    /// Returns the inertia tensor about its reference point.
    fn tensor(&self) -> Matrix3<f64> {
        let [xx, xy, xz, yy, yz, zz] = self.inertia;
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }

    /// Returns the ten inertial parameters about the origin of the link's frame.
    pub(crate) fn link_inertia(&self) -> LinkInertia {
        let com = Vector3::from(self.com.unwrap_or_default());
        match self.about {
            InertiaPoint::Com => LinkInertia::about_com(self.mass, com, &self.tensor()),
            InertiaPoint::Origin => {
                let h = self.first_moment.map_or(self.mass * com, Vector3::from);
                LinkInertia::about_origin(self.mass, h, &self.tensor())
            }
        }
    }

    /// Returns mass, centre of mass, and ixx, ixy, ixz, iyy, iyz, izz about it; these are the given
    /// numbers, without rounding, if the description has them.
    pub(crate) fn about_own_com(&self) -> (f64, [f64; 3], [f64; 6]) {
        match self.about {
            InertiaPoint::Com => (self.mass, self.com.unwrap_or_default(), self.inertia),
            InertiaPoint::Origin => self.link_inertia().about_own_com(),
        }
    }

    pub(crate) fn gravity_inertia(&self) -> LinkInertia {
        self.gravity_moments.map_or_else(
            || self.link_inertia(),
            |g| LinkInertia::about_origin(g.mass, g.first_moment.into(), &Matrix3::zeros()),
        )
    }

    /// Returns the drive of the joint.
    pub(crate) fn joint(&self) -> Joint {
        let geared = self.gear_ratio.unwrap_or(1.0).powi(2) * self.rotor_inertia.unwrap_or(0.0);
        Joint {
            name: self.name.clone(),
            kind: self.kind,
            position_limits: self
                .position_limits
                .or(self.kind.default_limits())
                .unwrap_or([-PI, PI]),
            velocity_limit: self.velocity_limit,
            gear_ratio: self.gear_ratio,
            armature: self.armature.unwrap_or(geared),
            friction: self.friction.friction(),
        }
    }

    /// Sets the motor inertia on the link side \[kg m²; kg\]. A description by rotor inertia and
    /// gear ratio keeps this form.
    pub(crate) fn set_armature(&mut self, armature: f64) {
        match (self.rotor_inertia, self.gear_ratio) {
            (Some(_), Some(ratio)) if ratio != 0.0 => {
                self.rotor_inertia = Some(armature / ratio.powi(2))
            }
            _ => self.armature = Some(armature),
        }
    }

    /// Sets the ten inertial parameters, about the origin of the link's frame.
    pub(crate) fn set_inertial(&mut self, p: &[f64]) {
        self.mass = p[0];
        (self.com, self.first_moment) = (None, Some([p[1], p[2], p[3]]));
        self.inertia = [p[4], p[5], p[7], p[6], p[8], p[9]];
        self.about = InertiaPoint::Origin;
    }
}
