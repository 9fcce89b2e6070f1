//! Capsules read from TOML and made of a URDF's shapes.

use std::path::Path;

use nalgebra::Vector3;
use reachtube_robot::{Robot, Shape, Urdf, UrdfOptions};
use reachtube_verify::{Capsules, Error};

use crate::common::{Random, askew, distance};

fn refused(text: &str) -> String {
    Capsules::from_toml(text, "arm.toml", &Robot::lwa4p()).unwrap_err().to_string()
}

fn capsule(lines: &str) -> String {
    format!("\n[[capsule]]\n{lines}\n")
}

#[test]
fn a_wrong_capsule_is_refused_with_its_line_and_a_remedy() {
    let rest = "from = [0, 0, 0]\nto = [0, 0, 0.1]\n";
    let error = refused(&capsule(&format!("link = 7\n{rest}radius = 0.1")));
    assert_eq!(
        error,
        "arm.toml:3: capsule 1: there is no link 7; give a number from 1 to 6, or one of \
         `joint1`, `joint2`, `joint3`, `joint4`, `joint5`, `joint6`"
    );
    let error = refused(&capsule(&format!("link = \"elbow\"\n{rest}radius = 0.1")));
    assert!(error.contains("no joint is named `elbow`"), "{error}");
    for radius in ["0.0", "-0.1", "nan", "inf"] {
        let error = refused(&capsule(&format!("link = 1\n{rest}radius = {radius}")));
        assert!(error.starts_with("arm.toml:6: capsule 1: radius = "), "{error}");
    }
    let error = refused(&capsule("link = 1\nfrom = [nan, 0, 0]\nto = [0, 0, 0]\nradius = 0.1"));
    assert!(error.contains("an end point is not finite"), "{error}");
    assert!(refused("").starts_with("arm.toml:1: there is no [[capsule]]"));
    assert!(refused(&capsule("link = 1\nradius = 0.1")).contains("missing field"));
    assert!(
        refused(&capsule(&format!("link = 1\n{rest}radius = 0.1\nlength = 2"))).contains("length")
    );
}

#[test]
fn a_capsule_contains_the_shape_that_it_was_made_of() {
    let urdf = askew();
    let shapes = urdf.collision_shapes().unwrap();
    let capsules = Capsules::of_urdf(&urdf, Path::new("")).unwrap();
    let joints: Vec<_> = shapes.iter().map(|shape| (shape.link.as_str(), shape.joint)).collect();
    assert_eq!(joints, [("a", 0), ("b", 1), ("d", 2)]);
    // The link d is fixed to c, at the end of the chain.
    assert_eq!(shapes[2].placement.translation, Vector3::new(0.1, 0.0, 0.2));
    let mut random = Random::new(3);
    for (shape, capsule) in shapes.iter().zip(capsules.as_slice()) {
        let mut furthest = 0.0f64;
        for _ in 0..2000 {
            let [x, y, z] = [(); 3].map(|()| random.signed());
            let local = match shape.shape {
                Shape::Box { size: [a, b, c] } => {
                    0.5 * Vector3::new(a * x.signum(), b * y.signum(), c * z.signum())
                }
                Shape::Cylinder { radius, length } => {
                    let (sin, cos) = (4.0 * x).sin_cos();
                    Vector3::new(radius * cos, radius * sin, 0.5 * length * z)
                }
                Shape::Sphere { radius } => radius * Vector3::new(x, y, z).normalize(),
                Shape::Mesh { .. } => unreachable!(),
            };
            let p = shape.placement.rotation * local + shape.placement.translation;
            let needed = distance(p, [capsule.from, capsule.to].map(Vector3::from));
            assert!(needed <= capsule.radius * (1.0 + 1e-14), "{} {needed}", shape.link);
            furthest = furthest.max(needed);
        }
        assert!(furthest > 0.999 * capsule.radius, "{} {furthest}", shape.link);
    }
}

#[test]
fn wrong_shapes_and_a_robot_without_any_are_refused() {
    let of = |collision: &str| {
        let text = format!(
            "<robot name=\"arm\"><link name=\"base\"/><link name=\"arm\"><inertial>\
             <mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial>{collision}\
             </link><joint name=\"hinge\" type=\"continuous\"><parent link=\"base\"/>\
             <child link=\"arm\"/></joint></robot>"
        );
        let urdf = Urdf::parse(&text, "arm.urdf", &UrdfOptions::default()).unwrap();
        Capsules::of_urdf(&urdf, Path::new("")).unwrap_err()
    };
    let shape = |shape: &str| format!("<collision><geometry>{shape}</geometry></collision>");
    assert!(matches!(of(""), Error::NoCapsules { .. }));
    for wrong in ["<box size=\"1 0 1\"/>", "<sphere radius=\"-1\"/>", "<sphere/>", "<cone/>"] {
        let error = of(&shape(wrong)).to_string();
        assert!(error.starts_with("arm.urdf:1: link `arm`"), "{error}");
    }
    let other = Robot::from_description(&{
        let mut description = Robot::lwa4p().description().clone();
        description.name = "another arm".into();
        description
    });
    let error = Capsules::embedded(&other.unwrap()).unwrap_err().to_string();
    assert!(error.contains("`another arm`"), "{error}");
}
