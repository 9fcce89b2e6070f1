//! A picture of a verification: the arm, what it sweeps and the obstacles, from the side and from
//! above.

use std::fmt::Write;

use reachtube_files::MARK;
use reachtube_finding::printable;

use crate::body::body::Body;
use crate::occupancy::SweptCapsule;
use crate::scene::obstacle::Solid;
use crate::scene::scenario::Scene;
use crate::verdict::verification::{Answer, Verification};

/// Width and height of one view, px.
const VIEW: [f64; 2] = [460.0, 460.0];

/// Number of steps whose swept capsules are drawn, at most.
const STEPS: usize = 120;

/// The coordinates of a view: to the right and upward.
const VIEWS: [(&str, [usize; 2]); 2] =
    [("from the side: x to the right, z up", [0, 2]), ("from above: x to the right, y up", [0, 1])];

/// Meaning of the colours.
const KEY: &str = "grey: all motions of the model; orange: the worst stop; blue: the nominal \
                   motion; red: the closest one found; brown: obstacles";

/// Draws a verification as an SVG document. Seen along an axis, a capsule is a thick line with
/// round ends.
///
/// Grey is what the links sweep on all motions of the model; blue is the nominal motion at the time
/// of the smallest proved distance; red is the simulated motion that comes closest, if one was
/// sought. Orange is what the links sweep over the stop that comes closest. Obstacles are brown, as
/// they are at that time.
#[must_use]
pub fn picture(verification: &Verification, body: &Body, scene: &Scene) -> String {
    let Verification { reach, clearances, closest, .. } = verification;
    let occupancy = body.occupancy(&reach.times, &reach.tube);
    let stride = occupancy.len().div_ceil(STEPS).max(1);
    let swept: Vec<SweptCapsule> =
        (0..occupancy.len()).step_by(stride).flat_map(|k| occupancy.step(k)).copied().collect();
    let (step, time) = match (closest, clearances.first()) {
        (Some(found), _) => {
            // During a stop, the nominal motion is drawn where the stop began.
            let from = found.stop.as_ref().map_or(found.time, |stop| stop.from);
            (reach.times.iter().position(|t| *t >= from).unwrap_or(0), found.time)
        }
        (None, Some(pair)) => (pair.step, pair.time),
        (None, None) => (0, 0.0),
    };
    let n = body.joint_count();
    let nominal = reach.nominal.get(step * reach.dimension..(step + 1) * reach.dimension);
    let nominal = nominal.map_or_else(Vec::new, |q| body.placed(&q[..n]));
    let found = closest.as_ref();
    let found = found.map_or_else(Vec::new, |found| body.placed(&found.at(found.time)[..n]));
    let stopping = stop_swept(verification, body);
    let scale = Scale::around(&[&swept[..], &stopping].concat(), scene);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" \
         font-family=\"sans-serif\" font-size=\"13\">\n<!-- {MARK} -->\n<title>{}</title>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        2.0 * VIEW[0],
        VIEW[1] + 70.0,
        escaped(&title(verification, time)),
    );
    for (index, (name, axes)) in VIEWS.into_iter().enumerate() {
        let x = index as f64 * VIEW[0];
        let _ = writeln!(
            svg,
            "<svg x=\"{x}\" y=\"44\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">",
            VIEW[0], VIEW[1]
        );
        scene.obstacles.iter().for_each(|o| scale.solid(&mut svg, axes, &o.solid, o.speed * time));
        scale.capsules(&mut svg, axes, &swept, "#888", 0.12);
        scale.capsules(&mut svg, axes, &stopping, "#e08a00", 0.12);
        scale.capsules(&mut svg, axes, &nominal, "#1f5fa8", 0.75);
        scale.capsules(&mut svg, axes, &found, "#c62828", 0.75);
        let _ = write!(
            svg,
            "</svg>\n<text x=\"{}\" y=\"{}\">{name}</text>\n",
            x + 10.0,
            VIEW[1] + 62.0
        );
    }
    let _ = writeln!(
        svg,
        "<text x=\"10\" y=\"20\" font-weight=\"bold\">{}</text>\n\
         <text x=\"10\" y=\"38\">{KEY}</text>\n</svg>",
        escaped(&title(verification, time)),
    );
    svg
}

/// Returns what the links sweep over the stop that comes closest to an obstacle.
pub(crate) fn stop_swept(verification: &Verification, body: &Body) -> Vec<SweptCapsule> {
    let worst = verification.stops.as_ref().and_then(|stops| stops.worst.as_ref());
    let Some((_, stop)) = worst else { return Vec::new() };
    let occupancy = body.occupancy(&stop.times, &stop.tube);
    let stride = occupancy.len().div_ceil(STEPS / 2).max(1);
    (0..occupancy.len()).step_by(stride).flat_map(|k| occupancy.step(k)).copied().collect()
}

fn title(verification: &Verification, time: f64) -> String {
    let answer = match verification.answer {
        Answer::Safe => "safe",
        Answer::Undecided => "undecided",
        Answer::Unsafe => "unsafe",
    };
    format!("{}: {answer}; the arm at {time:.3} s", verification.case)
}

fn escaped(text: &str) -> String {
    printable(text).replace('&', "&amp;").replace('<', "&lt;")
}

