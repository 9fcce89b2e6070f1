use std::any::Any;

use schemars::JsonSchema;
use serde::Serialize;

/// What an error is about, which decides how a front end reports it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ErrorKind {
    /// The command line.
    Usage,
    /// The value of an option, a key or an argument.
    Setting,
    /// A file that could not be read or written.
    File,
    /// A file or text that is no model, or a model of another version.
    Model,
    /// Recordings or logs.
    Recordings,
    /// A robot's description.
    Robot,
    /// A question that has no answer for this input.
    NoAnswer,
}

/// An error that says what it is about, so that front ends need no names of its variants.
///
/// # Examples
///
/// ```
/// use reachtube_files::{ErrorKind, Kind, read_text};
///
/// let error = read_text("none.csv".as_ref(), "name another file").unwrap_err();
/// assert_eq!(error.kind(), ErrorKind::File);
/// ```
pub trait Kind: std::error::Error + Any + Send + Sync {
    /// Returns what the error is about.
    fn kind(&self) -> ErrorKind;

    /// Returns the error of a crate below that this one passes on word for word.
    fn inner(&self) -> Option<&dyn Kind> {
        None
    }
}

impl dyn Kind {
    /// Returns the error itself, or the one that it passes on, if it is a `T`.
    #[must_use]
    pub fn find<T: Kind>(&self) -> Option<&T> {
        let this: &dyn Any = self;
        this.downcast_ref().or_else(|| self.inner()?.find())
    }
}

impl<E: Kind> Kind for Box<E> {
    fn kind(&self) -> ErrorKind {
        (**self).kind()
    }

    fn inner(&self) -> Option<&dyn Kind> {
        Some(&**self)
    }
}

/// An error of a crate above, which the crate that passes it on does not know.
#[derive(Debug)]
pub struct AnyError(Box<dyn Kind>);

impl std::fmt::Display for AnyError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl std::error::Error for AnyError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.0.source()
    }
}

impl AnyError {
    /// Takes an error.
    pub fn new(error: impl Kind) -> Self {
        Self(Box::new(error))
    }
}

impl Kind for AnyError {
    fn kind(&self) -> ErrorKind {
        self.0.kind()
    }

    fn inner(&self) -> Option<&dyn Kind> {
        Some(&*self.0)
    }
}

/// Implements [`Kind`] for an enum: the variants that pass on another error, the variants of each
/// kind, and the kind of all others.
///
/// # Examples
///
/// ```
/// use reachtube_files::{Error, ErrorKind, Kind, kinds};
///
/// #[derive(Debug, thiserror::Error)]
/// enum MeshError {
///     #[error("the mesh has no triangles; name another file")]
///     Empty,
///     #[error("a scale of {0}; give a number above 0")]
///     Scale(f64),
///     #[error(transparent)]
///     File(#[from] Error),
/// }
///
/// kinds!(MeshError { [File] => inner, Scale => Setting, _ => Robot });
///
/// assert_eq!(MeshError::Scale(0.0).kind(), ErrorKind::Setting);
/// assert_eq!(MeshError::Empty.kind(), ErrorKind::Robot);
/// ```
#[macro_export]
macro_rules! kinds {
    ($error:ty {
        $([$($inner:ident)|+] => inner,)?
        $($($variant:ident)|+ => $kind:ident,)*
        _ => $other:ident $(,)?
    }) => {
        impl $crate::Kind for $error {
            fn kind(&self) -> $crate::ErrorKind {
                match self {
                    $($(Self::$inner(error) => $crate::Kind::kind(error),)+)?
                    $($(Self::$variant { .. } => $crate::ErrorKind::$kind,)+)*
                    #[allow(unreachable_patterns)]
                    _ => $crate::ErrorKind::$other,
                }
            }

            fn inner(&self) -> Option<&dyn $crate::Kind> {
                match self {
                    $($(Self::$inner(error) => Some(error),)+)?
                    #[allow(unreachable_patterns)]
                    _ => None,
                }
            }
        }
    };
}
