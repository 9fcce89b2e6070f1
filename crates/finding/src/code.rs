use std::borrow::Cow;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a [`Finding`](crate::Finding) is about, by its name in JSON. Codes are stable; the words of
/// a finding are not. They are listed in docs/reference.md.
#[derive(
    Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(transparent)]
pub struct Code(Cow<'static, str>);

impl Code {
    /// Makes a code of its name.
    #[must_use]
    pub const fn new(name: &'static str) -> Self {
        Self(Cow::Borrowed(name))
    }

    /// Returns the name of the code, as in JSON.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.0
    }
}

/// Defines the codes of a crate: an enum whose variants have a name and a meaning, the sentence of
/// their documentation.
///
/// # Examples
///
/// ```
/// mod sorted {
///     reachtube_finding::codes! {
///         /// What a finding about logs is about.
///         pub enum Code {
///             /// A log has no motion.
///             NoMotion = "no-motion",
///         }
///     }
/// }
/// use reachtube_finding::{Finding, Severity};
///
/// let finding = Finding::new(Severity::Warning, sorted::Code::NoMotion, "The log has no motion.");
/// assert_eq!(finding.code, sorted::Code::NoMotion);
/// assert_eq!(finding.code.name(), "no-motion");
/// assert_eq!(sorted::Code::of(&finding.code).unwrap().meaning(), "A log has no motion.");
/// ```
#[macro_export]
macro_rules! codes {
    (
        $(#[$documented:meta])*
        $visible:vis enum $Codes:ident {
            $($(#[doc = $doc:literal])* $code:ident = $name:literal,)*
        }
    ) => {
        $(#[$documented])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[non_exhaustive]
        $visible enum $Codes {
            $($(#[doc = $doc])* $code,)*
        }

        impl $Codes {
            /// All codes.
            pub const ALL: &[Self] = &[$(Self::$code),*];

            /// Returns the name of the code, as in JSON.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$code => $name,)*
                }
            }

            /// Returns what findings of the code state, as a sentence.
            #[must_use]
            pub fn meaning(self) -> &'static str {
                match self {
                    $(Self::$code => concat!($($doc),*).trim_ascii(),)*
                }
            }

            /// Returns the code of that name; `None` if it is a code of another crate.
            #[must_use]
            pub fn of(code: &$crate::Code) -> Option<Self> {
                Self::ALL.iter().copied().find(|own| *code == *own)
            }
        }

        impl From<$Codes> for $crate::Code {
            fn from(code: $Codes) -> Self {
                Self::new(code.name())
            }
        }

        impl PartialEq<$Codes> for $crate::Code {
            fn eq(&self, other: &$Codes) -> bool {
                self.name() == other.name()
            }
        }
    };
}
