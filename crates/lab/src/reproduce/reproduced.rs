//! The tables and figures that are requested, computed one after another.

use std::path::Path;

use reachtube_conform::{Notion, Progress};
use reachtube_robot::Robot;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::claims::Claim;
use super::coverage::{Coverage, CoverageOptions, coverage};
use super::exemplary::Exemplary;
use super::figures::{PaperFigure, fig1, fig2, fig3, fig4};
use super::table1::{Table1, Table1Options, table1};
use super::table2::{Found, Table2, Table2Options};
use super::table3::{Table3, table3_and_fig5};
use super::tables::Sheet;
use crate::campaign::{self, CampaignOptions, campaign_options};
use crate::error::Result;

/// A table or figure of the paper, or the test of the bounds for the next motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Item {
    /// Table I: the errors of the models in simulation.
    Table1,
    /// Table II: the uncertainty sets of model 1.
    Table2,
    /// Table III: the identified model.
    Table3,
    /// Fig. 1: recordings of one joint in the reachable set.
    Fig1,
    /// Fig. 2: one input moves the robot and the model.
    Fig2,
    /// Fig. 3: the points of a motion at which the open loop begins.
    Fig3,
    /// Fig. 4: the reachable sets of both cases of Table II.
    Fig4,
    /// Fig. 5: the fits of friction.
    Fig5,
    /// How often the bounds for the next motion are wrong.
    Coverage,
}

impl Item {
    /// All items.
    pub const ALL: [Self; 9] = [
        Self::Table1,
        Self::Table2,
        Self::Table3,
        Self::Fig1,
        Self::Fig2,
        Self::Fig3,
        Self::Fig4,
        Self::Fig5,
        Self::Coverage,
    ];

    fn needs_recordings(self) -> bool {
        !matches!(self, Self::Table1 | Self::Coverage)
    }
}

/// The sizes of what is computed.
#[derive(Debug, Clone)]
pub struct ReproduceOptions {
    /// The campaign that is recorded where it is missing; if `None`, the recordings are given.
    pub campaign: Option<CampaignOptions>,
    /// Table I.
    pub table1: Table1Options,
    /// Table II, whose sets Figs. 1, 2 and 4 show.
    pub table2: Table2Options,
    /// The suite of Figs. 1 to 4; if `None`, the one whose runs end furthest apart.
    pub suite: Option<String>,
    /// The test of the bounds.
    pub coverage: CoverageOptions,
}

impl ReproduceOptions {
    /// Returns the sizes of the paper, or a tenth of them.
    #[must_use]
    pub fn new(seed: u64, is_small: bool) -> Self {
        let campaign = CampaignOptions { seed, ..CampaignOptions::default() };
        let table1 = Table1Options { seed, ..Table1Options::default() };
        let table2 = Table2Options::default();
        let coverage = CoverageOptions { seed, ..CoverageOptions::default() };
        let (campaign, table1, table2, coverage) = if is_small {
            (
                CampaignOptions { motions: 4, runs: 3, rest: 100, one_joint: 1, ..campaign },
                Table1Options { motions: 5, ..table1 },
                table2,
                CoverageOptions { campaigns: 1, next: 100, ..coverage },
            )
        } else {
            let notions = vec![Notion::Hull, Notion::Exact];
            (campaign, table1, Table2Options { notions, ..table2 }, coverage)
        };
        Self { campaign: Some(campaign), table1, table2, suite: None, coverage }
    }
}

/// The computed tables and figures.
#[derive(Debug, Clone, Default, Serialize, JsonSchema)]
pub struct Reproduced {
    /// Table I.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table1: Option<Table1>,
    /// Table II.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table2: Option<Table2>,
    /// Table III.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table3: Option<Table3>,
    /// The figures.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub figures: Vec<PaperFigure>,
    /// The bounds for the next motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coverage: Option<Coverage>,
    /// The suite of Figs. 1, 2 and 4.
    #[serde(skip)]
    pub(super) exemplary: Option<Exemplary>,
    /// The campaign that the recordings are of.
    #[serde(skip)]
    pub(super) campaign: Option<CampaignOptions>,
}

