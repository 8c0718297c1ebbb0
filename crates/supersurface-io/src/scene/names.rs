//! Names that files, XML, USD and simulators all accept, made of the names that people give.

use std::collections::BTreeSet;

/// Most characters of a name, before the number that makes it unique.
const MOST: usize = 60;
/// What Windows keeps for its devices.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];

/// Gives out names, each only once: letters, digits and underscores, beginning with a letter.
///
/// Names that differ in capitals alone are the same to some file systems, so they are the same here.
#[derive(Debug)]
pub(super) struct Names {
    taken: BTreeSet<String>,
}

impl Names {
    /// `reserved` are names that are never given.
    pub(super) fn new(reserved: &[&str]) -> Self {
        Self { taken: reserved.iter().map(|name| name.to_lowercase()).collect() }
    }

    /// A new name as near to the wanted one as can be; `kind` leads it where that is empty, begins with a digit or is
    /// a device of Windows.
    pub(super) fn give(&mut self, wanted: &str, kind: &str) -> String {
        let base = safe(wanted, kind);
        let mut name = base.clone();
        let mut count = 1;
        while !self.taken.insert(name.to_lowercase()) {
            count += 1;
            name = format!("{base}_{count}");
        }
        name
    }
}

fn safe(wanted: &str, kind: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let text: String = wanted.chars().take(MOST).map(plain).collect();
    // names between double underscores are SDFormat's own
    let text = text.trim_matches('_');
    let lower = text.to_lowercase();
    let port = |name: &str| {
        let number = lower.strip_prefix(name);
        number.is_some_and(|n| n.len() == 1 && n.chars().all(|c| c.is_ascii_digit()))
    };
    if text.is_empty() {
        kind.to_owned()
    } else if text.starts_with(|c: char| c.is_ascii_digit())
        || DEVICES.contains(&lower.as_str())
        || port("com")
        || port("lpt")
    {
        format!("{kind}_{text}")
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_safe_and_unique() {
        let mut names = Names::new(&["scene", "world"]);
        let long = "x".repeat(300);
        for (wanted, given) in [
            ("tea box", "tea_box"),
            ("../../x", "x"),
            ("X", "X_2"),
            ("", "body"),
            ("", "body_2"),
            ("<a&\"b\">", "a__b"),
            ("Ünïcode ☕", "n_code"),
            ("☕", "body_3"),
            ("7up", "body_7up"),
            ("NUL", "body_NUL"),
            ("com1", "body_com1"),
            ("common", "common"),
            ("world", "world_2"),
            ("__init__", "init"),
            ("a-b", "a_b"),
            ("a_b", "a_b_2"),
            (long.as_str(), &long[..MOST]),
        ] {
            assert_eq!(names.give(wanted, "body"), given, "{wanted}");
        }
    }
}
