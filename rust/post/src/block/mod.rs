//! What all who interpret blocks share: numbers and words, comments, the table of codes, modal state, arcs, cycles, the program that
//! is recorded.
//!
//! The [`reader`](crate::reader) is strict, because verification stands on it; the [tracer](crate::ngc) shows what it
//! can. Where they differ on purpose, the difference is a value here: [`Comments`], [`Slack`](arc::Slack), [`Least`](arc::Least).

pub(crate) mod arc;
mod codes;
mod comments;
mod cycle;
mod modes;
mod number;
mod recorder;
mod words;

pub(crate) use codes::{g_code, m_code, Code, Length, Motion, Stop};
pub(crate) use comments::{CommentFault, Comments};
pub(crate) use cycle::{end_height, CycleWords};
pub(crate) use modes::{Feed, FeedFault, Modes};
pub(crate) use number::{code, cut_number, Misfit, Number};
pub(crate) use recorder::Recorder;
pub(crate) use words::{once, Twice, Words};
