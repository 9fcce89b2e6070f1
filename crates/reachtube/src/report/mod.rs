//! Figures and HTML pages of results: what was proved about which recordings, drawn so that a
//! reader can check it by eye.
//!
//! [`page`] makes a [`Page`] from a model and recordings, and [`write_html`] writes it as one
//! self-contained file (no network, no external font or script). [`suite_svg`] draws one figure
//! after Figs. 2 and 4 of Liu & Althoff (IROS 2018). A [`Page`] holds plain numbers and texts, so
//! it can be made from any result; equal pages give equal bytes.

mod assemble;
mod canvas;
mod chart;
mod check;
mod colour;
mod cost;
mod decimate;
pub(crate) mod error;
mod figure;
mod figures;
mod html;
mod identified;
mod identified_arm;
mod identified_charts;
mod identified_parameters;
mod interactive;
mod layout;
mod legend;
mod library;
mod nominal;
mod notion;
mod packed;
mod page;
mod panel;
mod scripts;
mod skeleton;
mod style;
mod suite_figure;
mod suites;
mod tables;
mod text;

#[cfg(test)]
mod browser;
#[cfg(test)]
mod devtools;
#[cfg(test)]
mod sample;

pub use assemble::{Sources, page};
pub(crate) use chart::charts_svg;
pub use chart::{Chart, Series, chart_svg};
pub use error::ReportError;
pub use figure::suite_svg;
pub use html::write_html;
pub use identified::write_identified_html;
pub(crate) use identified_charts::{load_chart, viscous_chart};
pub use library::{Assets, LIBRARY_FILE, write_library};
pub use page::{Bounds, JointSets, Page, SetsTable, TextTable, Verdict};
pub use reachtube_conform::Side;
pub(crate) use skeleton::{document, long_table, section};
pub use suite_figure::{Band, Nominal, RunGauge, RunTrace, SuiteFigure, TightSpot, View};
pub(crate) use suites::figures as suite_figures;