/// Maps metres to pixels, the same in both views.
struct Scale {
    centre: [f64; 3],
    factor: f64,
}

impl Scale {
    /// Fits what the robot sweeps, and the obstacles that are not much larger, into a view.
    fn around(swept: &[SweptCapsule], scene: &Scene) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut take = |p: [f64; 3], radius: f64| {
            for i in 0..3 {
                low[i] = low[i].min(p[i] - radius);
                high[i] = high[i].max(p[i] + radius);
            }
        };
        let finite = swept.iter().filter(|capsule| capsule.radius.is_finite());
        finite.for_each(|c| [c.from, c.to].into_iter().for_each(|end| take(end, c.radius)));
        for obstacle in &scene.obstacles {
            match obstacle.solid {
                Solid::HalfSpace { normal, offset } => {
                    // The base stands at the origin; a far plane would make the arm small.
                    let square = normal.iter().map(|x| x * x).sum::<f64>();
                    let edge = normal.map(|x| x * offset / square);
                    if offset.abs() < square.sqrt() {
                        take(edge, 0.05);
                    }
                }
                Solid::Box { centre, .. } => take(centre, 0.1),
                Solid::Capsule { from, to, radius } => {
                    [from, to].into_iter().for_each(|end| take(end, radius));
                }
            }
        }
        let size = (0..3).map(|i| high[i] - low[i]).fold(0.1, f64::max);
        let centre = core::array::from_fn(|i| 0.5 * (low[i] + high[i]));
        Self { centre, factor: 0.92 * VIEW[0] / size }
    }

    fn place(&self, [right, up]: [usize; 2], p: [f64; 3]) -> [f64; 2] {
        let from_centre = |i: usize| self.factor * (p[i] - self.centre[i]);
        [0.5 * VIEW[0] + from_centre(right), 0.5 * VIEW[1] - from_centre(up)]
    }

    fn capsules(
        &self,
        svg: &mut String,
        axes: [usize; 2],
        capsules: &[SweptCapsule],
        colour: &str,
        opacity: f64,
    ) {
        // The opacity of a group applies once, where the lines inside it overlap.
        let _ = writeln!(
            svg,
            "<g stroke=\"{colour}\" opacity=\"{}\" stroke-linecap=\"round\">",
            if opacity < 0.5 { 0.35 } else { opacity }
        );
        for capsule in capsules {
            self.line(svg, axes, [capsule.from, capsule.to], capsule.radius);
        }
        svg.push_str("</g>\n");
    }

    fn line(&self, svg: &mut String, axes: [usize; 2], ends: [[f64; 3]; 2], radius: f64) {
        let [[x, y], [u, v]] = ends.map(|end| self.place(axes, end));
        let width = 2.0 * self.factor * radius.min(100.0);
        let _ =
            writeln!(svg, "<path d=\"M{x:.1} {y:.1}L{u:.1} {v:.1}\" stroke-width=\"{width:.1}\"/>");
    }

    fn solid(&self, svg: &mut String, axes: [usize; 2], solid: &Solid, grown: f64) {
        let style = "fill=\"#a0764a\" fill-opacity=\"0.45\" stroke=\"#a0764a\"";
        match solid {
            Solid::Capsule { from, to, radius } => {
                let _ = writeln!(
                    svg,
                    "<g stroke=\"#a0764a\" opacity=\"0.6\" stroke-linecap=\"round\">"
                );
                self.line(svg, axes, [*from, *to], radius + grown);
                svg.push_str("</g>\n");
            }
            Solid::Box { centre, axes: sides, half } => {
                let corner = |signs: usize| {
                    core::array::from_fn(|i| {
                        let side = |k: usize| {
                            let sign = if signs >> k & 1 == 0 { 1.0 } else { -1.0 };
                            sign * (half[k] + grown) * sides[k][i]
                        };
                        centre[i] + side(0) + side(1) + side(2)
                    })
                };
                let corners = (0..8).map(|signs| self.place(axes, corner(signs))).collect();
                self.polygon(svg, hull(corners), style);
            }
            Solid::HalfSpace { normal, offset } => {
                let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
                let [right, up] = axes.map(|i| normal[i] / length);
                // Seen along an axis that is not in the plane, a half-space covers all.
                if right.hypot(up) < 0.999 {
                    return;
                }
                let edge = core::array::from_fn(|i| normal[i] / length * (offset / length + grown));
                let [x, y] = self.place(axes, edge);
                let far = 4.0 * VIEW[0];
                let corners = [(far, 0.0), (far, -far), (-far, -far), (-far, 0.0)];
                let corners = corners.map(|(along, away)| {
                    [x - along * up + away * right, y - along * right - away * up]
                });
                self.polygon(svg, corners.to_vec(), style);
            }
        }
    }

    fn polygon(&self, svg: &mut String, corners: Vec<[f64; 2]>, style: &str) {
        let points: Vec<_> = corners.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(svg, "<polygon points=\"{}\" {style}/>", points.join(" "));
    }
}

/// Returns the convex hull of points, counter-clockwise (Andrew's monotone chain).
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let chain = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                if turn(a, b, p) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let lower = chain(&mut points.iter().copied());
    let upper = chain(&mut points.iter().rev().copied());
    [lower, upper].concat()
}
