//! A system as a file describes it.

use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;

use schemars::JsonSchema;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

/// A system x' = A x + B u + E w, y = C x + D u + F v, as a TOML file describes it; x' is the next
/// state of a discrete system, and the rate of a continuous one. A recording starts in
/// x(0) ∈ x̂(0) + X0, w is constant over each step in W, and v lies in V.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SystemDescription {
    /// How the system moves on.
    pub kind: SystemKind,
    /// The time between samples of a discrete system, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// The states, N.
    #[serde(default)]
    pub states: Vec<NamedSignal>,
    /// The inputs, m, with the names of their columns.
    #[serde(default)]
    pub inputs: Vec<NamedSignal>,
    /// The outputs, p, with the names of their columns.
    pub outputs: Vec<NamedSignal>,
    /// A, N x N.
    #[serde(rename = "A", default, skip_serializing_if = "Option::is_none")]
    pub a: Option<MatrixRows>,
    /// B, N x m; 0 if it is left out.
    #[serde(rename = "B", default, skip_serializing_if = "Option::is_none")]
    pub b: Option<MatrixRows>,
    /// E, N x q; B if it is left out, or 1 without B.
    #[serde(rename = "E", default, skip_serializing_if = "Option::is_none")]
    pub e: Option<MatrixRows>,
    /// C, p x N; if it is left out, each output is the state of its name.
    #[serde(rename = "C", default, skip_serializing_if = "Option::is_none")]
    pub c: Option<MatrixRows>,
    /// D, p x m; 0 if it is left out.
    #[serde(rename = "D", default, skip_serializing_if = "Option::is_none")]
    pub d: Option<MatrixRows>,
    /// F, p x r; 1 if it is left out.
    #[serde(rename = "F", default, skip_serializing_if = "Option::is_none")]
    pub f: Option<MatrixRows>,
    /// The delay of inputs, s, by their names.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub delay: BTreeMap<String, MatrixEntry>,
    /// Numbers that entries of matrices and delays may name, and that are found from recordings.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub parameters: BTreeMap<String, SystemParameter>,
    /// Where the nominal motion of a recording starts. If it is left out: at the columns of the
    /// states, if a recording has all of them, and else where its first samples tell.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<NominalStartRule>,
    /// The sets.
    #[serde(default)]
    pub sets: SetDescriptions,
    /// The weight of each output in the cost; 1 by the range of the recorded output if they are
    /// left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<Vec<f64>>,
}

/// A matrix, row by row.
pub type MatrixRows = Vec<Vec<MatrixEntry>>;

/// An entry of a matrix: a number, or a formula of parameters such as "-1 / tau".
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum MatrixEntry {
    /// A number.
    Number(f64),
    /// A formula.
    Formula(String),
}

/// A number that is found from recordings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SystemParameter {
    /// Its value, with which a search begins.
    pub start: f64,
    /// Its lowest value.
    pub low: f64,
    /// Its highest value.
    pub high: f64,
}

/// How a system moves on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SystemKind {
    /// From sample to sample.
    Discrete,
    /// By rates.
    Continuous,
    /// From sample to sample, by outputs and inputs of earlier samples, with factors that are found
    /// from the recordings.
    Arx,
}

/// Where the nominal motion of a recording starts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum NominalStartRule {
    /// At the first values of the columns of the states.
    Columns,
    /// Where the outputs of this many first samples tell, by least squares.
    Samples(usize),
    /// At this state, N.
    At(Vec<f64>),
    /// At outputs and inputs of earlier samples: this many of each.
    Past {
        /// The number of outputs, the first one included.
        outputs: usize,
        /// The number of inputs before the first one.
        inputs: usize,
    },
}

/// A name, with a unit where it is known: text, or a table.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum NamedSignal {
    /// The name.
    Name(String),
    /// Name and unit.
    WithUnit(SignalUnit),
}

/// A name and a unit.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SignalUnit {
    /// The name.
    pub name: String,
    /// The unit.
    pub unit: String,
}

impl NamedSignal {
    /// Returns the name.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Name(name) | Self::WithUnit(SignalUnit { name, .. }) => name,
        }
    }

    /// Returns the unit with a blank before it; no text if it is not known.
    #[must_use]
    pub fn unit(&self) -> String {
        match self {
            Self::Name(_) => String::new(),
            Self::WithUnit(SignalUnit { unit, .. }) => format!(" {unit}"),
        }
    }
}

