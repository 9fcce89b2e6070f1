//! One page that reads like Sec. V and the appendix of the paper.

use maud::{Markup, PreEscaped, html};

use super::claims::Claim;
use super::coverage::Coverage;
use super::reproduced::Reproduced;
use super::table1::Table1;
use super::table2::Table2;
use super::table3::Table3;
use crate::campaign::CampaignOptions;
use reachtube_files::TOOL;
use reachtube_finding::Table;
use reachtube_page::{Error, charts_svg, document, fact_table, section, table};

/// The contents of the page.
struct PaperPage<'a> {
    computed: &'a Reproduced,
    table1: &'a Table1,
    table2: &'a Table2,
    table3: &'a Table3,
    coverage: &'a Coverage,
}

impl Reproduced {
    /// Returns the page as one HTML file that needs no other file, if all tables are there.
    /// `command` is what was typed.
    ///
    /// # Errors
    ///
    /// Fails for numbers that cannot be drawn.
    pub fn page(&self, command: &str) -> Result<Option<String>, Error> {
        let Self { table1, table2, table3, coverage, .. } = self;
        match (table1, table2, table3, coverage) {
            (Some(table1), Some(table2), Some(table3), Some(coverage)) => {
                PaperPage { computed: self, table1, table2, table3, coverage }
                    .html(command)
                    .map(Some)
            }
            _ => Ok(None),
        }
    }
}

