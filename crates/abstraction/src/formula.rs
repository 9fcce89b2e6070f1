use std::fmt::{Display, Formatter, Result};

use crate::polynomial_model::PolynomialModel;

/// Writes the accelerations as formulas, one line per joint: qdd1 = 0.5762 u1 - 6.638 qd1 + ...
///
/// Terms are ordered by degree, and each coefficient has all its digits. An offset of a variable is
/// written as a difference: (c2 - 1).
impl Display for PolynomialModel {
    fn fmt(&self, out: &mut Formatter<'_>) -> Result {
        let offset = |(name, origin): (String, &f64)| match *origin {
            0.0 => name,
            origin if origin < 0.0 => format!("({name} + {})", -origin),
            origin => format!("({name} - {origin})"),
        };
        let names: Vec<String> =
            self.variable_names().into_iter().zip(self.origin()).map(offset).collect();
        for (i, acceleration) in self.acceleration().iter().enumerate() {
            write!(out, "qdd{} =", i + 1)?;
            let terms = acceleration.terms();
            if terms.is_empty() {
                write!(out, " 0")?;
            }
            for (index, term) in terms.iter().enumerate() {
                let sign = match (term.coefficient < 0.0, index) {
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

    use crate::expansion_point::ExpansionPoint;
    use crate::model_kind::ModelKind;
    use crate::polynomial_model::PolynomialModel;

    const PENDULUM: &str = r#"
        schema_version = 1
        name = "p"
        [[joint]]
        name = "p"
        placement = {}
        armature = 0.5
        friction = { viscous = [1.0, 0.0, -0.25] }
    "#;

    #[test]
    fn a_pendulum_prints_its_equation() {
        let robot = Robot::from_toml(PENDULUM, "p").unwrap();
        let point = ExpansionPoint::zero(1);
        let formula = |kind| PolynomialModel::new(&robot, kind, 3, &point).unwrap().to_string();
        assert_eq!(formula(ModelKind::One), "qdd1 = - 2 qd1 + 2 u1 + 0.5 qd1^3\n");
        assert_eq!(formula(ModelKind::One), formula(ModelKind::Two));
    }
}
