//! One figure of one suite as SVG, after Fig. 4: positions above velocities, one column per joint.

use super::error::Error;
use super::layout::Layout;
use super::legend::Legend;
use super::plot::{Frame, draw};
use super::suite_figure::{SuiteFigure, View};
use super::svg::Svg;
use super::{check, colour};

/// Draws a suite as a complete SVG document of at most 1,240 px width.
///
/// Each joint has a plot of the position \[rad\] above a plot of the velocity \[rad/s\] over time
/// \[s\]. The reachable set is grey, the runs on it are coloured by temperature or order, and rings
/// mark the tight spots.
///
/// Lines are thinned to what the plot can show: in each pixel column a line passes the lowest and
/// the highest sample within a quarter of a pixel. Between samples the edges of the bands are
/// joined by straight lines, which is no claim about the reachable set there.
///
/// # Errors
///
/// Fails for shapes that do not match, times that do not increase, numbers that are not finite, and
/// a view that the suite does not have.
pub fn suite_svg(figure: &SuiteFigure, view: View) -> Result<String, Error> {
    check::suite(figure)?;
    if !figure.views().contains(&view) {
        return Err(Error::View { suite: figure.suite.clone(), view });
    }
    let deviations;
    let drawn = match view {
        View::Motion => figure,
        View::Deviation => {
            deviations = figure.deviations();
            &deviations
        }
    };
    let mut heat = colour::heat(&figure.runs);
    let joints = 0..figure.joints.len();
    let own: Option<Vec<Vec<f64>>> =
        joints.map(|joint| colour::heat_of_joint(&figure.runs, joint)).collect();
    if own.is_some() {
        heat.ends = ["coldest of each joint".into(), "hottest".into()];
    }
    let colours = |values: &Vec<f64>| -> Vec<[u8; 3]> {
        values.iter().map(|&heat| colour::colour(heat)).collect()
    };
    let colours: Vec<Vec<[u8; 3]>> =
        own.unwrap_or_else(|| vec![heat.values.clone()]).iter().map(colours).collect();
    // The width decides the rows of the legend, and these the height.
    let layout = Layout::new(figure.joints.len());
    let legend = Legend::new(figure, view, &heat, layout.width());
    let layout = layout.below(legend.rows());
    let mut svg = Svg::default();
    legend.draw(&mut svg);
    let n = figure.joints.len();
    for state in 0..2 * n {
        // The position above shares time axis and heading with the velocity below it.
        let mut chart = drawn.chart(state, &colours[state % n % colours.len()]);
        let superfluous = if state < n { &mut chart.x } else { &mut chart.title };
        superfluous.clear();
        if !layout.starts_row(state) {
            chart.y.clear();
        }
        let (plot, has_numbers) = (layout.plot(state), state >= n);
        let frame =
            Frame { plot, beside: 52.0, margin: 0.0, tick: 28.0, has_numbers, pen: [0.875, 1.6] };
        draw(&mut svg, &chart, &frame);
    }
    Ok(svg.document([layout.width(), layout.height()], &description(figure, view)))
}

/// Describes the figure in a sentence, for readers who do not see it.
fn description(figure: &SuiteFigure, view: View) -> String {
    let what = match view {
        View::Motion => "reachable set",
        View::Deviation => "reachable set of the deviation from the nominal motion",
    };
    let span = figure.times[figure.times.len() - 1] - figure.times[0];
    let (runs, joints) = (figure.runs.len(), figure.joints.len());
    format!("Suite {}: {what} and {runs} runs of {joints} joints over {span:.3} s", figure.suite)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::BANDS;
    use crate::sample;
    use crate::suite_figure::Nominal;
    use crate::svg::hex;
    use roxmltree::{Document, Node};

    fn elements<'a>(svg: &'a Document, name: &'a str) -> impl Iterator<Item = Node<'a, 'a>> {
        svg.descendants()
            .filter(move |node| node.has_tag_name(("http://www.w3.org/2000/svg", name)))
    }

    #[test]
    fn figures_are_well_formed_for_one_to_ten_joints() {
        for joints in 1..=10 {
            let figure = sample::suite("a <suite> & \"more\"", joints);
            for &view in figure.views() {
                let svg = suite_svg(&figure, view).unwrap();
                let document = Document::parse(&svg).unwrap();
                let label = document.root_element().attribute("aria-label").unwrap();
                assert!(label.starts_with("Suite a <suite> & \"more\": "));
                let texts = elements(&document, "text").filter_map(|node| node.text());
                assert_eq!(texts.filter(|text| text.trim() == "time [s]").count(), joints);
                assert!(!svg.contains("<suite>") && !svg.contains("NaN") && !svg.contains("inf"));
            }
        }
    }

    #[test]
    fn the_check_of_form_can_fail() {
        assert!(Document::parse("<svg><g></svg>").is_err());
        assert!(Document::parse("<svg a=\"1></svg>").is_err());
        assert!(Document::parse("<svg>").is_err());
    }

    #[test]
    fn every_run_is_drawn_in_every_panel_in_its_colour() {
        let figure = sample::suite("S", 2);
        let svg = suite_svg(&figure, View::Motion).unwrap();
        let document = Document::parse(&svg).unwrap();
        for heat in colour::heat(&figure.runs).values {
            let stroke = hex(colour::colour(heat));
            let lines = elements(&document, "polyline")
                .filter(|line| line.attribute("stroke") == Some(&stroke));
            assert_eq!(lines.count(), 4);
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
        let svg = suite_svg(&figure, View::Motion).unwrap();
        let document = Document::parse(&svg).unwrap();
        let fill = hex(BANDS[0][0]);
        let bands =
            elements(&document, "polygon").filter(|band| band.attribute("fill") == Some(&fill));
        let mut drawn = 0;
        for band in bands {
            // A level line across the panel.
            let points = band.attribute("points").unwrap().split_whitespace();
            let points: Vec<(f64, f64)> = points
                .map(|point| point.split_once(',').unwrap())
                .map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap()))
                .collect();
            let end = points.iter().map(|point| point.0).max_by(f64::total_cmp).unwrap();
            let width = Layout::new(1).plot(0).width;
            assert!((end - points[0].0 - width).abs() < 0.05 * width, "{points:?}");
            assert!(points.iter().all(|point| point.1 == points[0].1 && point.1 > 0.0));
            drawn += 1;
        }
        assert_eq!(drawn, 2);
    }
}