/// Computes `items`, with recordings in the folder `data`. `stage` gets the name of each part of
/// the job and returns where its progress is reported.
///
/// # Errors
///
/// Fails if the folder is not a campaign's and Fig. 3, Fig. 5 or Table III is requested, for sizes
/// that compute nothing, and for suites that are not there. Fails as
/// [`conform`](reachtube_conform::conform) and [`identify`](reachtube_identify::identify).
pub fn reproduce(
    items: &[Item],
    options: &ReproduceOptions,
    data: &Path,
    stage: &dyn Fn(&'static str) -> Box<dyn Progress>,
) -> Result<Reproduced> {
    let has = |item: Item| items.contains(&item);
    let mut computed = Reproduced::default();
    if items.iter().any(|item| item.needs_recordings()) {
        if let Some(campaign) = &options.campaign {
            let bar = stage("recording the campaign");
            let progress = |done, total| bar.recordings_read(done, total);
            campaign::record(&Robot::lwa4p(), campaign, data, &progress)?;
        }
        computed.campaign = campaign_options(data).ok();
    }
    if has(Item::Table1) {
        let bar = stage("Table I");
        let progress = |done, total| bar.recordings_read(done, total);
        computed.table1 = Some(table1(&options.table1, &progress)?);
    }
    computed.sets(items, options, data, stage)?;
    if has(Item::Table3) || has(Item::Fig5) {
        let bar = stage("identifying");
        let (table3, fig5) =
            table3_and_fig5(data, &|done, total| bar.recordings_read(done, total))?;
        computed.table3 = has(Item::Table3).then_some(table3);
        computed.figures.extend(has(Item::Fig5).then_some(fig5));
    }
    if has(Item::Coverage) {
        let bar = stage("bounds for the next motion");
        let progress = |done, total| bar.recordings_read(done, total);
        computed.coverage = Some(coverage(&options.coverage, &progress)?);
    }
    Ok(computed)
}

impl Reproduced {
    /// Computes Table II and Figs. 1 to 4, if they are requested. The figures need the hull only.
    fn sets(
        &mut self,
        items: &[Item],
        options: &ReproduceOptions,
        data: &Path,
        stage: &dyn Fn(&'static str) -> Box<dyn Progress>,
    ) -> Result<()> {
        let has = |item: Item| items.contains(&item);
        let draws = [Item::Fig1, Item::Fig2, Item::Fig3, Item::Fig4].map(has);
        if !has(Item::Table2) && draws == [false; 4] {
            return Ok(());
        }
        let mut asked = options.table2.clone();
        if !has(Item::Table2) {
            asked.notions = vec![Notion::Hull];
        }
        let bar = stage("reading recordings");
        let found = Found::new(data, &asked, &*bar)?;
        self.table2 = has(Item::Table2).then(|| found.table(&asked));
        if draws == [false; 4] {
            return Ok(());
        }
        let suite = Exemplary::new(data, &found, options.suite.as_deref())?;
        drop(bar);
        let draw: [&dyn Fn() -> Result<PaperFigure>; 4] =
            [&|| fig1(&suite), &|| fig2(&suite), &|| fig3(data, &suite.figure.suite), &|| {
                fig4(&suite)
            }];
        for (draw, _) in draw.into_iter().zip(draws).filter(|(_, is_asked)| *is_asked) {
            self.figures.push(draw()?);
        }
        self.exemplary = Some(suite);
        Ok(())
    }

    /// Returns what the paper claims, beside what came out.
    #[must_use]
    pub fn claims(&self) -> Vec<Claim> {
        let Self { table1, table2, exemplary, table3, coverage, .. } = self;
        [
            table1.as_ref().map(Table1::claims),
            table2.as_ref().map(Table2::claims),
            exemplary.as_ref().map(Exemplary::claims),
            table3.as_ref().map(Table3::claims),
            coverage.as_ref().map(Coverage::claims),
        ]
        .into_iter()
        .flatten()
        .flatten()
        .collect()
    }

    /// Returns what is printed of each table and figure.
    #[must_use]
    pub fn sheets(&self) -> Vec<Sheet> {
        let Self { table1, table2, table3, coverage, .. } = self;
        let tables = [
            table1.as_ref().map(Table1::sheet),
            table2.as_ref().map(Table2::sheet),
            table3.as_ref().map(Table3::sheet),
        ];
        let figures = self.figures.iter().map(PaperFigure::sheet);
        tables
            .into_iter()
            .flatten()
            .chain(figures)
            .chain(coverage.as_ref().map(Coverage::sheet))
            .collect()
    }
}
