//! The page of a verification: verdicts, and the worst motion in three dimensions.

use std::io::Write;

use maud::{Markup, PreEscaped, html};
use reachtube_finding::Finding;
use reachtube_scalar::number::counted;
use reachtube_verify::{
    Answer, Body, Obstacle, Scene, Solid, SweptCapsule, Verification, picture, summary, worst_first,
};
use serde::Serialize;

use crate::error::Error;
use crate::html::warning_list;
use crate::interactive::in_script;
use crate::library::compressed_library;
use crate::skeleton::{document, laid_out, section, verdict};
use crate::terms::Explained;
use crate::text::Text;

/// The file name of the page.
pub const VERIFY_PAGE_FILE: &str = "verify.html";

/// Number of times at which the worst motion is shown, and of steps of a stop, at most.
const FRAMES: usize = 60;

const SCRIPT: &str = include_str!("view.js");

/// The contents of the page.
#[derive(Debug, Clone, Copy)]
pub struct VerifyPage<'a> {
    /// The verdicts about the motions.
    pub all: &'a [Verification],
    /// The links.
    pub body: &'a Body,
    /// The obstacles that they must stay clear of.
    pub scene: &'a Scene,
    /// Why the verdicts say less of the robot than of the model.
    pub warnings: &'a [Finding],
}

/// The worst motion, for the script.
#[derive(Serialize)]
struct View<'a> {
    frames: Vec<Frame>,
    /// The steps of the worst stop.
    stop: Vec<Frame>,
    obstacles: Vec<ObstacleData<'a>>,
    /// The capsules of the link in the closest pair.
    link: Vec<usize>,
    /// The obstacle in the closest pair.
    obstacle: Option<&'a str>,
    /// The time that is shown first.
    first: usize,
}

/// The arm at a time.
#[derive(Serialize)]
struct Frame {
    time: f64,
    /// Capsules that contain the links over the step.
    swept: Vec<[f64; 7]>,
    /// The nominal motion, of a stop at its start.
    nominal: Vec<[f64; 7]>,
    /// The closest motion that was found.
    closest: Vec<[f64; 7]>,
}

#[derive(Serialize)]
struct ObstacleData<'a> {
    name: &'a str,
    solid: &'a Solid,
    speed: f64,
}

/// Writes the page as one HTML file that needs no other file. Without scripts it has the verdicts
/// and a static picture.
///
/// # Errors
///
/// Fails where `out` fails.
pub fn write_verify_html(page: &VerifyPage, out: &mut impl Write) -> Result<(), Error> {
    let VerifyPage { all, body, scene, warnings } = *page;
    let (sentences, tables) = summary(all, body, scene);
    let (sentence, others) = sentences.split_first().expect("there is a verdict");
    let texts: Vec<String> = warnings.iter().map(|warning| warning.text.clone()).collect();
    let order = worst_first(all);
    let worst = order.first().copied();
    let content = html! {
        (verdict(class(worst.map(|worst| worst.answer), warnings), sentence))
        @for other in others { p { (Explained(other)) } }
        @if !warnings.is_empty() { (section("Warnings", &warning_list(&texts))) }
        @if let Some(worst) = worst {
            (section("The worst motion", &shown(worst, page)))
        }
        (section("All motions", &html! { @for table in &tables { (laid_out(table)) } }))
    };
    let scripts = worst.map_or_else(Markup::default, |worst| {
        let data = serde_json::to_string(&view(worst, page)).expect("numbers are finite");
        html! {
            script type="application/json" id="view-data" { (PreEscaped(in_script(&data))) }
            script { (PreEscaped("\n")) (PreEscaped(SCRIPT)) }
            script type="text/plain" id="library" { (PreEscaped(compressed_library())) }
        }
    });
    let subtitle = format!(
        "{} against {}: motions of the model, and where its links can be",
        counted(all.len(), "motion"),
        counted(scene.obstacles.len(), "obstacle")
    );
    let document = document("Do the links stay clear?", &subtitle, &content, &scripts);
    out.write_all(document.as_bytes())?;
    Ok(())
}

/// Returns the colour of a verdict.
fn class(answer: Option<Answer>, warnings: &[Finding]) -> &'static str {
    match answer {
        Some(Answer::Safe) if warnings.is_empty() => "ok",
        Some(Answer::Unsafe) => "bad",
        _ => "doubtful",
    }
}

/// Returns a motion: its static picture, and the elements that the script fills.
fn shown(worst: &Verification, page: &VerifyPage) -> Markup {
    let pair = closest_pair(worst);
    // What the worst stop sweeps would hide a witness that is stopped.
    let is_stopped = worst.closest.as_ref().is_some_and(|found| found.stop.is_some());
    html! {
        p {
            (Text(&worst.case))
            @if let Some((link, obstacle)) = pair {
                ": the closest pair is the link of " strong { (Text(link)) }
                " and " strong { (Text(obstacle)) } ", drawn in red."
            }
        }
        div #view hidden {
            div #scene style="height: min(36rem, 110vw)" {}
            p {
                label {
                    "Time: " output #time {} " "
                    input #slider type="range" min="0" value="0" style="width: min(30rem, 60vw)";
                }
            }
            p {
                label { input #whole type="checkbox"; " swept over the whole motion " }
                @if worst.stops.is_some() {
                    label {
                        input #stopped type="checkbox" checked[!is_stopped];
                        " swept over the worst stop "
                    }
                }
            }
            p.hint {
                "Blue: the nominal motion. Grey: what contains the links on all motions of the \
                 model. Orange: the worst stop, at the end of the slider. Red: the closest pair, \
                 and the closest motion that was found. Brown: obstacles at that time; a \
                 half-space is drawn as a plane."
            }
        }
        div.wide { (PreEscaped(picture(worst, page.body, page.scene))) }
    }
}

