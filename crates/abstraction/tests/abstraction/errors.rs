use reachtube_abstraction::{Error, ExpansionPoint, ModelKind, PolynomialModel};
use reachtube_robot::Robot;

#[test]
fn orders_that_do_not_fit_are_refused_with_a_remedy() {
    let robot = Robot::lwa4p();
    let zero = ExpansionPoint::zero(6);
    let refusal =
        |kind, order| PolynomialModel::new(&robot, kind, order, &zero).unwrap_err().to_string();
    assert!(refusal(ModelKind::One, 0).contains("order 1 at least"));
    let large = refusal(ModelKind::Three, 20);
    assert!(large.contains("GB for its terms") && large.contains("order 10 fits"), "{large}");
    assert!(
        refusal(ModelKind::Two, 40).contains("up to order 31"),
        "{}",
        refusal(ModelKind::Two, 40)
    );
}

#[test]
fn expansion_points_that_do_not_fit_are_refused() {
    let error = |values: &[f64]| ExpansionPoint::from_values(values, 2).unwrap_err();
    assert!(matches!(error(&[0.0; 3]), Error::ExpansionPointSize { values: 3, joints: 2 }));
    let text = error(&[0.0, f64::INFINITY]).to_string();
    assert_eq!(text, "value 2 of the expansion point is inf; give finite numbers");
}
