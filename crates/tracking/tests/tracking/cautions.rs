//! Number of motions, and what they allow to say of others.

use reachtube_finding::Severity;
use reachtube_tracking::Code;

use crate::common::{made, servo, texts};

#[test]
fn fewer_than_3_motions_say_nothing_of_others() {
    for count in 1..=3 {
        let made = made(&servo(count));
        let few = count < 3;
        assert!(made.model.verified);
        assert_eq!(made.model.left_out.motions as u64, count);
        assert_eq!((made.is_useful(), made.model.has_motions()), (!few, !few), "{count}");
        assert_eq!(texts(&made, Code::FewMotions).len(), usize::from(few), "{count}");
        let said = made.verdict();
        assert_eq!(said.contains("describes these recordings only"), few, "{said}");
        assert_eq!(made.model.next_motion() == "no guarantee", few);
        assert!(made.findings.iter().all(|of| of.severity == Severity::Warning));
        assert_eq!(made.model.left_out.inside.is_some(), !few);
    }
}

/// Two motions in one recording are two motions.
#[test]
fn motions_are_counted_and_not_recordings() {
    let mut recordings = servo(4);
    let last = recordings.pop().unwrap();
    let of = &mut recordings[2];
    let end = of.times.last().unwrap() + 0.01;
    of.times.extend(last.times.iter().map(|time| end + time));
    of.command.extend(last.command);
    of.actual.extend(last.actual);
    let model = made(&recordings).model;
    assert_eq!((model.recordings.len(), model.left_out.motions), (3, 4));
    let names: Vec<String> =
        model.check(&recordings).unwrap().motions.into_iter().map(|of| of.name).collect();
    assert_eq!(names, ["motion_1", "motion_2", "motion_3:1", "motion_3:2"]);
}

#[test]
fn from_20_recordings_on_every_second_one_calibrates() {
    let recordings = servo(20);
    let model = made(&recordings).model;
    assert!(model.verified && model.is_useful());
    // The second, fourth and so on are kept. A plan that rests on its way has two motions.
    let check = model.check(&recordings).unwrap();
    let number = |name: &str| -> usize {
        name.strip_prefix("motion_").unwrap().split(':').next().unwrap().parse().unwrap()
    };
    let is_kept = |name: &str| number(name).is_multiple_of(2);
    let kept = check.motions.iter().filter(|motion| is_kept(&motion.name)).count();
    assert!((10..check.motions.len() - 9).contains(&kept), "{kept}");
    assert_eq!(model.left_out.motions, check.motions.len());
    assert_eq!((model.left_out.calibrated, model.left_out.inside), (Some(10), None));
    assert!(model.next_motion().starts_with("at most 1 in 11 recordings leaves"));
    let furthest = model.left_out.furthest.clone().unwrap();
    assert!(is_kept(&furthest), "{furthest}");
    // That motion touches its set, and the others that were kept do not leave theirs.
    let needed = check.motions.iter().find(|motion| motion.name == furthest).unwrap().needed;
    assert!(model.factor > 1.0 && (1.0 - 1e-9..=1.0).contains(&needed), "{needed}");
    let fewer = made(&recordings[..19]).model;
    assert_eq!(fewer.left_out.calibrated, None);
}
