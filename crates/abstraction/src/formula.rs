//! A model as a formula.

use std::fmt::{Display, Formatter, Result};

use super::PolynomialModel;

/// One line a joint: qdd1 = 0.5762 u1 - 6.638 qd1 + ..., the terms by degree, each coefficient with
/// all its digits. Where a variable is an offset, it is written so: (c2 - 1).
impl Display for PolynomialModel {
    fn fmt(&self, out: &mut Formatter<'_>) -> Result {
        let offset = |(name, origin): (String, &f64)| match *origin {
            0.0 => name,
            origin if origin < 0.0 => format!("({name} + {})", -origin),
            origin => format!("({name} - {origin})"),
        };
        let names: Vec<String> =
            self.layout().names().into_iter().zip(self.origin()).map(offset).collect();
        for (i, acceleration) in self.acceleration().iter().enumerate() {
            write!(out, "qdd{} =", i + 1)?;
            let terms = acceleration.terms();
            if terms.is_empty() {
                write!(out, " 0")?;
            }
            for (place, term) in terms.iter().enumerate() {
                let sign = match (term.coefficient < 0.0, place) {
                    (true, _) => " -",
                    (false, 0) => "",
                    (false, _) => " +",
                };
                write!(out, "{sign} {}", term.coefficient.abs())?;
                for (name, exponent) in names.iter().zip(&term.exponents) {
                    match exponent {
                        0 => {}
                        1 => write!(out, " {name}")?,
                        _ => write!(out, " {name}^{exponent}")?,
                    }
                }
            }
            writeln!(out)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use reachtube_robot::Robot;

    use crate::{ExpansionPoint, ModelKind, PolynomialModel};

    #[test]
    fn a_pendulum_reads_as_its_equation() {
        let text = "schema_version = 1\nname = \"p\"\n[[joint]]\nname = \"p\"\nplacement = {}\narmature = 0.5\nfriction = { viscous = [1.0, 0.0, -0.25] }\n";
        let robot = Robot::from_toml(text, "p").unwrap();
        let point = ExpansionPoint::zero(1);
        let formula = |kind| PolynomialModel::new(&robot, kind, 3, &point).unwrap().to_string();
        assert_eq!(formula(ModelKind::One), "qdd1 = - 2 qd1 + 2 u1 + 0.5 qd1^3\n");
        assert_eq!(formula(ModelKind::One), formula(ModelKind::Two));
    }
}
