/// The units of a list of values, such as a column of a table.
///
/// # Examples
///
/// ```
/// use reachtube_finding::Units;
///
/// let arm = Units::new(["rad", "rad"]);
/// assert_eq!((arm.head("q"), arm.cell(1, "0.2")), ("q [rad]".into(), "0.2".into()));
/// assert_eq!(arm.list(), "rad");
/// let scara = Units::new(["rad", "m"]);
/// assert_eq!((scara.head("q"), scara.cell(1, "0.2")), ("q".into(), "0.2 m".into()));
/// assert_eq!((scara.list(), scara.any()), ("(rad, m)".into(), "rad or m".into()));
/// ```
#[derive(Debug, Clone)]
pub struct Units(Vec<String>);

impl Units {
    /// Takes the unit of each value.
    pub fn new<T: Into<String>>(units: impl IntoIterator<Item = T>) -> Self {
        Self(units.into_iter().map(Into::into).collect())
    }

    /// Returns the unit that all values share.
    #[must_use]
    pub fn shared(&self) -> Option<&str> {
        let first = self.0.first()?;
        self.0.iter().all(|unit| unit == first).then_some(first)
    }

    /// Returns the head of a column: its name, with the unit where all values share it.
    #[must_use]
    pub fn head(&self, name: &str) -> String {
        self.shared().map_or_else(|| name.into(), |unit| format!("{name} [{unit}]"))
    }

    /// Returns the text of a value at an index of the column, with its unit where the head has
    /// none.
    #[must_use]
    pub fn cell(&self, index: usize, value: impl Into<String>) -> String {
        let value = value.into();
        match self.shared() {
            Some(_) => value,
            None => format!("{value} {}", self.0[index]),
        }
    }

    /// Returns the unit behind a list of the values: the one that all share, or else all of them.
    #[must_use]
    pub fn list(&self) -> String {
        self.shared().map_or_else(|| format!("({})", self.0.join(", ")), Into::into)
    }

    /// Returns the unit behind one value of the list, such as `rad` or `rad or m`.
    #[must_use]
    pub fn any(&self) -> String {
        let mut units: Vec<&str> = Vec::new();
        for unit in self.0.iter().filter(|unit| !unit.is_empty()) {
            if !units.contains(&unit.as_str()) {
                units.push(unit);
            }
        }
        units.join(" or ")
    }
}
