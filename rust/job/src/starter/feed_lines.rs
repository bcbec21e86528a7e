//! What is written into a job about material, cutters, feeds and spindle.

/// Feeds and spindle of every operation of a job.
pub struct StarterFeeds {
    /// Lines of the process.
    pub process: String,
    /// Lines of each tool.
    pub tool: String,
    /// Lines of each operation.
    pub operations: Vec<String>,
}
