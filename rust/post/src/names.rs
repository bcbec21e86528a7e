//! The names that templates may use, and where a template uses another one.

use std::collections::BTreeMap;

use crate::machine::{most_similar, MachineError};

/// Names that every template may use; those with a dot are parts of one.
pub const NAMES: [(&str, &str); 29] = [
    ("header", "what templates.header makes: the summary of the set-up, as remarks"),
    ("machine.name", "the machine's name"),
    ("machine.description", "what it is"),
    ("machine.verified", "whether its facts are confirmed, in part at least"),
    ("machine.unconfirmed", "what is not, a list of texts"),
    ("program.number", "the program's number with its zeros; empty where the machine has none"),
    ("program.name", "the program's name in characters that the machine takes; empty where it has none"),
    ("program.title", "the job's title"),
    ("program.wcs", "the job's work offset: G54"),
    ("program.zero", "where the zero point is, in words"),
    ("program.part_min", "lower corner of the part's box, mm, a list of three"),
    ("program.part_max", "its upper corner"),
    ("program.clearance", "height at which rapids may cross the part, mm"),
    ("program.deepest_z", "lowest Z of a tip at feed, mm"),
    ("program.notes", "what planning and verification report, a list of texts"),
    ("program.uses_spindle", "whether the spindle turns"),
    ("tools", "the tools, a list; each as `tool` in tool_change"),
    ("units", "mm or inch"),
    ("units_word", "the code of the unit: G21"),
    ("feed_word", "the code of the feed mode: G94"),
    ("wcs", "the machine's words for the work offset"),
    ("wcs_number", "which work offset it is, from 1"),
    ("end", "the code that ends the program"),
    ("smoothing", "the block that states how closely the path is kept; empty where there is none"),
    ("path_tolerance", "how closely that is, in words"),
    ("has_length_offsets", "whether the machine takes length offsets"),
    ("length_with_z", "whether they stand in the first block that moves Z"),
    ("options", "the machine's own options: options.NAME"),
    ("loop", "in loops, minijinja's own"),
];

/// Names of one template only: the template's key, the name, what it is.
pub const OWN_NAMES: [(&str, &str, &str); 19] = [
    (
        "templates.tool_change",
        "retract",
        "the lines that send Z to the machine's top; elsewhere Z would not be known behind them",
    ),
    ("templates.program_end", "retract", "the same"),
    ("templates.tool_change", "tool.name", "the tool's name in the job"),
    ("templates.tool_change", "tool.number", "its number"),
    ("templates.tool_change", "tool.length_offset", "its length offset's number"),
    ("templates.tool_change", "tool.description", "what it is: clothoid D10"),
    ("templates.tool_change", "tool.reference", "tip or center: which point the Z are of"),
    ("templates.tool_change", "tool.reference_height", "height of that point above the tip, mm"),
    ("templates.tool_change", "tool.diameter", "its diameter, mm"),
    ("templates.tool_change", "length_words", "the words of its length offset: G43 H1"),
    ("templates.tool_change", "first", "whether no tool was called before"),
    ("templates.tool_change", "next_tool", "number of the tool after it where the machine makes it ready, else 0"),
    ("templates.operation_", "operation.id", "the operation's name"),
    ("templates.operation_", "operation.kind", "its kind: z-level"),
    ("templates.stop", "optional", "whether it is an optional stop"),
    ("templates.sync", "mark", "the number that both programs have there"),
    ("rotary.tip_control.on", "tool.number", "the tool's number"),
    ("rotary.tip_control.on", "tool.length_offset", "its length offset's number"),
    ("smoothing.on", "tolerance", "how far the path may be left, in output units, rounded down"),
];

/// Functions that every template may call.
pub const FUNCTIONS: [(&str, &str); 3] = [
    ("comment", "comment(text): remarks in characters and lengths that the machine takes"),
    ("length", "length(mm): a length in the output's unit and decimals"),
    ("feed", "feed(mm_per_min): a feed likewise"),
];

/// minijinja's own functions that are left in.
const BUILT_IN: [&str; 4] = ["range", "dict", "namespace", "debug"];

/// The first name of a template that it may not use.
pub(crate) fn unknown_name<'n>(
    template: &str,
    source: &str,
    used: impl Iterator<Item = &'n str>,
) -> Option<MachineError> {
    let own = OWN_NAMES.iter().filter(|(key, ..)| template.starts_with(key)).map(|(_, name, _)| *name);
    let names: Vec<&str> = NAMES.iter().map(|(name, _)| *name).chain(own).collect();
    let free = |name: &str| name == "options" || name.starts_with("options.") || name.starts_with("loop");
    let function = |name: &str| FUNCTIONS.iter().any(|(f, _)| *f == name) || BUILT_IN.contains(&name);
    let known = |name: &str| {
        let root = |n: &&str| n.split('.').next() == Some(name);
        free(name) || function(name) || names.contains(&name) || !name.contains('.') && names.iter().any(root)
    };
    let mut strangers: BTreeMap<(usize, usize), &str> = BTreeMap::new();
    for name in used.filter(|name| !known(name)) {
        strangers.insert(position(source, name), name);
    }
    let ((line, column), name) = strangers.into_iter().next()?;
    let similar = most_similar(name, names);
    let hint = similar.map(|similar| format!("; did you mean {similar}?")).unwrap_or_default();
    let message = format!("column {column}: there is no {name} here{hint}");
    Some(MachineError::Template { name: template.into(), line, message })
}

/// Line and column, from 1, where a name stands first.
fn position(source: &str, name: &str) -> (usize, usize) {
    let at = source.match_indices(name).map(|(at, _)| at).find(|at| {
        let edge = |c: Option<char>| c.is_none_or(|c| !c.is_ascii_alphanumeric() && c != '_' && c != '.');
        let (before, after) = (source.get(..*at), source.get(at + name.len()..));
        edge(before.and_then(|s| s.chars().next_back())) && edge(after.and_then(|s| s.chars().next()))
    });
    let before = at.and_then(|at| source.get(..at)).unwrap_or_default();
    let line = before.matches('\n').count() + 1;
    (line, before.rsplit('\n').next().unwrap_or_default().chars().count() + 1)
}
