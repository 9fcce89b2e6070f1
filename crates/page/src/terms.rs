//! The terms of a page, each with its explanation: on hover, and in a list at the end.

use maud::{Markup, Render, html};

use super::text::clean;

/// The terms and their explanations. A term of capital letters is found as it is written.
const TERMS: [(&str, &str); 21] = [
    ("allowance", "radii that were added to the smallest sets for motions not recorded"),
    (
        "conformant",
        "every recording was proved to lie in the model's reachable set, at its samples",
    ),
    (
        "cost",
        "the set's width, summed over states and integrated over time; it adds rad to rad/s and \
              grows with the length of the motions, so it is compared only within one data set",
    ),
    ("deviation", "recorded state minus the nominal motion"),
    (
        "directed rounding",
        "every rounding error is enclosed, so that a claim holds for the exact \
                           numbers",
    ),
    ("disturbance", "how the input may differ from the nominal input over time, within U"),
    ("held out", "recordings that no choice and no set was made of"),
    ("horizon", "time up to which the model predicts, from the start of a recording or window"),
    ("interval hull", "the smallest box around a set: bounds of each state by itself"),
    ("margin", "distance of a sample to the boundary of the set; negative outside"),
    ("nominal motion", "the model's own motion from the nominal start under the recorded input"),
    ("notion", "the directions in which recordings must lie in the set"),
    (
        "of its motion",
        "half the width of the joint's set, by how far the joint moves; above 100 % the set \
            hardly limits the motion",
    ),
    ("phase plane", "position and velocity of one joint together"),
    ("reachable set", "the states that the model can reach from X0 under every input in U"),
    ("row", "one comparison of a recording with the set: one suite, sample and state"),
    ("suite", "recordings from one start under one input"),
    ("vacuous", "proved, but too wide to limit the motion of some joint"),
    ("X0", "set of initial states, around the nominal start"),
    (
        "U",
        "set of inputs, around the nominal input: it covers the differences between nominal \
        and recorded motion",
    ),
    ("V", "set of the measurement noise"),
];

/// A text from outside, in which the first use of each term has its explanation on hover, and what
/// is between backticks is code.
pub(super) struct Explained<'a>(pub(super) &'a str);

impl Render for Explained<'_> {
    fn render_to(&self, buffer: &mut String) {
        let text = clean(self.0);
        let mut from = 0;
        for (start, end, explanation) in found(&text) {
            with_code(&text[from..start], buffer);
            html! { abbr title=(explanation) { (text[start..end]) } }.render_to(buffer);
            from = end;
        }
        with_code(&text[from..], buffer);
    }
}

/// Renders a text, and what is between two backticks in it as code.
fn with_code(text: &str, buffer: &mut String) {
    let parts: Vec<&str> = text.split('`').collect();
    if parts.len().is_multiple_of(2) {
        return text.render_to(buffer);
    }
    for (number, part) in parts.into_iter().enumerate() {
        match number % 2 {
            0 => part.render_to(buffer),
            _ => html! { code { (part) } }.render_to(buffer),
        }
    }
}

pub(super) fn meaning(term: &str) -> &'static str {
    TERMS.iter().find(|(name, _)| *name == term).map_or("", |(_, meaning)| meaning)
}

/// Returns where terms are used first in a text, in order and without overlaps.
fn found(text: &str) -> Vec<(usize, usize, &'static str)> {
    let lower = text.to_ascii_lowercase();
    let place = |(term, explanation): &(&str, &'static str)| {
        let within = if term.starts_with(char::is_uppercase) { text } else { &lower };
        let of_word = |c: char| c.is_alphanumeric() || c == '_';
        let whole = |start: usize| {
            let rest = &within[start + term.len()..];
            let plural = usize::from(rest.starts_with('s') && term.len() > 2);
            let is_whole =
                !within[..start].ends_with(of_word) && !rest[plural..].starts_with(of_word);
            let is_code = text[..start].matches('`').count() % 2 == 1;
            (is_whole && !is_code).then_some((start, start + term.len() + plural, *explanation))
        };
        within.match_indices(term).find_map(|(start, _)| whole(start))
    };
    let mut all: Vec<_> = TERMS.iter().filter_map(place).collect();
    all.sort_by_key(|(start, end, _)| (*start, std::cmp::Reverse(*end)));
    let mut last = 0;
    all.retain(|(start, end, _)| {
        let is_free = *start >= last;
        last = if is_free { *end } else { last };
        is_free
    });
    all
}

pub(super) fn list() -> Markup {
    html! {
        dl.terms {
            @for (term, explanation) in &TERMS { div { dt { (term) } dd { (explanation) } } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_use_of_a_term_is_explained_and_texts_are_escaped() {
        let html =
            Explained("All rows <b> lie in the reachable set; rows of U").render().into_string();
        assert!(html.starts_with("All <abbr title=\"one comparison"), "{html}");
        assert_eq!(html.matches("<abbr").count(), 3, "{html}");
        assert!(html.contains(">rows</abbr> &lt;b&gt; lie in the <abbr"), "{html}");
        assert!(html.contains(">U</abbr>"), "{html}");
    }

    #[test]
    fn what_is_between_backticks_is_code_without_explanations() {
        let html = Explained("`conform --horizon <T>` and X0").render().into_string();
        assert!(html.starts_with("<code>conform --horizon &lt;T&gt;</code> and <abbr"), "{html}");
        assert_eq!(Explained("one ` alone").render().into_string(), "one ` alone");
    }

    #[test]
    fn parts_of_words_are_no_terms() {
        let html = Explained("arrows, costly, Urgent, X0_1, a vision").render().into_string();
        assert_eq!(html, "arrows, costly, Urgent, X0_1, a vision");
        let longest = Explained("the nominal motion").render().into_string();
        assert_eq!(longest.matches("<abbr").count(), 1, "{longest}");
    }
}
