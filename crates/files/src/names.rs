//! Names of files.

use std::collections::HashSet;

/// Returns names of files that are distinct, ignoring case, with each of `endings` appended too. A
/// name contains no path separator and does not begin with a dot.
///
/// # Examples
///
/// ```
/// let names = ["A", "a", "../A"].map(String::from);
/// let chosen = reachtube_files::distinct_names(names.into_iter(), &[""]);
/// assert_eq!(chosen, ["A", "a_2", "_._A"]);
/// ```
pub fn distinct_names(names: impl Iterator<Item = String>, endings: &[&str]) -> Vec<String> {
    let mut taken = HashSet::new();
    let mut choose = |name: String| {
        let name = path_safe(&name);
        let numbered = (2..).map(|number| format!("{name}_{number}"));
        let free =
            |name: &String| endings.iter().all(|ending| !taken.contains(&lower(name, ending)));
        let chosen = std::iter::once(name.clone()).chain(numbered).find(free).unwrap_or_default();
        taken.extend(endings.iter().map(|ending| lower(&chosen, ending)));
        chosen
    };
    names.map(&mut choose).collect()
}

fn lower(name: &str, ending: &str) -> String {
    format!("{name}{ending}").to_lowercase()
}

fn path_safe(name: &str) -> String {
    let safe = |c: char| if c.is_alphanumeric() || "-_.+ ".contains(c) { c } else { '_' };
    let name: String = name.chars().map(safe).collect();
    if name.starts_with('.') { name.replacen('.', "_", 1) } else { name }
}

#[cfg(test)]
mod tests {
    use super::distinct_names;

    #[test]
    fn names_stay_in_the_folder_and_apart() {
        let names = ["A", "a", "A_tube", "../A", "", "A"].map(String::from);
        let chosen = distinct_names(names.into_iter(), &["", "_tube"]);
        assert_eq!(chosen, ["A", "a_2", "A_tube_2", "_._A", "", "A_3"]);
    }
}
