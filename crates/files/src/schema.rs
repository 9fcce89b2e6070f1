//! JSON schemas of types that are written as JSON.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::{Value, json};

/// The function `json_schema` of a type.
type SchemaOf = fn(&mut SchemaGenerator) -> Schema;

fn generator() -> SchemaGenerator {
    SchemaSettings::draft2020_12().for_serialize().into_generator()
}

/// Returns the schema of what `T` writes, which refuses keys that it does not know.
///
/// # Examples
///
/// ```
/// use reachtube_files::{ErrorKind, schema};
///
/// assert_eq!(schema::<ErrorKind>()["oneOf"][0]["const"], "usage");
/// ```
#[must_use]
pub fn schema<T: JsonSchema>() -> Value {
    let mut schema = generator().into_root_schema_for::<T>().to_value();
    close(&mut schema);
    schema
}

/// Returns one schema for many types: each is a definition under its name, and a value fits if it
/// fits one of them.
#[must_use]
pub fn schema_of_any(title: &str, named: &[(&str, SchemaOf)]) -> Value {
    let mut generator = generator();
    let schemas = named.iter().map(|(name, of)| (*name, of(&mut generator)));
    let schemas: Vec<(&str, Schema)> = schemas.collect();
    let refer = |(name, _): &(&str, _)| json!({ "$ref": format!("#/$defs/{name}") });
    let any: Vec<Value> = schemas.iter().map(refer).collect();
    let mut definitions = generator.take_definitions(true);
    definitions.extend(schemas.into_iter().map(|(name, schema)| (name.into(), schema.to_value())));
    let mut schema = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": title,
        "anyOf": any,
        "$defs": definitions,
    });
    close(&mut schema);
    schema
}

/// Lets every object refuse keys that it does not list, and writes descriptions as plain text.
fn close(schema: &mut Value) {
    match schema {
        Value::Array(parts) => parts.iter_mut().for_each(close),
        Value::Object(object) => {
            let has_parts = ["allOf", "anyOf", "oneOf"].iter().any(|key| object.contains_key(*key));
            let is_open = ["additionalProperties", "unevaluatedProperties"]
                .iter()
                .all(|key| object.get(*key).is_none_or(|value| value == true));
            let lists = object.get("properties").is_some_and(Value::is_object);
            if lists && is_open {
                object.remove("additionalProperties");
                let key = if has_parts { "unevaluatedProperties" } else { "additionalProperties" };
                object.insert(key.into(), false.into());
            }
            if let Some(Value::String(text)) = object.get_mut("description") {
                *text = plain(text);
            }
            // Parts of an object that has its own keys do not know these.
            let is_part = |key: &str| lists && matches!(key, "allOf" | "anyOf" | "oneOf");
            object.iter_mut().filter(|(key, _)| !is_part(key)).for_each(|(_, value)| close(value));
        }
        _ => {}
    }
}

/// Returns a comment without its line breaks, links and escapes.
fn plain(comment: &str) -> String {
    let lines = comment.replace("\n\n", "\u{0}").replace('\n', " ").replace('\u{0}', "\n\n");
    let mut text = String::new();
    for part in lines.replace("\\[", "[").replace("\\]", "]").split("](") {
        match (text.rfind("[`"), part.split_once(')')) {
            (Some(at), Some((_, rest))) => {
                text.remove(at);
                text.push_str(rest);
            }
            _ => text.push_str(part),
        }
    }
    text
}
