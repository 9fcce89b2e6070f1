//! The certificate of membership: for each recorded point, what another program needs to prove
//! that it lies in the reachable set.

use std::io::{self, Write};

use rayon::prelude::*;
use reachtube_reach::Disturbance;
use serde::Serialize;

use crate::claim::sample_points::{SamplePoints, points};
use crate::claim::sample_set::{CentredPoints, Factors, SampleSet};
use crate::data::notion::Notion;
use crate::data::problem::Problem;
use crate::error::{Error, Result};
use crate::model::file::Model;
use crate::sets::UncertaintySets;
use crate::tube::linear::{Linear, PARTS};

/// What the field `format` of every certificate says.
pub(crate) const CERTIFICATE_FORMAT: &str = "reachtube-certificate";

/// The first line of a certificate.
#[derive(Debug, Serialize)]
struct Head<'a> {
    format: &'a str,
    version: u32,
    notion: Notion,
    /// SHA-256 of the model file's content.
    model_sha256: &'a str,
    /// Equal parts of a sample over which a disturbance is held.
    parts: usize,
}

/// One point.
#[derive(Debug, Serialize)]
struct Line<'a> {
    suite: &'a str,
    run: &'a str,
    sample: usize,
    /// The states of the projection, from 0.
    states: &'a [usize],
    /// Number of steps over which the disturbances of the generators are held.
    held: usize,
    /// What the factors are kept to.
    limit: f64,
    /// The factors are clip(gᵀ y), with one entry of y for each state of the projection.
    y: Vec<f64>,
}

/// The certificate of a model's own recordings, line by line.
#[derive(Debug)]
pub struct Certificate {
    lines: Vec<String>,
}

impl Certificate {
    /// Finds the factors of every recorded point of a problem that lies in the reachable set of
    /// `model`. Points that were not proved have no line. Some 200 bytes stay in memory for each
    /// point.
    ///
    /// # Guarantee
    ///
    /// None: the certificate only says where to look, and the program that reads it proves.
    ///
    /// # Errors
    ///
    /// [`Error::NotPoints`] for the notion hull and models that are not linear; as
    /// [`Problem::run`].
    pub fn new(problem: &Problem, model: &Model) -> Result<Self> {
        let notion = problem.settings().notion;
        if !notion.asks_points() || problem.dynamics().linear_system().is_none() {
            return Err(Error::NotPoints);
        }
        // The certificate is about the points, not the motions through them.
        let (plant, points, sets) = (Linear::new(problem)?, points(problem)?, model.sets());
        let is_measurable = problem.settings().disturbance == Disturbance::Measurable;
        let head = Head {
            format: CERTIFICATE_FORMAT,
            version: 1,
            notion,
            model_sha256: &model.sha256,
            parts: if is_measurable { PARTS } else { 1 },
        };
        let of_sample = |at: &SamplePoints| lines(problem, &plant, &sets, at);
        let samples: Vec<Vec<String>> = points.par_iter().map(of_sample).collect();
        Ok(Self {
            lines: std::iter::once(json(&head)).chain(samples.into_iter().flatten()).collect(),
        })
    }

    /// Writes the certificate: JSON, one object a line.
    ///
    /// # Errors
    ///
    /// Returns the errors of `out`.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        self.lines.iter().try_for_each(|line| writeln!(out, "{line}"))
    }
}

fn lines(
    problem: &Problem,
    plant: &Linear,
    sets: &UncertaintySets,
    at: &SamplePoints,
) -> Vec<String> {
    let slice = plant.slice(sets, at.place());
    let points = CentredPoints::new(at, &slice);
    let mut lines = Vec::new();
    for states in &problem.projections() {
        let (proved, _) = SampleSet::new(&slice, states).prove(&points, |point, factors| {
            let Factors { held, limit, set, work } = factors;
            let (suite, run) = at.owners[point];
            json(&Line {
                suite: &problem.recordings().suites[suite as usize].entry.name,
                run: &problem.entry(run as usize).file,
                sample: at.sample,
                states,
                held,
                limit,
                y: work.multipliers(set),
            })
        });
        lines.extend(proved);
    }
    lines
}

fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).expect("a line has string keys")
}