/// Returns link and obstacle of the smallest distance.
fn closest_pair(worst: &Verification) -> Option<(&str, &str)> {
    let stop = worst.stops.as_ref().and_then(|stops| stops.clearances.first());
    let motion = worst.clearances.first();
    match (&worst.closest, stop, motion) {
        (Some(found), ..) => Some((&found.link, &found.obstacle)),
        (None, Some(stop), Some(motion)) if stop.distance > motion.distance => {
            Some((&motion.link, &motion.obstacle))
        }
        (None, Some(stop), _) => Some((&stop.link, &stop.obstacle)),
        (None, None, motion) => motion.map(|pair| (&*pair.link, &*pair.obstacle)),
    }
}

fn view<'a>(worst: &'a Verification, page: &VerifyPage<'a>) -> View<'a> {
    let VerifyPage { body, scene, .. } = *page;
    let reach = &worst.reach;
    let occupancy = body.occupancy(&reach.times, &reach.tube);
    let width = reach.dimension;
    let at = |states: &[f64], k: usize| {
        let q = states.get(k * width..k * width + body.joint_count());
        q.map_or_else(Vec::new, |q| numbers(&body.placed(q)))
    };
    let found = worst.closest.as_ref();
    let found_at = |time: f64| {
        found.map_or_else(Vec::new, |found| {
            numbers(&body.placed(&found.at(time)[..body.joint_count()]))
        })
    };
    let frame = |k: usize| Frame {
        time: reach.times[k],
        swept: numbers(occupancy.step(k)),
        nominal: at(&reach.nominal, k),
        closest: found_at(reach.times[k]),
    };
    let stride = occupancy.len().div_ceil(FRAMES).max(1);
    let frames: Vec<Frame> = (0..occupancy.len()).step_by(stride).map(frame).collect();
    let stop = worst.stops.as_ref().and_then(|stops| stops.worst.as_ref());
    let stop = stop.map_or_else(Vec::new, |(from, stop)| {
        let occupancy = body.occupancy(&stop.times, &stop.tube);
        let stride = occupancy.len().div_ceil(FRAMES / 3).max(1);
        let start = reach.times.iter().position(|time| time >= from).unwrap_or(0);
        let is_found = found.and_then(|found| found.stop.as_ref()).is_some_and(|s| s.from == *from);
        let frame = |k: usize| Frame {
            time: from + stop.times[k],
            swept: numbers(occupancy.step(k)),
            nominal: at(&reach.nominal, start),
            closest: if is_found { found_at(from + stop.times[k]) } else { Vec::new() },
        };
        (0..occupancy.len()).step_by(stride).map(frame).collect()
    });
    let pair = closest_pair(worst);
    let is_link = |k: &usize| {
        pair.is_some_and(|(link, _)| body.joint_name(body.capsules()[*k].joint) == link)
    };
    let time = found.map(|found| found.time);
    let time = time.or_else(|| Some(worst.clearances.first()?.time)).unwrap_or(0.0);
    let data = |obstacle: &'a Obstacle| ObstacleData {
        name: &obstacle.name,
        solid: &obstacle.solid,
        speed: obstacle.speed,
    };
    View {
        first: first_shown(&frames, &stop, time),
        frames,
        stop,
        obstacles: scene.obstacles.iter().map(data).collect(),
        link: (0..body.capsules().len()).filter(is_link).collect(),
        obstacle: pair.map(|(_, obstacle)| obstacle),
    }
}

/// Returns the index of the frame that is shown first: in the stop if the closest motion is stopped
/// there.
fn first_shown(frames: &[Frame], stop: &[Frame], time: f64) -> usize {
    let before = |frames: &[Frame]| frames.iter().rposition(|frame| frame.time <= time);
    match before(stop) {
        Some(k) if !stop[k].closest.is_empty() => frames.len() + k,
        _ => before(frames).unwrap_or(0),
    }
}

/// Returns ends and radius of each capsule in 0.1 mm, as the view draws them; none if one has no
/// bound.
fn numbers(capsules: &[SweptCapsule]) -> Vec<[f64; 7]> {
    let rounded = |capsule: &SweptCapsule| {
        let ([a, b, c], [d, e, f]) = (capsule.from, capsule.to);
        [a, b, c, d, e, f, capsule.radius].map(|x| (x * 1e4).round() / 1e4)
    };
    let all: Vec<[f64; 7]> = capsules.iter().map(rounded).collect();
    if all.iter().flatten().all(|x| x.is_finite()) { all } else { Vec::new() }
}
