//! The picture of a verified motion: the arm, what it sweeps and the obstacles, from the side and
//! from above.

use reachtube_verify::{Body, Scene, Solid, Verification};

use crate::motion_scene::{Ball, MotionScene};
use crate::svg::{Anchor, BLUE, Colour, ORANGE, Place, RED, Svg};

/// Width and height of one view, px.
const VIEW: [f64; 2] = [460.0, 460.0];

/// The coordinates of a view: to the right and upward.
const VIEWS: [(&str, [usize; 2]); 2] =
    [("from the side: x to the right, z up", [0, 2]), ("from above: x to the right, y up", [0, 1])];

const SWEPT: Colour = [136, 136, 136];
const BROWN: Colour = [160, 118, 74];

/// Draws a verification as an SVG document. Seen along an axis, a capsule is a thick line with
/// round ends.
///
/// Grey is what the links sweep on all motions of the model, and orange what they sweep over the
/// stop that comes closest. Blue is the nominal motion at the time of the smallest proved distance,
/// red the simulated motion that comes closest, if one was sought. Obstacles are as they are then.
pub(super) fn picture(verification: &Verification, body: &Body, scene: &Scene) -> String {
    let drawn = MotionScene::new(verification, body, scene);
    let shown = drawn.shown();
    let time = shown.map_or(0.0, |frame| frame.time);
    let [swept, stopping] = [&drawn.frames, &drawn.stop]
        .map(|frames| frames.iter().flat_map(|frame| &frame.swept).copied().collect::<Vec<_>>());
    let scale = Scale::around(&[&swept[..], &stopping].concat(), &drawn);
    let mut svg = Svg::default();
    for (index, (name, axes)) in VIEWS.into_iter().enumerate() {
        let x = index as f64 * VIEW[0];
        svg.window((x, 44.0), VIEW, |svg| {
            for obstacle in &drawn.obstacles {
                scale.solid(svg, axes, obstacle.solid, obstacle.speed * time);
            }
            scale.capsules(svg, axes, &swept, SWEPT, 0.35);
            scale.capsules(svg, axes, &stopping, ORANGE, 0.35);
            scale.capsules(svg, axes, shown.map_or(&[], |frame| &frame.nominal), BLUE, 0.75);
            scale.capsules(svg, axes, shown.map_or(&[], |frame| &frame.closest), RED, 0.75);
        });
        svg.text((x + 10.0, VIEW[1] + 58.0), name, &Anchor::Start, 13.0);
    }
    let (case, answer) = (&verification.case, verification.answer);
    let title = format!("{case}: {answer}; the arm at {time:.3} s");
    svg.bold((10.0, 16.0), &title, &Anchor::Start, 13.0);
    let mut key = String::from("grey: all motions of the model; blue: the nominal motion");
    if !stopping.is_empty() {
        key += "; orange: the worst stop";
    }
    if shown.is_some_and(|frame| !frame.closest.is_empty()) {
        key += "; red: the closest motion found";
    }
    svg.text((10.0, 34.0), &(key + "; brown: obstacles"), &Anchor::Start, 13.0);
    svg.document([2.0 * VIEW[0], VIEW[1] + 70.0], &title)
}

/// Maps metres to pixels, the same in both views.
struct Scale {
    centre: [f64; 3],
    factor: f64,
}

impl Scale {
    fn around(swept: &[Ball], scene: &MotionScene) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut take = |p: [f64; 3], radius: f64| {
            for i in 0..3 {
                low[i] = low[i].min(p[i] - radius);
                high[i] = high[i].max(p[i] + radius);
            }
        };
        for [a, b, c, d, e, f, radius] in swept {
            take([*a, *b, *c], *radius);
            take([*d, *e, *f], *radius);
        }
        // An obstacle that is far away must not make the arm a speck.
        let size = (0..3).map(|i| high[i] - low[i]).fold(0.1, f64::max);
        let near = core::array::from_fn::<_, 3, _>(|i| (low[i] - size, high[i] + size));
        let mut take = |p: [f64; 3], radius: f64| {
            for i in 0..3 {
                let inside = |x: f64| x.max(near[i].0).min(near[i].1);
                low[i] = low[i].min(inside(p[i] - radius));
                high[i] = high[i].max(inside(p[i] + radius));
            }
        };
        for obstacle in &scene.obstacles {
            match *obstacle.solid {
                Solid::HalfSpace { normal, offset } => {
                    // The base stands at the origin; a far plane would make the arm small.
                    let square = normal.iter().map(|x| x * x).sum::<f64>();
                    if offset.abs() < square.sqrt() {
                        take(normal.map(|x| x * offset / square), 0.05);
                    }
                }
                Solid::Box { centre, .. } => take(centre, 0.1),
                Solid::Capsule { from, to, radius } => {
                    take(from, radius);
                    take(to, radius);
                }
            }
        }
        let size = (0..3).map(|i| high[i] - low[i]).fold(0.1, f64::max);
        let centre = core::array::from_fn(|i| 0.5 * (low[i] + high[i]));
        Self { centre, factor: 0.92 * VIEW[0] / size }
    }

    fn place(&self, [right, up]: [usize; 2], p: [f64; 3]) -> Place {
        let from_centre = |i: usize| self.factor * (p[i] - self.centre[i]);
        (0.5 * VIEW[0] + from_centre(right), 0.5 * VIEW[1] - from_centre(up))
    }

    fn capsules(
        &self,
        svg: &mut Svg,
        axes: [usize; 2],
        capsules: &[Ball],
        colour: Colour,
        opacity: f64,
    ) {
        svg.faded(opacity, |svg| {
            for [a, b, c, d, e, f, radius] in capsules {
                let ends = [[*a, *b, *c], [*d, *e, *f]].map(|end| self.place(axes, end));
                svg.line(&ends, colour, 2.0 * self.factor * radius);
            }
        });
    }

    fn solid(&self, svg: &mut Svg, axes: [usize; 2], solid: &Solid, grown: f64) {
        match solid {
            Solid::Capsule { from: [a, b, c], to: [d, e, f], radius } => {
                let capsule = [*a, *b, *c, *d, *e, *f, radius + grown];
                self.capsules(svg, axes, &[capsule], BROWN, 0.6);
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
                svg.faded(0.6, |svg| svg.polygon(&hull(corners), BROWN));
            }
            Solid::HalfSpace { normal, offset } => {
                let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
                let [right, up] = axes.map(|i| normal[i] / length);
                // Seen along an axis that is not in the plane, a half-space covers all.
                if right.hypot(up) < 0.999 {
                    return;
                }
                let edge = core::array::from_fn(|i| normal[i] / length * (offset / length + grown));
                let (x, y) = self.place(axes, edge);
                let far = 4.0 * VIEW[0];
                let corners = [(far, 0.0), (far, -far), (-far, -far), (-far, 0.0)];
                let corners = corners.map(|(along, away)| {
                    (x - along * up + away * right, y - along * right - away * up)
                });
                svg.faded(0.6, |svg| svg.polygon(&corners, BROWN));
            }
        }
    }
}

/// Returns the convex hull of points, counter-clockwise (Andrew's monotone chain).
fn hull(mut points: Vec<Place>) -> Vec<Place> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let turn = |a: Place, b: Place, c: Place| (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
    let chain = |points: &mut dyn Iterator<Item = Place>| {
        let mut chain: Vec<Place> = Vec::new();
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
