//! The chart of identified combinations of parameters with error bars.

use super::canvas::{Canvas, DrawResult, svg_document};
use super::error::Error;
use super::layout::units;
use super::style::{GRID, INK, centred, font, tick_style};
use super::text::clean;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use reachtube_identify::BaseParameter;
use reachtube_scalar::number::tick_label;

/// Width of the chart \[px\].
const WIDTH: f64 = 600.0;
/// Height of a row \[px\].
const ROW: f64 = 17.0;
/// Room for the names \[px\].
const NAMES: f64 = 190.0;
/// Room above and below the rows \[px\].
const ABOVE: f64 = 26.0;
const BELOW: f64 = 40.0;
/// Longest name in characters.
const LONGEST: usize = 26;
/// Standard errors on either side of an estimate.
const ERRORS: f64 = 2.0;

/// Blue.
const ESTIMATE: RGBColor = RGBColor(18, 70, 200);
/// Red: beyond the error bar.
const BEYOND: RGBColor = RGBColor(222, 30, 30);

/// Draws how far the estimates of combinations are from the description, with error bars. `unit`
/// covers all of them.
///
/// # Errors
///
/// Fails where the drawing library fails.
pub(super) fn parameter_svg(parameters: &[&BaseParameter], unit: &str) -> Result<String, Error> {
    let title = format!("Least squares minus description [{unit}]");
    let height = ABOVE + BELOW + ROW * parameters.len() as f64;
    svg_document([WIDTH, height], &title, |canvas| draw(canvas, parameters, &title))
        .map_err(|cause| Error::Draw { figure: title.clone(), cause: cause.to_string() })
}

fn difference(parameter: &BaseParameter) -> f64 {
    parameter.least_squares - parameter.described
}

fn draw(canvas: &Canvas, parameters: &[&BaseParameter], title: &str) -> DrawResult {
    let reach = |p: &&BaseParameter| difference(p).abs() + ERRORS * p.standard_error;
    let most = parameters.iter().map(reach).filter(|x| x.is_finite()).fold(0.0, f64::max);
    let most = 1.05 * if most > 0.0 { most } else { 1.0 };
    let rows = parameters.len() as f64;
    let plot = canvas.clone().shrink(
        (units(0.0), units(ABOVE)),
        (units(WIDTH - 12.0), units(ROW * rows + BELOW - 16.0)),
    );
    let mut axes = ChartBuilder::on(&plot)
        .set_label_area_size(LabelAreaPosition::Left, units(NAMES))
        .set_label_area_size(LabelAreaPosition::Bottom, units(BELOW - 16.0))
        .build_cartesian_2d(-most..most, rows..0.0)?;
    axes.configure_mesh()
        .disable_y_mesh()
        .disable_y_axis()
        .max_light_lines(0)
        .bold_line_style(GRID.stroke_width(6))
        .axis_style(INK.stroke_width(6))
        .label_style(tick_style())
        .x_labels(7)
        .x_label_formatter(&|value| tick_label(*value, 2.0 * most))
        .draw()?;
    axes.draw_series([PathElement::new([(0.0, 0.0), (0.0, rows)], INK.stroke_width(8))])?;
    for (row, parameter) in parameters.iter().enumerate() {
        let (x, y) = (difference(parameter), row as f64 + 0.5);
        let error = ERRORS * parameter.standard_error;
        let colour = if x.abs() > error { BEYOND } else { ESTIMATE };
        if error.is_finite() {
            let bar = [(x - error, y), (x + error, y)];
            axes.draw_series([PathElement::new(bar, colour.stroke_width(14))])?;
            axes.draw_series([Circle::new((x, y), units(3.0), colour.filled())])?;
        }
    }
    let style = font(11.0, FontStyle::Normal).color(&INK).pos(Pos::new(HPos::Right, VPos::Center));
    for (row, parameter) in parameters.iter().enumerate() {
        let y = units(ABOVE + ROW * (row as f64 + 0.5));
        canvas.draw_text(&clean(&short(&parameter.name)), &style, (units(NAMES - 8.0), y))?;
    }
    let middle = units(0.5 * (NAMES + WIDTH));
    canvas.draw_text(title, &centred(font(12.0, FontStyle::Bold)), (middle, units(12.0)))
}

/// Returns the beginning of a name.
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
            svg.contains("#DE1E1E")
        };
        assert!(!red(&[&near, &open]) && red(&[&near, &far]));
    }
}
