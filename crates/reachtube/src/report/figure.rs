//! One figure of one suite as SVG, after Fig. 4: positions above velocities, a column a joint.

use super::layout::{Layout, Rect, units};
use super::panel::{self, Content, INK};
use super::text::{clean, escape};
use super::{ReportError, SuiteFigure, View, check, colour, legend::Legend};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// The sheet that is drawn on, in drawing units.
pub(super) type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// The outcome of a drawing call.
pub(super) type DrawResult = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// One figure of a suite as a complete SVG document of at most 1,240 px width: per joint a plot of
/// the position \[rad\] above a plot of the velocity \[rad/s\] over time \[s\], the reachable set
/// in grey, the runs on it coloured by temperature or order, the tight spots ringed.
///
/// The lines are thinned to what the plot can show: each passes every sample's extremes per pixel
/// column within a tenth of a pixel. Between samples the bands are joined by straight lines, which
/// is a drawing and not a claim.
///
/// # Errors
///
/// Shapes that do not match, times that do not increase, numbers that are not finite, or a view
/// that the suite does not have.
///
/// # Examples
///
/// ```
/// use reachtube::report::{Band, SuiteFigure, View, suite_svg};
///
/// let figure = SuiteFigure {
///     suite: "swing".into(),
///     joints: vec!["elbow".into()],
///     times: vec![0.0, 1.0],
///     band: Band {
///         label: "reachable set".into(),
///         lower: vec![vec![-0.1, 0.8], vec![0.9, 0.7]],
///         upper: vec![vec![0.1, 1.2], vec![1.1, 1.3]],
///     },
///     ..SuiteFigure::default()
/// };
/// let svg = suite_svg(&figure, View::Motion)?;
/// assert!(svg.starts_with("<svg") && svg.contains("elbow"));
/// # Ok::<(), reachtube::report::ReportError>(())
/// ```
pub fn suite_svg(figure: &SuiteFigure, view: View) -> Result<String, ReportError> {
    check::suite(figure)?;
    if !figure.views().contains(&view) {
        return Err(ReportError::View { suite: figure.suite.clone(), view });
    }
    let heat = colour::heat(&figure.runs);
    let layout = Layout::new(figure.joints.len());
    let legend = Legend::new(figure, view, &heat, layout.width());
    let layout = layout.below(legend.rows());
    let size = (units(layout.width()) as u32, units(layout.height()) as u32);
    let mut drawing = String::new();
    let canvas = SVGBackend::with_string(&mut drawing, size).into_drawing_area();
    let colours: Vec<RGBColor> = heat.values.iter().map(|&heat| colour::colour(heat)).collect();
    draw(&canvas, figure, view, &layout, &legend, &colours).map_err(|cause| ReportError::Draw {
        suite: figure.suite.clone(),
        cause: cause.to_string(),
    })?;
    drop(canvas);
    Ok(with_head(&drawing, &layout, &describe(figure, view)))
}

fn draw(
    canvas: &Canvas,
    figure: &SuiteFigure,
    view: View,
    layout: &Layout,
    legend: &Legend,
    colours: &[RGBColor],
) -> DrawResult {
    canvas.fill(&WHITE)?;
    legend.draw(canvas)?;
    for state in 0..2 * figure.joints.len() {
        let content = Content::new(figure, view, state).thinned(layout.plot());
        panel::draw(canvas, layout, state, &content, colours)?;
        words(canvas, figure, layout, state)?;
    }
    canvas.present()
}

/// The joint's name above, the quantity beside the row, the time below.
fn words(canvas: &Canvas, figure: &SuiteFigure, layout: &Layout, state: usize) -> DrawResult {
    let Rect { x, y, height, .. } = layout.panel(state);
    let (width, plot) = layout.plot();
    let n = figure.joints.len();
    let font = |size: f64| ("sans-serif", f64::from(units(size)) * 1.24).into_font();
    let style = |font: FontDesc<'static>| {
        TextStyle::from(font).color(&INK).pos(Pos::new(HPos::Center, VPos::Center))
    };
    let middle = units(x + super::layout::BESIDE_PLOT + width / 2.0);
    if state < n {
        let name = style(font(12.5).style(FontStyle::Bold));
        canvas.draw_text(
            &clean(&figure.joints[state]),
            &name,
            (middle, units(layout.block_top(state) + 10.0)),
        )?;
    } else {
        canvas.draw_text("time [s]", &style(font(11.0)), (middle, units(y + height - 8.0)))?;
    }
    if layout.starts_row(state) {
        let quantity = if state < n { "position [rad]" } else { "velocity [rad/s]" };
        let turned = style(font(11.0).transform(FontTransform::Rotate270));
        canvas.draw_text(quantity, &turned, (units(x - 8.0), units(y + plot / 2.0)))?;
    }
    Ok(())
}

