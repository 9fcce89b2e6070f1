//! A small invented result, for the tests of this module.

use super::chart::{Chart, Series};
use super::page::{JointSets, Lead, Page, SetsTable, Verdict};
use super::suite_figure::{Band, Nominal, RunTrace, SuiteFigure, TightSpot};
use reachtube_conform::data::Side;
use reachtube_finding::Table;
use reachtube_robot::JointKind;

/// Returns a suite of sine motions with three runs, two bands, and two tight spots.
pub(super) fn suite(name: &str, joints: usize) -> SuiteFigure {
    let times: Vec<f64> = (0..201).map(|k| f64::from(k) * 0.01).collect();
    let nominal: Vec<Vec<f64>> = (0..2 * joints).map(|state| wave(&times, state)).collect();
    let band = |label: &str, start: f64, growth: f64| {
        let edge = |sign: f64| {
            let shift = |(x, t): (&f64, &f64)| x + sign * (start + growth * t);
            nominal.iter().map(|row| row.iter().zip(&times).map(shift).collect()).collect()
        };
        Band { label: label.into(), lower: edge(-1.0), upper: edge(1.0) }
    };
    let run = |order: usize| {
        let drift = 0.04 * (order as f64 - 2.0);
        let shift = |(x, t): (&f64, &f64)| x + drift * t;
        RunTrace {
            name: format!("run {order}"),
            order,
            temperature: None,
            temperatures: Vec::new(),
            gauge: Some(0.3 * order as f64),
            times: times.clone(),
            states: nominal.iter().map(|row| row.iter().zip(&times).map(shift).collect()).collect(),
            touches: order,
        }
    };
    SuiteFigure {
        suite: name.into(),
        joints: (1..=joints).map(|joint| format!("joint {joint}")).collect(),
        kinds: vec![JointKind::Revolute; joints],
        band: band("position and velocity conformant", 0.01, 0.05),
        inner: Some(band("position conformant", 0.005, 0.045)),
        runs: (1..=3).map(run).collect(),
        tight: vec![
            TightSpot {
                run: 2,
                time_s: 1.5,
                state: joints - 1,
                side: Side::Upper,
                margin: 1.25e-6,
            },
            TightSpot { run: 0, time_s: 1.0, state: 0, side: Side::Lower, margin: 0.0 },
        ],
        positions_only: false,
        nominal: Nominal::Shared(nominal),
        outside: 0,
        undrawn: 0,
        furthest: Some(0.9),
        gauges: Vec::new(),
        times,
    }
}

fn wave(times: &[f64], state: usize) -> Vec<f64> {
    times.iter().map(|t| (t * (1.0 + state as f64)).sin()).collect()
}

pub(super) fn sets(joints: usize) -> SetsTable {
    let row = |joint| JointSets {
        joint: format!("joint {joint}"),
        kind: JointKind::Revolute,
        x0_q: [-0.0030, 0.0030],
        x0_qd: [-0.0317, 1.2140],
        u: [-2.7201, 3.6017],
        noise: Some([[-1e-5, 1e-5], [0.0, 0.0]]),
    };
    SetsTable {
        notion: "position and velocity conformant".into(),
        joints: (1..=joints).map(row).collect(),
    }
}

/// Returns a whole page in which every text contains markup.
pub(super) fn page() -> Page {
    let hostile = |what: &str| format!("{what} <script>alert(\"x\")</script> & 'more'");
    Page {
        title: hostile("title"),
        subtitle: hostile("subtitle"),
        phase_planes: vec![phase_plane()],
        cost: vec![Table { title: "drivers".into(), ..Table::default() }],
        cost_charts: vec![phase_plane()],
        verdict: Verdict {
            vacuous: false,
            useful: None,
            ok: true,
            words: hostile("words"),
            warnings: vec![hostile("warning")],
            proved: vec![hostile("proved")],
            not_proved: vec![hostile("not proved")],
        },
        lead: Lead {
            badges: vec![hostile("badge")],
            facts: vec![(hostile("fact"), hostile("number"))],
            figure: Some(phase_plane()),
            caption: hostile("caption"),
            links: vec![(hostile("link"), "../held-out/report.html".into())],
        },
        suites: vec![suite(&hostile("A"), 2), suite("B", 7)],
        nominal: vec![
            Table::new([hostile("header")], vec![vec![hostile("cell")]]).titled(hostile("table")),
        ],
        sets: vec![sets(2)],
        facts: vec![(hostile("name"), hostile("value"))],
        trust: vec![hostile("trust")],
        caution: vec![hostile("caution")],
        notes: vec![hostile("note")],
    }
}

/// Returns a phase plane with a set and two points.
fn phase_plane() -> Chart {
    let corners = vec![(-0.5, 0.0), (0.0, -0.5), (0.5, 0.0), (0.0, 0.5), (-0.5, 0.0)];
    let dots = Series::dots(vec![(0.1, 0.2), (0.3, 0.1)], [222, 110, 0]);
    let series = vec![Series::line(corners, [18, 70, 200]), dots];
    Chart::new("joint 1, 0.500 s", "position [rad]", "velocity [rad/s]", series)
}
