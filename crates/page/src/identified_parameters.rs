//! The chart of identified combinations of parameters with error bars.

use super::chart::{Chart, Series};
use super::error::Error;
use super::plot::chart_svg_of_size;
use super::svg::{BLUE, INK, RED};
use reachtube_identify::BaseParameter;

/// Width of the chart \[px\].
const WIDTH: f64 = 600.0;
/// Height of a row, and of all that is not a row \[px\].
const ROW: f64 = 17.0;
const REST: f64 = 66.0;
/// Longest name in characters.
const LONGEST: usize = 26;
/// Standard errors on either side of an estimate.
const ERRORS: f64 = 2.0;

/// Draws how far the estimates of combinations are from the description, with error bars. `unit`
/// covers all of them. What lies beyond its error bar is red.
///
/// # Errors
///
/// As [`chart_svg_of_size`].
pub(super) fn parameter_svg(parameters: &[&BaseParameter], unit: &str) -> Result<String, Error> {
    let bar = |(row, parameter): (usize, &&BaseParameter)| {
        let difference = parameter.least_squares - parameter.described;
        let (error, y) = (ERRORS * parameter.standard_error, -0.5 - row as f64);
        let colour = if difference.abs() > error { RED } else { BLUE };
        let ends = vec![(difference - error, y), (difference + error, y)];
        let bar = [Series::line(ends, colour), Series::dots(vec![(difference, y)], colour)];
        error.is_finite().then_some(bar)
    };
    let rows = parameters.len() as f64;
    let zero = Series::line(vec![(0.0, 0.0), (0.0, -rows)], INK);
    let bars = parameters.iter().enumerate().filter_map(bar).flatten();
    let title = format!("Least squares minus description [{unit}]");
    let chart = Chart {
        rows: parameters.iter().map(|parameter| short(&parameter.name)).collect(),
        ..Chart::new(title, "", "", [zero].into_iter().chain(bars).collect())
    };
    chart_svg_of_size(&chart, [WIDTH, ROW * rows + REST])
}

fn short(name: &str) -> String {
    if name.chars().count() <= LONGEST {
        return name.into();
    }
    name.chars().take(LONGEST - 1).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_beyond_its_error_bar_is_red() {
        let parameter = |name: &str, least_squares: f64, standard_error: f64| BaseParameter {
            name: name.into(),
            value: least_squares,
            least_squares,
            standard_error,
            described: 1.0,
        };
        let near = parameter("m1 <b>", 1.1, 0.1);
        let far = parameter("m2 + m3 + m4 + m5 + m6 + m7 + m8", 1.3, 0.1);
        let open = parameter("m9", 1.3, f64::INFINITY);
        let red = |all: &[&BaseParameter]| {
            let svg = parameter_svg(all, "kg").unwrap();
            assert!(roxmltree::Document::parse(&svg).is_ok() && !svg.contains("<b>"));
            svg.contains("#CF1322")
        };
        assert!(!red(&[&near, &open]) && red(&[&near, &far]));
    }
}
