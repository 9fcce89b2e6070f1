//! What the paper says of its experiment, laid beside what came out here.

use reachtube_abstraction::ModelKind;
use reachtube_conform::Notion;
use reachtube_conform::settings::States;
use serde::Serialize;

use super::coverage::{Coverage, CoverageRow};
use super::exemplary::Exemplary;
use super::paper::Paper;
use super::speed::Speed;
use super::table1::Table1;
use super::table2::{Table2, Table2Case};
use super::table3::{Table3, Table3Row};
use reachtube_scalar::number::four_decimals;

/// Sizes agree within this factor.
const SAME_SIZE: f64 = 3.0;

/// An estimate agrees with the truth within this many standard errors.
const LARGEST_DEVIATION: f64 = 4.0;

/// A statement of the paper, or of a bound, and what came out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Claim {
    /// The table or figure.
    pub place: String,
    /// What is claimed.
    pub claim: String,
    /// The paper's numbers.
    pub paper: String,
    /// Ours.
    pub ours: String,
    /// Whether it holds here.
    pub holds: bool,
    /// Why it may not.
    pub why: String,
}

impl Claim {
    fn new(place: &str, claim: &str, paper: &str, ours: String, holds: bool, why: &str) -> Self {
        Self {
            place: place.into(),
            claim: claim.into(),
            paper: paper.into(),
            ours,
            holds,
            why: why.into(),
        }
    }
}

const TRAJECTORIES: &str = "The paper's two trajectories are unpublished. Ours are random, within \
                            \u{3c0}/2 of the expansion point, at the joints' speed limit.";

impl Table1 {
    /// Lays what the paper concludes from Table I beside ours.
    #[must_use]
    pub(crate) fn claims(&self) -> Vec<Claim> {
        let mean = |kind, order, speed| self.cell(kind, order, speed).and_then(|cell| cell.mean);
        let words = |values: &[Option<f64>]| {
            let word = |value: &Option<f64>| value.map_or_else(|| "-".into(), four_decimals);
            format!("{} rad/s", values.iter().map(word).collect::<Vec<_>>().join(", "))
        };
        let mut claims = Vec::new();
        let first = [Speed::Slow, Speed::Fast].map(|speed| mean(ModelKind::One, 1, speed));
        let close = |(ours, paper): (Option<f64>, f64)| {
            ours.is_some_and(|ours| ours < SAME_SIZE * paper && paper < SAME_SIZE * ours)
        };
        claims.push(Claim::new(
            "Table I",
            "Model 1 of order 1 is off by little: sizes within a factor of 3, slow and fast",
            "0.0040, 0.0408 rad/s",
            words(&first),
            first.into_iter().zip([0.0040, 0.0408]).all(close),
            TRAJECTORIES,
        ));
        let fast = [(ModelKind::One, 3), (ModelKind::Two, 5), (ModelKind::Two, 7)]
            .map(|(kind, order)| mean(kind, order, Speed::Fast));
        let [one, five, seven] = fast;
        claims.push(Claim::new(
            "Table I",
            "Model 2 of order 5 and 7 is better than model 1 on fast motions",
            "0.0243; 0.0161, 0.0162 rad/s",
            words(&fast),
            [five, seven].iter().all(|two| two.zip(one).is_some_and(|(two, one)| two < one)),
            TRAJECTORIES,
        ));
        let three = self.cell(ModelKind::Three, 3, Speed::Fast);
        claims.push(Claim::new(
            "Table I",
            "Model 3 diverges at order 3",
            "\u{221e}",
            three.map_or_else(
                || "-".into(),
                |cell| format!("{} of {} motions diverge", cell.diverged, cell.errors.len()),
            ),
            three.is_some_and(|cell| 4 * cell.diverged >= cell.errors.len()),
            TRAJECTORIES,
        ));
        let last = self.cell(ModelKind::Three, 5, Speed::Fast);
        let diverges =
            matches!(Paper::entry(ModelKind::Three, 5, Speed::Fast), Some(Paper::Diverged));
        claims.push(Claim::new(
            "Table I",
            "Model 3 diverges on fast motions at order 5",
            if diverges { "\u{221e}" } else { "-" },
            last.map_or_else(
                || "-".into(),
                |cell| format!("{} of {} motions diverge", cell.diverged, cell.errors.len()),
            ),
            last.is_some_and(|cell| cell.diverged > 0),
            "Model 3 is the best of all near its expansion point and of no use far from it; our \
             motions stay within \u{3c0}/2 of it. With --range 3.1416 four of 50 diverge \
             (docs/table1.md).",
        ));
        claims
    }
}

