//! One list for each kind of fault: what occurs, its stable code, the message, and what to do.

/// Makes an enum of faults with `code` and `hint`. A variant states its code, its message (as thiserror takes it) and its
/// hint, in which fields stand as in the message; `@transparent` ones are another error's.
macro_rules! faults {
    (
        $(#[$meta:meta])*
        pub enum $fault:ident;
        $(@transparent $(#[$outer:meta])* $inner:ident($error:ty);)*
        $(
            $(#[$doc:meta])*
            $name:ident $({ $($(#[$field_doc:meta])* $field:ident: $type:ty,)* })?
            = $code:literal, ($($message:tt)+), $hint:literal;
        )*
    ) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, thiserror::Error)]
        pub enum $fault {
            $($(#[$outer])* #[error(transparent)] $inner(#[from] $error),)*
            $(
                $(#[$doc])*
                #[doc = ""]
                #[doc = concat!("To do: ", $hint, ".")]
                #[error($($message)+)]
                $name $({ $($(#[$field_doc])* $field: $type,)* })?,
            )*
        }

        impl $fault {
            /// A stable name for scripts.
            #[must_use]
            pub fn code(&self) -> &'static str {
                match self {
                    $(Self::$inner(error) => error.code(),)*
                    $(Self::$name { .. } => $code,)*
                }
            }

            /// What to do, in a sentence.
            #[must_use]
            #[allow(unused_variables, clippy::useless_format)] // fields that no hint names; hints without fields
            pub fn hint(&self) -> String {
                match self {
                    $(Self::$inner(error) => error.hint(),)*
                    $(Self::$name $({ $($field),* })? => format!($hint),)*
                }
            }
        }
    };
}

pub(crate) use faults;
