//! What moves are for, as remarks of a text: `(role lead)` before the first of them, `(role none)` after the last.
//!
//! A role holds for feed moves, up to the next such remark, operation or tool change. Letters and a space pass through any machine's
//! character set; where a machine takes no remarks, its text states no roles.

use styluscam_motion::Role;

const ROLES: [(Role, &str); 4] = [(Role::Cut, "cut"), (Role::Lead, "lead"), (Role::Ramp, "ramp"), (Role::Link, "link")];
const NONE: &str = "none";
const WORD: &str = "role ";

/// The remark before moves of a role, or of none.
pub(crate) fn remark(role: Option<Role>) -> String {
    let name = ROLES.iter().find(|(known, _)| Some(*known) == role).map_or(NONE, |(_, name)| name);
    format!("{WORD}{name}")
}

/// The role that a remark states, or none; nothing where it is another remark.
pub(crate) fn of_remark(text: &str) -> Option<Option<Role>> {
    let text = text.to_ascii_lowercase();
    let name = text.strip_prefix(WORD)?.trim();
    let known = ROLES.iter().find(|(_, known)| *known == name).map(|(role, _)| Some(*role));
    known.or((name == NONE).then_some(None))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remarks_are_read_as_they_are_written_in_any_case() {
        for role in ROLES.map(|(role, _)| Some(role)).into_iter().chain([None]) {
            assert_eq!(of_remark(&remark(role)), Some(role));
            assert_eq!(of_remark(&remark(role).to_uppercase()), Some(role));
        }
        assert_eq!(of_remark("role model"), None);
        assert_eq!(of_remark("operation lead: z-level"), None);
    }
}
