//! Edits of XML text in place that keep all other text byte for byte.

use core::ops::Range;
use roxmltree::Node;

/// Replacements of byte ranges of a text.
#[derive(Default)]
pub(super) struct Edits(Vec<(Range<usize>, String)>);

impl Edits {
    /// Sets an attribute of an element, and adds the attribute if it is absent.
    pub(super) fn set(&mut self, node: Node, name: &str, value: &str) {
        let edit = match node.attribute_node(name) {
            Some(attribute) => (attribute.range_value(), value.into()),
            None => {
                let text = &node.document().input_text()[node.range()];
                let tag = text
                    .find(|c: char| c.is_whitespace() || c == '/' || c == '>')
                    .unwrap_or(text.len());
                let at = node.range().start + tag;
                (at..at, format!(" {name}=\"{value}\""))
            }
        };
        self.0.push(edit);
    }

    /// Sets attributes of the first child element with a tag, and adds the child if it is absent.
    pub(super) fn set_child(&mut self, node: Node<'_, '_>, tag: &str, values: &[(&str, String)]) {
        match node.children().find(|n| n.is_element() && n.tag_name().name() == tag) {
            Some(child) => values.iter().for_each(|(name, value)| self.set(child, name, value)),
            None => self.add(node, &empty_element(tag, values)),
        }
    }

    /// Adds an element at the end of another, with the indentation of its siblings.
    pub(super) fn add(&mut self, node: Node, new: &str) {
        let (text, range) = (node.document().input_text(), node.range());
        let line = text[..range.start].rfind('\n').map_or(0, |k| k + 1);
        let outer: String = text[line..].chars().take_while(|c| *c == ' ' || *c == '\t').collect();
        let last = node.children().rfind(Node::is_element);
        let inner = match last {
            Some(sibling) => {
                let line = text[..sibling.range().start].rfind('\n').map_or(0, |k| k + 1);
                text[line..].chars().take_while(|c| *c == ' ' || *c == '\t').collect()
            }
            None => format!("{outer}  "),
        };
        let new = format!("\n{inner}{}", new.replace('\n', &format!("\n{inner}")));
        if let Some(sibling) = last {
            self.0.push((sibling.range().end..sibling.range().end, new));
        } else if text[range.clone()].ends_with("/>") {
            // <tag/> becomes <tag>...</tag>.
            let tag = text[range.start + 1..]
                .split(|c: char| c.is_whitespace() || c == '/')
                .next()
                .unwrap_or_default();
            self.0.push((range.end - 2..range.end, format!(">{new}\n{outer}</{tag}>")));
        } else {
            let end = range.start + text[range.clone()].rfind("</").unwrap_or(range.len());
            self.0.push((end..end, format!("{new}\n{outer}")));
        }
    }

    /// Applies all edits and returns the new text.
    pub(super) fn apply(mut self, text: &str) -> String {
        self.0.sort_by_key(|(range, _)| range.start);
        let (mut out, mut at) = (String::with_capacity(text.len()), 0);
        for (range, new) in self.0 {
            out += &text[at..range.start];
            out += &new;
            at = range.end;
        }
        out + &text[at..]
    }
}

/// Formats the element `<tag name="value" .../>`.
pub(super) fn empty_element(tag: &str, values: &[(&str, String)]) -> String {
    let attributes: String =
        values.iter().map(|(name, value)| format!(" {name}=\"{value}\"")).collect();
    format!("<{tag}{attributes}/>")
}