impl Table2 {
    /// Lays what the paper concludes from Table II beside ours, by the cases in the notion `hull`.
    #[must_use]
    pub(crate) fn claims(&self) -> Vec<Claim> {
        let of = |states: States| {
            self.cases.iter().find(|case| (case.notion, case.states) == (Notion::Hull, states))
        };
        let (Some(all), Some(positions)) = (of(States::All), of(States::Positions)) else {
            return Vec::new();
        };
        let proved = all.conformant && positions.conformant;
        let inputs = |case: &Table2Case| -> Vec<f64> {
            (0..6).map(|joint| width(case.bounds(joint)[2])).collect()
        };
        let papers = |case: &Table2Case| -> Vec<f64> {
            case.paper.u.iter().map(|[low, high]| high - low).collect()
        };
        let alike = |ours: &[f64], paper: &[f64]| {
            let close = |(a, b): (&f64, &f64)| *a < SAME_SIZE * b && *b < SAME_SIZE * a;
            ours.iter().zip(paper).filter(|pair| close(*pair)).count()
        };
        let (of_all, of_positions) = (inputs(all), inputs(positions));
        let counts = [alike(&of_all, &papers(all)), alike(&of_positions, &papers(positions))];
        let smaller = of_all.iter().zip(&of_positions).filter(|(all, other)| other < all).count();
        let virtual_arm = "The recordings come from a virtual arm, whose friction, warming and \
                           payload are assumed.";
        vec![
            Claim::new(
                "Table II",
                "In both cases all test suites are enclosed",
                "152 suites",
                format!("{} suites, {} runs, proved", self.suites, self.runs),
                proved,
                "",
            ),
            Claim::new(
                "Table II",
                "U is as wide as the paper's within a factor of 3, per joint and case",
                "6 and 6 joints",
                format!("{} and {} joints", counts[0], counts[1]),
                counts.iter().all(|count| *count >= 4),
                virtual_arm,
            ),
            Claim::new(
                "Table II",
                "U is smaller where only positions have to be enclosed",
                "6 of 6 joints",
                format!("{smaller} of 6 joints"),
                smaller == 6,
                "Wide initial velocities and a constant U are exchangeable there; the cost, not \
                 each width, is smallest.",
            ),
        ]
    }
}

fn width((low, high): (f64, f64)) -> f64 {
    high - low
}

impl Exemplary {
    /// Lays what the paper concludes from Fig. 4 beside ours.
    #[must_use]
    pub(crate) fn claims(&self) -> Vec<Claim> {
        let n = self.joints();
        let narrower = (0..n).filter(|joint| {
            let [both, positions] = self.widths(*joint);
            positions < both
        });
        let narrower = narrower.count();
        let [drifting, suites] = self.drifting;
        vec![
            Claim::new(
                "Fig. 4",
                "The position conformant set is narrower in the positions",
                "all joints",
                format!("{narrower} of {n} joints of suite {}", self.figure.suite),
                narrower == n,
                "",
            ),
            Claim::new(
                "Fig. 4",
                "Temperature is a main reason why runs diverge: final positions follow the order \
                 of the runs, in which the joints warm up",
                "by eye",
                format!("{drifting} of {suites} suites have such a joint"),
                2 * drifting > suites,
                "Over a few runs, any order may be chance.",
            ),
        ]
    }
}

impl Table3 {
    /// Lays the identified model beside the arm that moved.
    #[must_use]
    pub(crate) fn claims(&self) -> Vec<Claim> {
        let rows = |is_biased: bool| {
            let of = move |row: &&Table3Row| row.effects.is_empty() != is_biased;
            self.rows.iter().filter(of).filter_map(|row| row.deviation)
        };
        let largest = rows(false).map(f64::abs).fold(0.0, f64::max);
        let close = rows(false).filter(|deviation| deviation.abs() <= LARGEST_DEVIATION).count();
        let count = rows(false).count();
        vec![Claim::new(
            "Table III",
            "Parameters are recovered within 4 standard errors where the law can show what the arm \
             does",
            "no truth to compare with",
            format!("{close} of {count} rows, the furthest {largest:.1}"),
            close == count,
            "See the table; each row names what else moves it.",
        )]
    }
}

impl Coverage {
    /// Lays the bounds beside how often they were wrong.
    #[must_use]
    pub(crate) fn claims(&self) -> Vec<Claim> {
        let claim = |row: &CoverageRow| {
            Claim::new(
                "Next motion",
                &format!("{} holds as often as it says", row.statement),
                "not in the paper",
                format!("wrong {:.3}, may be {:.3}", row.observed, row.nominal),
                row.holds(),
                "",
            )
        };
        self.rows.iter().map(claim).collect()
    }
}
