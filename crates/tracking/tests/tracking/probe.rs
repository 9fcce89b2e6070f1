use crate::common::{made, servo};
#[test]
fn probe_stability() {
    let recordings = servo(6);
    let show = |what: &str, made: &reachtube_tracking::MadeModel| {
        println!(
            "{what}: {:?} factor {} mean {:e} f{:?}",
            made.chosen,
            made.model.factor,
            made.model.mean_half_width(),
            made.model.left_out
        );
        for j in &made.model.joints {
            println!(
                "   {} {} {} {} | {} {} | {}",
                j.offset,
                j.speed,
                j.acceleration,
                j.direction,
                j.radius,
                j.radius_per_speed,
                j.largest_speed
            );
        }
        for f in &made.families {
            println!("      {} {} {:e} {}", f.depends_on, f.grows, f.mean_half_width, f.factor);
        }
    };
    show("whole", &made(&recordings));
    let changed =
        |change: &dyn Fn(&reachtube_tracking::TrackedRun) -> reachtube_tracking::TrackedRun| {
            made(&recordings.iter().map(change).collect::<Vec<_>>())
        };
    use crate::stability::only;
    show("1..", &changed(&|of| only(of, 1..600)));
    show("6..", &changed(&|of| only(of, 6..600)));
    show("even", &changed(&|of| only(of, (0..600).step_by(2))));
    show("odd", &changed(&|of| only(of, (1..600).step_by(2))));
}
#[test]
fn probe_lag() {
    let made = made(&crate::smallest::late());
    println!("{:?}", made.model);
    for f in &made.families {
        println!("      {} {} {:e} {}", f.depends_on, f.grows, f.mean_half_width, f.factor);
    }
    println!("{:?}", made.findings);
    println!("{}", made.summary());
}
