#![doc = include_str!("../README.md")]

mod assemble;
mod built;
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
mod motion_scene;
mod nominal;
mod packed;
mod page;
mod page_files;
mod phase_planes;
mod picture;
mod plot;
mod scripts;
mod skeleton;
mod sources;
mod stop_page;
mod suite_figure;
mod suites;
mod svg;
mod tables;
mod terms;
mod text;
mod verify_page;

#[cfg(test)]
mod browser;
#[cfg(test)]
mod sample;

pub use assemble::page;
pub use built::built_pages;
pub use chart::{Area, Chart, Mark, Series};
pub use error::Error;
pub use figure::suite_svg;
pub use html::write_html;
pub use identified::identified_html;
pub use identified_charts::friction_charts;
pub use library::{Assets, LIBRARY_FILE, write_library};
pub use page::Page;
pub use page_files::{PAGE_FILE, PageFile, figure_files, page_files};
pub use plot::charts_svg;
pub use reachtube_conform::data::Side;
pub use skeleton::{document, fact_table, section, table};
pub use sources::Sources;
pub use stop_page::{STOP_PAGE_FILE, StopPage, stop_html};
pub use suite_figure::{Band, Nominal, RunTrace, SuiteFigure, View};
pub use suites::suite_figures;
pub use verify_page::{VERIFY_PAGE_FILE, verify_files};
