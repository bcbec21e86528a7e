//! One table for what scripts and people need of each fault: its stable code, and what to do.

/// Implements `code` and `hint` for an enum of faults, by a line for each variant: pattern, code, hint.
macro_rules! codes_and_hints {
    ($fault:ident, $hint_type:ty; $($pattern:pat => $code:expr, $hint:expr;)*) => {
        impl $fault {
            /// A stable name for scripts.
            #[must_use]
            #[allow(unused_variables)] // values that the hint names
            pub fn code(&self) -> &'static str {
                match self {
                    $($pattern => $code,)*
                }
            }

            /// What to do, in a sentence.
            #[must_use]
            pub fn hint(&self) -> $hint_type {
                match self {
                    $($pattern => <$hint_type>::from($hint),)*
                }
            }
        }
    };
}

pub(crate) use codes_and_hints;
