//! Texts from outside (names of suites, runs, joints) made safe for HTML and SVG.

use maud::Render;

pub(super) fn clean(text: &str) -> String {
    let allowed = |c: char| !c.is_control() && !matches!(c, '\u{FFFE}' | '\u{FFFF}');
    text.chars().map(|c| if allowed(c) { c } else { ' ' }).collect()
}

pub(super) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// A text from outside, which maud renders escaped and without the characters that XML forbids.
pub(super) struct Text<'a>(pub(super) &'a str);

impl Render for Text<'_> {
    fn render_to(&self, buffer: &mut String) {
        clean(self.0).render_to(buffer);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_becomes_text() {
        let rendered = |text| Text(text).render().into_string();
        assert_eq!(rendered("<b a=\"1\" c='2'>&"), "&lt;b a=&quot;1&quot; c='2'&gt;&amp;");
        assert_eq!(rendered("a\u{0}b\nc"), "a b c");
        assert_eq!(rendered("q̇ 5 °C"), "q̇ 5 °C");
    }
}
