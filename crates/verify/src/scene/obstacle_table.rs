//! Obstacles in the TOML of a scenario.

use std::path::{Path, PathBuf};

use nalgebra::Rotation3;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_down, mul_up, sub_up};
use serde::Deserialize;

use crate::kinematics::vector::{add, norm, point, scaled, sub};
use crate::mesh::{Problem, vertices};
use crate::scene::obstacle::Solid;

/// An obstacle or a person.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct ObstacleTable {
    pub name: String,
    half_space: Option<HalfSpaceTable>,
    #[serde(rename = "box")]
    cuboid: Option<BoxTable>,
    capsule: Option<CapsuleTable>,
    sphere: Option<SphereTable>,
    mesh: Option<MeshTable>,
    pub speed: Option<f64>,
    pub links: Option<Vec<String>>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct HalfSpaceTable {
    normal: [f64; 3],
    offset: f64,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct BoxTable {
    centre: [f64; 3],
    size: [f64; 3],
    #[serde(default)]
    rpy: [f64; 3],
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct CapsuleTable {
    from: [f64; 3],
    to: [f64; 3],
    radius: f64,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct SphereTable {
    centre: [f64; 3],
    radius: f64,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct MeshTable {
    file: PathBuf,
    #[serde(default = "one")]
    scale: f64,
    #[serde(default)]
    position: [f64; 3],
    #[serde(default)]
    rpy: [f64; 3],
}

fn one() -> f64 {
    1.0
}

impl ObstacleTable {
    /// Returns the shape of an obstacle; meshes are sought from a folder on.
    pub(super) fn solid(&self, folder: &Path) -> core::result::Result<Solid, Problem> {
        let Self { half_space, cuboid, capsule, sphere, mesh, .. } = self;
        let solid = match (half_space, cuboid, capsule, sphere, mesh) {
            (Some(HalfSpaceTable { normal, offset }), None, None, None, None) => {
                Solid::HalfSpace { normal: *normal, offset: *offset }
            }
            (None, Some(table), None, None, None) => table.solid(),
            (None, None, None, None, Some(table)) => table.around(folder)?,
            (None, None, Some(CapsuleTable { from, to, radius }), None, None) => {
                Solid::Capsule { from: *from, to: *to, radius: *radius }
            }
            (None, None, None, Some(SphereTable { centre, radius }), None) => {
                Solid::Capsule { from: *centre, to: *centre, radius: *radius }
            }
            _ => {
                let remedy = "give exactly one of half-space, box, capsule, sphere and mesh";
                return Err(("it has no shape, or several".into(), remedy));
            }
        };
        let (sizes, numbers): (Vec<f64>, Vec<f64>) = match solid {
            Solid::HalfSpace { normal, offset } => {
                (vec![normal.iter().map(|x| x * x).sum()], vec![offset])
            }
            Solid::Box { centre, half, .. } => (half.to_vec(), centre.to_vec()),
            Solid::Capsule { from, to, radius } => (vec![radius], [from, to].concat()),
        };
        if !sizes.iter().all(|size| *size > 0.0) {
            return Err(("a length is not above 0".into(), "give lengths above 0, in m"));
        }
        if !sizes.iter().chain(&numbers).all(|x| x.is_finite()) {
            return Err(("a number is not finite".into(), "give finite numbers, in m"));
        }
        Ok(solid)
    }
}

fn axes([roll, pitch, yaw]: [f64; 3]) -> [[f64; 3]; 3] {
    let rotation = Rotation3::from_euler_angles(roll, pitch, yaw).into_inner();
    [0, 1, 2].map(|i| rotation.column(i).into_owned().into())
}

impl BoxTable {
    fn solid(&self) -> Solid {
        let half = self.size.map(|side| 0.5 * side);
        Solid::Box { centre: self.centre, axes: axes(self.rpy), half }
    }
}

impl MeshTable {
    /// Returns the box around a mesh along the axes of its file.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding: the box contains the mesh, for its vertices as loaded and axes of
    /// its frame that are rounded.
    fn around(&self, folder: &Path) -> core::result::Result<Solid, Problem> {
        let name = self.file.display();
        let all = vertices(&folder.join(&self.file))
            .map_err(|(problem, remedy)| (format!("the mesh `{name}` {problem}"), remedy))?;
        if !(self.scale > 0.0 && self.scale.is_finite()) {
            return Err((format!("scale = {}", self.scale), "give a finite number above 0"));
        }
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for (vertex, i) in all.iter().flat_map(|vertex| (0..3).map(move |i| (vertex, i))) {
            low[i] = low[i].min(mul_down(self.scale, vertex[i]));
            high[i] = high[i].max(mul_up(self.scale, vertex[i]));
        }
        let axes = axes(self.rpy);
        let middle = [0, 1, 2].map(|i| 0.5 * (low[i] + high[i]));
        let place = (0..3).fold(point(self.position), |place, i| {
            add(&place, &scaled(&point(axes[i]), Interval::point(middle[i])))
        });
        let centre = place.map(Interval::mid);
        // The axes are orthonormal but for rounding, so that twice the error of the centre along
        // each of them covers it.
        let error = 2.0 * norm(&sub(&place, &point(centre)));
        let half = [0, 1, 2]
            .map(|i| add_up(sub_up(high[i], middle[i]).max(sub_up(middle[i], low[i])), error));
        Ok(Solid::Box { centre, axes, half })
    }
}
