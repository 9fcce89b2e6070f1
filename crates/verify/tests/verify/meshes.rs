//! Capsules around the collision meshes of a URDF.

use std::path::Path;

use nalgebra::{Rotation3, Vector3};
use reachtube_robot::{Urdf, UrdfOptions};
use reachtube_verify::{Capsule, Capsules};

use crate::common::{Random, distance};

type Triangle = [[f32; 3]; 3];

/// A binary STL file, whose header may begin like a text.
fn binary(triangles: &[Triangle], header: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(u32::try_from(triangles.len()).unwrap().to_le_bytes());
    for triangle in triangles {
        let numbers = [0.0f32; 3].iter().chain(triangle.iter().flatten());
        numbers.for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend([0, 0]);
    }
    bytes
}

fn text(triangles: &[Triangle], name: &str) -> Vec<u8> {
    let mut text = format!("solid{name}\n");
    for triangle in triangles {
        text += "facet normal 0 0 1\nouter loop\n";
        triangle.iter().for_each(|[x, y, z]| text += &format!("vertex {x} {y} {z}\n"));
        text += "endloop\nendfacet\n";
    }
    (text + "endsolid\n").into_bytes()
}

/// An arm of one link with a mesh in a folder of its own.
fn arm(folder: &Path, mesh: &str, origin: &str) -> Result<Vec<Capsule>, String> {
    let text = format!(
        "<robot name=\"arm\"><link name=\"base\"/><link name=\"arm\"><inertial>\
         <mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial><collision>{origin}\
         <geometry>{mesh}</geometry></collision></link><joint name=\"hinge\" type=\"continuous\">\
         <parent link=\"base\"/><child link=\"arm\"/></joint></robot>"
    );
    let urdf = Urdf::parse(&text, "arm.urdf", &UrdfOptions::default()).unwrap();
    let capsules = Capsules::of_urdf(&urdf, folder).map_err(|e| e.to_string())?;
    Ok(capsules.as_slice().to_vec())
}

fn reaches(capsule: &Capsule, p: Vector3<f64>) -> f64 {
    distance(p, [capsule.from, capsule.to].map(Vector3::from))
}

#[test]
fn a_capsule_contains_each_vertex_of_a_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let scale = [0.002, 0.001, 0.001];
    let mesh = "<mesh filename=\"package://arm/a.stl\" scale=\"0.002 0.001 0.001\"/>";
    let origin = "<origin xyz=\"0.1 -0.2 0.3\" rpy=\"0.4 -0.5 0.6\"/>";
    let turned = Rotation3::from_euler_angles(0.4, -0.5, 0.6);
    let below = folder.path().join("urdf");
    std::fs::create_dir(&below).unwrap();
    for seed in 0..20 {
        let mut random = Random::new(seed);
        let sizes = [1.0, 200.0, 500.0].map(|size| size * (0.6 + 0.5 * random.signed()));
        let triangles: Vec<Triangle> = (0..30)
            .map(|_| [(); 3].map(|()| sizes.map(|size| (size * random.signed()) as f32)))
            .collect();
        let forms = [
            binary(&triangles, b"solid made by a tool"),
            binary(&triangles, b"mesh"),
            text(&triangles, " part"),
            text(&triangles, ""),
        ];
        let found = forms.map(|bytes| {
            std::fs::write(folder.path().join("a.stl"), bytes).unwrap();
            // The package is sought upwards, with its name and without.
            arm(&below, mesh, origin).unwrap()[0]
        });
        assert!(found.iter().all(|one| one == &found[0]), "{seed} {found:?}");
        let vertices = triangles.iter().flatten().map(|vertex| {
            let local = Vector3::from_fn(|i, _| scale[i] * f64::from(vertex[i]));
            turned * local + Vector3::new(0.1, -0.2, 0.3)
        });
        let furthest = vertices.map(|p| reaches(&found[0], p)).fold(0.0, f64::max);
        let radius = found[0].radius;
        assert!(furthest <= radius && furthest > radius - 1e-12, "{seed} {furthest} {radius}");
    }
}

#[test]
fn a_capsule_around_a_tube_has_its_radius() {
    let folder = tempfile::tempdir().unwrap();
    let ring = |k: usize, z: f64| {
        let (sin, cos) = (k as f64 * 0.1).sin_cos();
        [0.05 * cos, 0.05 * sin, z].map(|x| x as f32)
    };
    let triangles: Vec<Triangle> =
        (0..63).map(|k| [ring(k, -0.15), ring(k + 1, 0.15), ring(k, 0.15)]).collect();
    std::fs::write(folder.path().join("a.stl"), binary(&triangles, b"")).unwrap();
    let capsule = arm(folder.path(), "<mesh filename=\"a.stl\"/>", "").unwrap()[0];
    let length = (Vector3::from(capsule.from) - Vector3::from(capsule.to)).norm();
    assert!((0.0499..0.0515).contains(&capsule.radius), "{capsule:?}");
    assert!(length < 0.301, "{capsule:?}");
}

#[test]
fn a_mesh_that_cannot_be_used_is_refused_with_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    let refused = |name: &str, parts: &[&str]| {
        let error = arm(folder.path(), &format!("<mesh filename=\"{name}\"/>"), "").unwrap_err();
        let known = [format!("the collision mesh `{name}` of link `arm`"), "TOML file".into()];
        let parts = parts.iter().copied().chain(known.iter().map(String::as_str));
        parts.for_each(|part| assert!(error.contains(part), "{part}: {error}"));
    };
    refused("none.stl", &["is not found from the folder", "put it there"]);
    refused("package://arm/none.stl", &["is not found"]);
    place("a.dae", b"<COLLADA/>");
    refused("a.dae", &["format `dae`", "export the mesh as STL"]);
    let whole = binary(&[[[0.0; 3], [1.0; 3], [2.0; 3]]], b"");
    place("short.stl", &whole[..whole.len() - 1]);
    refused("short.stl", &["is not a complete STL file", "again"]);
    place("word.stl", b"solid part\nfacet normal 0 0 one\n");
    refused("word.stl", &["is not a complete STL file"]);
    place("none.stl", b"");
    refused("none.stl", &["is not a complete STL file"]);
    place("empty.stl", &binary(&[], b""));
    refused("empty.stl", &["has no triangle"]);
    place("nan.stl", &binary(&[[[f32::NAN; 3]; 3]], b""));
    refused("nan.stl", &["not finite"]);
}
