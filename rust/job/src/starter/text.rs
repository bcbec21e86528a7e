//! Pieces of a starter job's text.

/// Width of comments, in characters.
const WIDTH: usize = 110;

/// A sentence as a comment's lines.
pub fn wrapped(reason: &str) -> String {
    let mut lines = vec![String::from("# -")];
    for word in reason.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= WIDTH => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(format!("#   {word}")),
        }
    }
    lines.join("\n") + "\n"
}

/// A TOML string.
pub fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// A number with a point.
pub fn number(value: f64) -> String {
    format!("{value:?}")
}
