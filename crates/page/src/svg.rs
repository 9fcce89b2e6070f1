//! A drawing as an SVG document. Places and sizes are in pixels.

use super::skeleton::own_mark;
use super::text::Text;
use maud::{Markup, PreEscaped, Render, html};

/// Red, green and blue.
pub(super) type Colour = [u8; 3];
/// To the right and down \[px\].
pub(super) type Place = (f64, f64);

/// Text and axes.
pub(super) const INK: Colour = [31, 35, 40];
/// Lines at the ticks.
pub(super) const GRID: Colour = [238, 240, 243];
pub(super) const WHITE: Colour = [255, 255, 255];
pub(super) const GREY: Colour = [140, 149, 159];
pub(super) const BLUE: Colour = [18, 70, 200];
pub(super) const ORANGE: Colour = [222, 115, 10];
pub(super) const RED: Colour = [207, 19, 34];

/// Returns a colour as the figures print it, such as `#1246C8`.
pub(super) fn hex([red, green, blue]: Colour) -> String {
    format!("#{red:02X}{green:02X}{blue:02X}")
}

/// A drawing under way: what comes later covers what came before.
#[derive(Default)]
pub(super) struct Svg(String);

/// The part of a text that stands at its place.
pub(super) enum Anchor {
    Start,
    Middle,
    End,
    /// The middle of a text that is read from below.
    Turned,
}

impl Svg {
    /// Returns the complete document. Readers that do not see it get `label`.
    pub(super) fn document(&self, [width, height]: [f64; 2], label: &str) -> String {
        let document = html! {
            svg xmlns="http://www.w3.org/2000/svg" width=(width) height=(height)
                viewBox={ "0 0 " (width) " " (height) } font-family="sans-serif" fill=(hex(INK))
                stroke-linejoin="round" role="img" aria-label=(Text(label)) {
                (own_mark())
                rect width="100%" height="100%" fill="#FFFFFF" {}
                (PreEscaped(&self.0))
            }
        };
        document.into_string() + "\n"
    }

    fn add(&mut self, element: &Markup) {
        element.render_to(&mut self.0);
        self.0.push('\n');
    }

    pub(super) fn line(&mut self, points: &[Place], colour: Colour, width: f64) {
        self.add(&html! {
            polyline fill="none" stroke=(hex(colour)) stroke-width=(round(width))
                points=(list(points)) {}
        });
    }

    pub(super) fn polygon(&mut self, points: &[Place], fill: Colour) {
        self.add(&html! { polygon fill=(hex(fill)) points=(list(points)) {} });
    }

    pub(super) fn rectangle(&mut self, (x, y): Place, [width, height]: [f64; 2], fill: Colour) {
        self.add(&html! {
            rect x=(round(x)) y=(round(y)) width=(width) height=(height) fill=(hex(fill)) {}
        });
    }

    /// Draws with an opacity, which applies once where lines overlap; lines have round ends.
    pub(super) fn faded(&mut self, opacity: f64, draw: impl FnOnce(&mut Svg)) {
        self.0 += &format!("<g opacity=\"{opacity}\" stroke-linecap=\"round\">\n");
        draw(self);
        self.0 += "</g>\n";
    }

    /// Draws from a corner within a width and height, beyond which nothing shows.
    pub(super) fn window(
        &mut self,
        (x, y): Place,
        [width, height]: [f64; 2],
        draw: impl FnOnce(&mut Svg),
    ) {
        self.0 += &format!("<svg x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\">\n");
        draw(self);
        self.0 += "</svg>\n";
    }

    pub(super) fn dot(&mut self, (x, y): Place, radius: f64, fill: Colour) {
        self.add(&html! { circle cx=(round(x)) cy=(round(y)) r=(radius) fill=(hex(fill)) {} });
    }

    pub(super) fn ring(&mut self, (x, y): Place, radius: f64, colour: Colour, width: f64) {
        self.add(&html! {
            circle cx=(round(x)) cy=(round(y)) r=(radius) fill="none" stroke=(hex(colour))
                stroke-width=(width) {}
        });
    }

    /// Writes a text whose middle is at the height of the place; none if it is empty.
    pub(super) fn text(&mut self, (x, y): Place, text: &str, anchor: &Anchor, size: f64) {
        self.write((x, y), text, anchor, size, None);
    }

    pub(super) fn bold(&mut self, place: Place, text: &str, anchor: &Anchor, size: f64) {
        self.write(place, text, anchor, size, Some("bold"));
    }

    fn write(
        &mut self,
        (x, y): Place,
        text: &str,
        anchor: &Anchor,
        size: f64,
        weight: Option<&str>,
    ) {
        if text.is_empty() {
            return;
        }
        let (x, y) = (round(x), round(y));
        let word = match anchor {
            Anchor::Start => "start",
            Anchor::Middle | Anchor::Turned => "middle",
            Anchor::End => "end",
        };
        let turn = matches!(anchor, Anchor::Turned).then(|| format!("rotate(270 {x} {y})"));
        self.add(&html! {
            text x=(x) y=(y) dy="0.5ex" text-anchor=(word) font-size=(size) font-weight=[weight]
                transform=[turn] { (Text(text)) }
        });
    }
}

fn round(pixels: f64) -> f64 {
    (100.0 * pixels).round() / 100.0
}

fn list(points: &[Place]) -> String {
    let point = |(x, y): &Place| format!("{},{}", round(*x), round(*y));
    points.iter().map(point).collect::<Vec<_>>().join(" ")
}
