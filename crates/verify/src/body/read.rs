//! Capsules as TOML.

use reachtube_robot::Robot;
use serde::Deserialize;
use toml::Spanned;

use crate::body::capsule::Capsule;
use crate::error::{Error, Result, line_of};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    capsule: Vec<Spanned<Table>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    link: Spanned<LinkName>,
    from: [f64; 3],
    to: [f64; 3],
    radius: Spanned<f64>,
}

/// A link, by the joint that moves it.
#[derive(Deserialize)]
#[serde(untagged)]
enum LinkName {
    Number(i64),
    Joint(String),
}

pub(super) fn parse(text: &str, origin: &str, robot: &Robot) -> Result<Vec<Capsule>> {
    let file: File = toml::from_str(text)
        .map_err(|e| Error::Syntax { origin: origin.into(), message: e.to_string() })?;
    let invalid = |at: usize, place: String, problem: String, remedy: String| Error::Invalid {
        origin: origin.into(),
        line: line_of(text, at),
        place,
        problem,
        remedy,
    };
    if file.capsule.is_empty() {
        let (problem, remedy) = ("there is no [[capsule]]", "give at least one per moving link");
        return Err(invalid(0, String::new(), problem.into(), remedy.into()));
    }
    let capsule = |(index, table): (usize, Spanned<Table>)| {
        let place = format!("capsule {}: ", index + 1);
        let start = table.span().start;
        let Table { link, from, to, radius } = table.into_inner();
        let joint = joint_of(link.get_ref(), robot).ok_or_else(|| {
            let names: Vec<_> = robot.joints().iter().map(|j| format!("`{}`", j.name)).collect();
            let problem = match link.get_ref() {
                LinkName::Number(number) => format!("there is no link {number}"),
                LinkName::Joint(name) => format!("no joint is named `{name}`"),
            };
            let count = robot.joint_count();
            let remedy = format!("give a number from 1 to {count}, or one of {}", names.join(", "));
            invalid(link.span().start, place.clone(), problem, remedy)
        })?;
        if !(*radius.get_ref() > 0.0 && radius.get_ref().is_finite()) {
            let problem = format!("radius = {}", radius.get_ref());
            let remedy = "give a finite number above 0, in m".into();
            return Err(invalid(radius.span().start, place, problem, remedy));
        }
        if !from.iter().chain(&to).all(|x| x.is_finite()) {
            let remedy = "give finite numbers, in m".into();
            return Err(invalid(start, place, "an end point is not finite".into(), remedy));
        }
        Ok(Capsule { joint, from, to, radius: *radius.get_ref() })
    };
    file.capsule.into_iter().enumerate().map(capsule).collect()
}

fn joint_of(link: &LinkName, robot: &Robot) -> Option<usize> {
    match link {
        LinkName::Number(number) => {
            let index = usize::try_from(*number).ok()?.checked_sub(1)?;
            (index < robot.joint_count()).then_some(index)
        }
        LinkName::Joint(name) => robot.joints().iter().position(|joint| joint.name == *name),
    }
}