impl PaperPage<'_> {
    fn html(&self, command: &str) -> Result<String, Error> {
        let body = html! {
            (section("What came out", &self.summary()))
            (section("Model abstractions in simulation", &self.abstractions()))
            (section("Conformance testing and optimal uncertainty sets", &self.conformance()))
            (section("Bounds for unseen motions", &self.unseen()?))
            (section("Appendix: dynamic parameter identification", &self.identification()))
            (section("How this page was made", &self.made(command)))
        };
        let title = "Reachset conformance of forward dynamic models, reproduced";
        let subtitle = "The experiment of Liu and Althoff (IROS 2018), Sec. V, on a virtual \
                        Schunk LWA 4P";
        Ok(document(title, subtitle, &body, &Markup::default()))
    }

    fn summary(&self) -> Markup {
        let claims = self.computed.claims();
        let hold = claims.iter().filter(|claim| claim.holds).count();
        let row = |claim: &Claim| {
            let holds = if claim.holds { "yes" } else { "no" };
            [&claim.place, holds, &claim.claim, &claim.threshold, &claim.ours, &claim.paper]
                .map(String::from)
                .to_vec()
        };
        let header = ["", "holds", "statement", "counts as holding", "here", "paper"];
        let statements = Table::new(header, claims.iter().map(row).collect())
            .titled(format!("{hold} of {} statements hold here", claims.len()));
        let others = || claims.iter().filter(|claim| !claim.holds && !claim.why.is_empty());
        html! {
            p {
                "The paper\u{2019}s recordings are not public but for four suites, so a virtual \
                 arm records the whole experiment again. Its truth differs from the nominal model \
                 in friction, warming, payload, inertia and delay. Numbers can agree in size and \
                 order only. Every enclosure on this page is proved with directed rounding."
            }
            p {
                "Some of the arm was chosen so that its recordings resemble the paper\u{2019}s: \
                 the rates at which friction falls with temperature and the heat capacity, so \
                 that runs spread and warm up as the four public suites do; and the scatter of \
                 the starts, after the paper\u{2019}s X0. The positions of X0 in Table II are \
                 limited to the recorded starts, since the paper\u{2019}s seem to be. The \
                 motions of Table I stay within \u{3c0}/2 of the expansion point, as the public \
                 suites do. Agreement in these sizes is therefore no evidence. The other \
                 parameters are typical of such arms (docs/paper.md)."
            }
            (table("long", &statements))
            @for claim in others() {
                p { b { (claim.place) ": " (claim.claim) "." } " Not here. " (claim.why) }
            }
        }
    }

    fn abstractions(&self) -> Markup {
        html! {
            p {
                "Models 1, 2 and 3 of several orders and the rigid-body dynamics (Featherstone's \
                 articulated bodies) move under the same inputs. A model whose state leaves \
                 100 rad or rad/s has diverged (\u{221e})."
            }
            (captioned(
                "Table I: simulation error of the model abstractions. ",
                self.table1.table(),
            ))
            p {
                "Fast errors are larger than the paper's because every joint reaches its speed \
                 limit at once. Far from the expansion point every polynomial about it loses."
            }
        }
    }

    fn conformance(&self) -> Markup {
        let Table2 { runs, suites, cases, .. } = self.table2;
        html! {
            p {
                "The arm follows random point-to-point motions closed loop, and its input is \
                 recorded. Each test suite applies this input open loop, from one of four points \
                 of the motion (Fig. 3), " (runs) " runs in " (suites) " suites. The input is the \
                 motor torque without gravity and Coulomb friction (Fig. 2)."
            }
            (self.figure(1)) (self.figure(2)) (self.figure(3))
            p {
                "Table II has the smallest sets of the linear model 1 (p = 1) for all suites \
                 together, once for positions and velocities, once for positions only. X0 and U \
                 contain the origin. The positions of X0 reach no further than the recorded \
                 starts. In the paper\u{2019}s notion, each state by itself lies in the interval \
                 hull of the reachable set. In the notion exact, all states together lie in the \
                 set itself."
            }
            @for case in cases {
                (captioned("Table II, ", case.table()))
                @if !case.warnings.is_empty() {
                    p.hint { "Warnings: " (sentences(&case.warnings)) }
                }
            }
            p {
                "Where only positions have to be enclosed, the disturbance that the paper takes as \
                 constant cannot change positions at once. Wide initial velocities do that for \
                 less, in the paper\u{2019}s table and in ours."
            }
            (self.figure(4))
        }
    }

    fn figure(&self, number: u8) -> Markup {
        let Some(figure) = self.computed.figures.iter().find(|figure| figure.number == number)
        else {
            return Markup::default();
        };
        let is_same =
            |other: &Table| other.title == figure.table.title && other.rows == figure.table.rows;
        let mut before = self.computed.figures.iter().filter(|other| other.number < number);
        let is_known = before.any(|other| is_same(&other.table));
        html! {
            figure {
                (wide_figure(&format!("Fig. {number}"), &figure.svg))
                figcaption { b { "Fig. " (number) ". " } (figure.caption) " " (figure.paper) }
            }
            @if !is_known { (table("long", &figure.table)) }
        }
    }

    fn unseen(&self) -> Result<Markup, Error> {
        let charts = self.coverage.charts();
        let svg = charts_svg(&charts, charts.len(), "Stated and true probabilities")?;
        Ok(html! {
            p {
                "Sets that enclose the recordings are no guarantee for the next motion. Three \
                 bounds say how likely it leaves them (docs/next-motion.md). Small campaigns of "
                (self.coverage.motions) " independent motions put them to the test: each bound may \
                 be wrong in 5 % of the campaigns."
            }
            (table("long", &self.coverage.table()))
            (wide_figure("Stated and true probabilities", &svg))
            p.hint { "Each dot is a campaign. Its bound is wrong where the dot is above the line." }
        })
    }

    fn identification(&self) -> Markup {
        html! {
            p {
                "Gravity is identified from " (self.table3.poses) " static poses, friction from \
                 slow motions of single joints with gravity as the load, and the inertial \
                 parameters from exciting motions by linear regression."
            }
            (self.figure(5))
            p {
                "Table III lays the estimates beside the arm that moved, which no real experiment \
                 can, and beside the paper\u{2019}s. The arm has a Stribeck effect, warms up, and \
                 its torque acts late. The law of the table has none of this, so the rows that it \
                 moves are named. The arm of this page is not the paper\u{2019}s: its links are \
                 heavier, and it carries a payload."
            }
            @for part in self.table3.tables() { (table("long", &part)) }
            @if !self.table3.warnings.is_empty() {
                p.hint { "Warnings: " (sentences(&self.table3.warnings)) }
            }
        }
    }

    fn made(&self, command: &str) -> Markup {
        let mut facts = vec![("Written by", TOOL.to_string()), ("Command", command.into())];
        if let Some(campaign) = &self.computed.campaign {
            let CampaignOptions { motions, start_points, runs, longest, robot, .. } = campaign;
            let parameters = serde_json::to_value(robot).expect("parameters are numbers");
            let parameters = parameters.as_object().into_iter().flatten();
            let parameters: Vec<String> =
                parameters.map(|(name, value)| format!("{name} = {value}")).collect();
            let sizes = format!(
                "{motions} motions, {start_points} starting points, {runs} runs of up to \
                 {longest} s"
            );
            facts.push(("Campaign", sizes));
            facts.push(("Virtual robot (docs/paper.md)", parameters.join(", ")));
        }
        fact_table(&facts)
    }
}

fn captioned(number: &str, of: Table) -> Markup {
    let title = format!("{number}{}", of.title);
    table("long", &of.titled(title))
}

fn wide_figure(label: &str, svg: &str) -> Markup {
    html! {
        div.wide tabindex="0" role="region" aria-label=(label) style="--width:56rem" {
            (PreEscaped(svg))
        }
    }
}

/// Returns sentences one after another, each with one full stop at its end.
fn sentences(texts: &[String]) -> String {
    let ended = |text: &String| format!("{}.", text.trim_end_matches('.'));
    texts.iter().map(ended).collect::<Vec<_>>().join(" ")
}
