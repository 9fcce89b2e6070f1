use reachtube_abstraction::{
    Abstraction, Error, ModelKind, PolynomialModel, Records, RecordsError,
};
use reachtube_robot::Robot;
use reachtube_scalar::TaylorPolynomial;

use crate::common::model;

#[test]
fn files_keep_every_bit() {
    let robot = Robot::lwa4p();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.json");
    for (kind, order) in
        [(ModelKind::One, 3), (ModelKind::Two, 4), (ModelKind::Two, 12), (ModelKind::Three, 3)]
    {
        let model = model(&robot, kind, order);
        std::fs::write(&path, model.to_json()).unwrap();
        let read = PolynomialModel::load(&path).unwrap();
        assert_eq!(
            read.acceleration().iter().map(TaylorPolynomial::terms).collect::<Vec<_>>(),
            model.acceleration().iter().map(TaylorPolynomial::terms).collect::<Vec<_>>()
        );
        assert_eq!((read.kind(), read.order(), read.origin()), (kind, order, model.origin()));
    }
}

#[test]
fn changed_records_are_refused() {
    let robot = Robot::lwa4p();
    let model = model(&robot, ModelKind::Two, 3);
    let abstraction = Abstraction { model: model.kind(), order: model.order() };
    let refused = |change: fn(&mut Records)| {
        let mut records = model.records();
        change(&mut records);
        let point = model.expansion_point();
        match PolynomialModel::from_records(&robot, abstraction, point, records).unwrap_err() {
            Error::Records(error) => error,
            other => panic!("{other}"),
        }
    };
    let names = model.variable_names();
    assert_eq!(
        refused(|records| records.variables.reverse()),
        RecordsError::Variables { expected: names }
    );
    let size = RecordsError::Size { origin: 23, accelerations: 6, variables: 24, joints: 6 };
    assert_eq!(refused(|records| records.origin.truncate(23)), size);
    assert!(matches!(
        refused(|records| records.acceleration[2][0].1 = f64::NAN),
        RecordsError::Term { joint: 3, .. }
    ));
    assert_eq!(refused(|records| records.acceleration[5][0].1 *= 1.001), RecordsError::Changed);
    // A file must not ask for a model that takes minutes to make.
    let large = Abstraction { order: 60, ..abstraction };
    let (point, records) = (model.expansion_point(), model.records());
    let error = PolynomialModel::from_records(&robot, large, point, records).unwrap_err();
    assert!(matches!(error, Error::Records(RecordsError::Order { order: 60, variables: 24 })));
}