/// The sets of a system.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SetDescriptions {
    /// X0; a box that is found if it is left out.
    #[serde(rename = "X0", skip_serializing_if = "Option::is_none")]
    pub start: Option<SetDescription>,
    /// W; a box that is found if it is left out.
    #[serde(rename = "W", skip_serializing_if = "Option::is_none")]
    pub disturbance: Option<SetDescription>,
    /// V; none if it is left out.
    #[serde(rename = "V", skip_serializing_if = "Option::is_none")]
    pub noise: Option<SetDescription>,
    /// Where the centres of boxes lie that are found.
    pub centre: BoxCentre,
}

/// Where the centres of boxes lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum BoxCentre {
    /// Where the sets are the smallest. V has the centre 0.
    #[default]
    Free,
    /// At 0.
    Zero,
}

/// A set: text, or a table.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum SetDescription {
    /// A simple one.
    Simple(SimpleSet),
    /// One with generators or radii.
    Shaped(ShapedSet),
}

/// A set without numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SimpleSet {
    /// A box whose radii are found.
    Box,
    /// The point 0.
    None,
}

/// The set of all sums of generators, each times a number from -1 to 1.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ShapedSet {
    /// The generators, each with an entry for each dimension.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub generators: Vec<Vec<f64>>,
    /// The radii of a box, in place of generators.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub radius: Vec<f64>,
    /// Whether each generator has its own factor, or all have one.
    pub scale: ScaleOf,
    /// Whether the set is as it is given, and not scaled.
    pub fixed: bool,
}

/// What has a factor of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ScaleOf {
    /// Each generator.
    #[default]
    Each,
    /// The set.
    Common,
}

/// Reads a text by `of_text`, and a table by `of_table`.
struct TextOrTable<T, F, G>(&'static str, F, G, PhantomData<T>);

impl<'de, T: Deserialize<'de>, R, F, G> Visitor<'de> for TextOrTable<T, F, G>
where
    F: FnOnce(&str) -> Option<R>,
    G: FnOnce(T) -> R,
{
    type Value = R;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<R, E> {
        let Self(expected, of_text, ..) = self;
        of_text(text).ok_or_else(|| E::custom(format!("\"{text}\" is not {expected}")))
    }

    fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<R, M::Error> {
        T::deserialize(MapAccessDeserializer::new(map)).map(self.2).map_err(M::Error::custom)
    }
}

impl<'de> Deserialize<'de> for NamedSignal {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let expected = "a name, or { name = \"px\", unit = \"m\" }";
        let of_text = |text: &str| Some(Self::Name(text.into()));
        deserializer.deserialize_any(TextOrTable(expected, of_text, Self::WithUnit, PhantomData))
    }
}

impl<'de> Deserialize<'de> for SetDescription {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let expected = "\"box\", \"none\", or a table with generators or radius";
        let of_text = |text: &str| match text {
            "box" => Some(Self::Simple(SimpleSet::Box)),
            "none" => Some(Self::Simple(SimpleSet::None)),
            _ => None,
        };
        deserializer.deserialize_any(TextOrTable(expected, of_text, Self::Shaped, PhantomData))
    }
}

impl<'de> Deserialize<'de> for MatrixEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct EntryVisitor;

        impl Visitor<'_> for EntryVisitor {
            type Value = MatrixEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number, or a formula of parameters such as \"-1 / tau\"")
            }

            fn visit_f64<E>(self, number: f64) -> Result<MatrixEntry, E> {
                Ok(MatrixEntry::Number(number))
            }

            fn visit_i64<E>(self, number: i64) -> Result<MatrixEntry, E> {
                Ok(MatrixEntry::Number(number as f64))
            }

            fn visit_u64<E>(self, number: u64) -> Result<MatrixEntry, E> {
                Ok(MatrixEntry::Number(number as f64))
            }

            fn visit_str<E>(self, text: &str) -> Result<MatrixEntry, E> {
                Ok(MatrixEntry::Formula(text.into()))
            }
        }

        deserializer.deserialize_any(EntryVisitor)
    }
}
