#![doc = include_str!("../README.md")]

mod assemble;
mod built;
mod canvas;
mod chart;
mod check;
mod colour;
mod cost;
mod decimate;
mod error;
mod figure;
mod figures;
mod html;
mod identified;
mod identified_arm;
mod identified_charts;
mod identified_parameters;
mod interactive;
mod layout;
mod lead;
mod legend;
mod library;
mod nominal;
mod packed;
mod page;
mod page_files;
mod panel;
mod phase_planes;
mod scripts;
mod skeleton;
mod sources;
mod stop_page;
mod style;
mod suite_figure;
mod suites;
mod tables;
mod terms;
mod text;
mod text_table;
mod verify_page;

#[cfg(test)]
mod browser;
#[cfg(test)]
mod sample;

pub use assemble::page;
pub use built::built_pages;
pub use chart::{Chart, Series, charts_svg};
pub use error::Error;
pub use figure::suite_svg;
pub use html::write_html;
pub use identified::write_identified_html;
pub use identified_charts::{load_chart, viscous_chart};
pub use library::{Assets, LIBRARY_FILE, write_library};
pub use page::Page;
pub use page_files::{PAGE_FILE, PageFile, figure_files, page_files};
pub use reachtube_conform::data::Side;
pub use skeleton::{document, long_table, section};
pub use sources::Sources;
pub use stop_page::{STOP_PAGE_FILE, StopPage, write_stop_html};
pub use suite_figure::{Band, Nominal, RunTrace, SuiteFigure, View};
pub use suites::suite_figures;
pub use text_table::TextTable;
pub use verify_page::{VERIFY_PAGE_FILE, VerifyPage, write_verify_html};
