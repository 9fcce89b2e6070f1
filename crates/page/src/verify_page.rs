//! The page of a verification: verdicts, and the worst motion in three dimensions.

use maud::{Markup, PreEscaped, html};
use reachtube_files::distinct_names;
use reachtube_finding::{Finding, Report};
use reachtube_pipeline::Verified;
use reachtube_scalar::number::counted;
use reachtube_verify::{Answer, Body, Scene, Verification, worst_first};

use crate::html::warning_list;
use crate::interactive::in_script;
use crate::library::compressed_library;
use crate::motion_scene::{MotionScene, closest_pair};
use crate::picture::picture;
use crate::skeleton::{document, fact_table, section, table, verdict};
use crate::terms::Explained;
use crate::text::Text;

/// The file name of the page.
pub const VERIFY_PAGE_FILE: &str = "verify.html";

const SCRIPT: &str = include_str!("view.js");

/// Returns files by their names: a picture of each motion, the simulated motion that comes closest
/// of each that is not safe, and the page, [`VERIFY_PAGE_FILE`], last.
#[must_use]
pub fn verify_files(verified: &Verified) -> Vec<(String, String)> {
    let Verified { motions, body, scene, .. } = verified;
    let names = distinct_names(motions.iter().map(|one| one.reach.name()), &["", "_closest"]);
    let of_motion = |(one, name): (&Verification, String)| {
        let drawn = (format!("{name}.svg"), picture(one, body, scene));
        let found = one.closest.as_ref();
        let csv = found.map(|found| (format!("{name}_closest.csv"), verified.csv(found)));
        [drawn].into_iter().chain(csv)
    };
    let page = (VERIFY_PAGE_FILE.into(), verify_html(verified));
    motions.iter().zip(names).flat_map(of_motion).chain([page]).collect()
}

/// Returns the page as one HTML file that needs no other file. Without scripts it has the verdicts
/// and a static picture.
fn verify_html(verified: &Verified) -> String {
    let Verified { motions: all, body, scene, .. } = verified;
    let warnings = &verified.warnings;
    let Report { sections } = verified.report();
    let mut findings = sections.iter().flat_map(|section| &section.findings);
    let sentence = findings.next().map_or("", |verdict| &verdict.text);
    let texts: Vec<String> = warnings.iter().map(|warning| warning.text.clone()).collect();
    let order = worst_first(all);
    let worst = order.first().copied();
    let content = html! {
        (verdict(class(worst.map(|worst| worst.answer), warnings), sentence))
        @for other in findings { p { (Explained(&other.text)) } }
        @if !warnings.is_empty() { (section("Warnings", &warning_list(&texts))) }
        @if let Some(worst) = worst {
            (section("The worst motion", &shown(worst, body, scene)))
        }
        (section("All motions", &html! {
            @for part in &sections {
                @for one in &part.tables { (table("sets", one)) }
                @if !part.facts.is_empty() { (fact_table(&part.facts)) }
            }
        }))
    };
    let scripts = worst.map_or_else(Markup::default, |worst| {
        let drawn = MotionScene::new(worst, body, scene);
        let data = serde_json::to_string(&drawn).expect("numbers are finite");
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
    document("Do the links stay clear?", &subtitle, &content, &scripts)
}

fn class(answer: Option<Answer>, warnings: &[Finding]) -> &'static str {
    match answer {
        Some(Answer::Safe) if warnings.is_empty() => "ok",
        Some(Answer::Unsafe) => "bad",
        _ => "doubtful",
    }
}

/// Returns a motion: its static picture, and the elements that the script fills.
fn shown(worst: &Verification, body: &Body, scene: &Scene) -> Markup {
    let pair = closest_pair(worst);
    // What the worst stop sweeps would hide a witness that is stopped.
    let is_stopped = worst.closest.as_ref().is_some_and(|found| found.stop.is_some());
    html! {
        p {
            (Text(&worst.case))
            @if let Some((link, obstacle)) = pair {
                ": the closest pair is the link of " strong { (Text(link)) }
                " and " strong { (Text(obstacle)) } "."
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
        div.wide { (PreEscaped(picture(worst, body, scene))) }
    }
}