/// The figure in a sentence, for readers who do not see it.
fn describe(figure: &SuiteFigure, view: View) -> String {
    let what = match view {
        View::Motion => "reachable set",
        View::Deviation => "reachable set of the deviation from the nominal",
    };
    let span = figure.times[figure.times.len() - 1] - figure.times[0];
    let (runs, joints) = (figure.runs.len(), figure.joints.len());
    format!("Suite {}: {what} and {runs} runs of {joints} joints over {span:.3} s", figure.suite)
}

/// The drawing under a head that scales it from drawing units to pixels and says what it is.
fn with_head(drawing: &str, layout: &Layout, label: &str) -> String {
    let body = drawing.split_once('>').map_or("", |(_, body)| body);
    let (width, height) = (layout.width(), layout.height());
    let (units_wide, units_high) = (units(width), units(height));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {units_wide} {units_high}\" stroke-linejoin=\"round\" role=\"img\" aria-label=\"{}\">{body}",
        escape(label)
    )
}

#[cfg(test)]
mod tests {
    use super::super::{Nominal, sample};
    use super::*;

    /// Every tag is closed in order, every attribute is quoted, and no raw markup is left in a
    /// text.
    pub(crate) fn well_formed(svg: &str) -> Result<(), String> {
        let mut open = Vec::new();
        let mut rest = svg;
        while let Some((text, after)) = rest.split_once('<') {
            if text.contains('>') {
                return Err(format!("stray > in {text:?}"));
            }
            let (tag, after) = after.split_once('>').ok_or("a tag that does not end")?;
            if tag.matches('"').count() % 2 == 1 {
                return Err(format!("an open quote in {tag:?}"));
            }
            let name = tag.split([' ', '/']).find(|part| !part.is_empty()).unwrap_or("");
            if tag.starts_with('/') {
                if open.pop() != Some(name) {
                    return Err(format!("</{name}> closes nothing"));
                }
            } else if !tag.ends_with('/') {
                open.push(name);
            }
            rest = after;
        }
        if open.is_empty() { Ok(()) } else { Err(format!("left open: {open:?}")) }
    }

    #[test]
    fn figures_are_well_formed_for_one_to_ten_joints() {
        for joints in 1..=10 {
            let figure = sample::suite("a <suite> & \"more\"", joints);
            for &view in figure.views() {
                let svg = suite_svg(&figure, view).unwrap();
                well_formed(&svg).unwrap();
                assert_eq!(svg.matches("time [s]").count(), joints);
                assert!(!svg.contains("<suite>") && !svg.contains("NaN") && !svg.contains("inf"));
            }
        }
    }

    #[test]
    fn the_check_of_form_can_fail() {
        assert!(well_formed("<svg><g></svg>").is_err());
        assert!(well_formed("<svg a=\"1></svg>").is_err());
        assert!(well_formed("<svg>").is_err());
    }

    #[test]
    fn every_run_is_drawn_in_every_panel_in_its_colour() {
        let figure = sample::suite("S", 2);
        let svg = suite_svg(&figure, View::Motion).unwrap();
        for heat in colour::heat(&figure.runs).values {
            let stroke = format!("stroke=\"{}\"", colour::hex(colour::colour(heat)));
            assert_eq!(svg.matches(&stroke).count(), 4);
        }
    }

    #[test]
    fn a_view_that_needs_a_nominal_is_refused_without_one() {
        let figure = SuiteFigure { nominal: Nominal::Unknown, ..sample::suite("S", 1) };
        let error = suite_svg(&figure, View::Deviation).unwrap_err();
        assert!(error.to_string().starts_with("suite S has no Deviation view"));
    }

    #[test]
    fn the_same_input_gives_the_same_bytes() {
        let draw = || suite_svg(&sample::suite("S", 3), View::Deviation).unwrap();
        assert_eq!(draw(), draw());
    }

    #[test]
    fn a_joint_that_does_not_move_is_drawn() {
        let mut figure = sample::suite("still", 1);
        figure.inner = None;
        figure.runs.clear();
        figure.tight.clear();
        figure.nominal = Nominal::Unknown;
        let flat = vec![vec![0.0; figure.times.len()]; 2];
        figure.band.lower = flat.clone();
        figure.band.upper = flat;
        well_formed(&suite_svg(&figure, View::Motion).unwrap()).unwrap();
    }
}
