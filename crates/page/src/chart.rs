//! The one description of a plot, which SVG figures and the page's script draw.

use super::decimate::Point;
use serde::Serialize;

/// A plot. Equal descriptions give equal drawings.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Chart {
    /// The heading above the plot.
    pub title: String,
    /// Label of the horizontal axis with its unit.
    pub x: String,
    /// Label of the vertical axis with its unit.
    pub y: String,
    /// Areas behind the series, light grey and dark grey, at most two.
    pub areas: Vec<Area>,
    /// The series, each drawn over the one before it.
    pub series: Vec<Series>,
    /// Names at -0.5, -1.5 and so on beside the vertical axis, in place of numbers.
    pub rows: Vec<String>,
}

/// An area between two lines from left to right.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Area {
    /// Points (x, y) of the lower edge.
    pub lower: Vec<(f64, f64)>,
    /// Points of the upper edge.
    pub upper: Vec<(f64, f64)>,
}

/// Points of a chart.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Series {
    /// Points (x, y).
    pub points: Vec<(f64, f64)>,
    /// What is drawn at the points.
    pub mark: Mark,
    /// Red, green, blue; rings have a colour of their own.
    pub colour: [u8; 3],
}

/// What is drawn at the points of a series.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Mark {
    /// A line through them.
    #[default]
    Line,
    /// A dot at each.
    Dots,
    /// A ring at each, as a sample has that decides a set.
    Decides,
    /// A larger red ring at each, as a sample outside a set has.
    Outside,
}

impl Series {
    /// Makes a line.
    #[must_use]
    pub fn line(points: Vec<(f64, f64)>, colour: [u8; 3]) -> Self {
        Self { points, mark: Mark::Line, colour }
    }

    /// Makes dots.
    #[must_use]
    pub fn dots(points: Vec<(f64, f64)>, colour: [u8; 3]) -> Self {
        Self { points, mark: Mark::Dots, colour }
    }
}

impl Chart {
    /// Makes a chart of series.
    #[must_use]
    pub fn new(
        title: impl Into<String>,
        x: impl Into<String>,
        y: impl Into<String>,
        series: Vec<Series>,
    ) -> Self {
        Self { title: title.into(), x: x.into(), y: y.into(), series, ..Self::default() }
    }

    pub(super) fn points(&self) -> impl Iterator<Item = &Point> {
        let areas = self.areas.iter().flat_map(|area| area.lower.iter().chain(&area.upper));
        areas.chain(self.series.iter().flat_map(|series| &series.points))
    }
}
