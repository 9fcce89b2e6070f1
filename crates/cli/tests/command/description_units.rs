//! Descriptions in another unit than recordings.

use crate::wrong_inputs::{MODEL, arm, lab, write};

#[test]
fn lengths_of_the_description_in_another_unit_are_named() {
    let lab = lab();
    write(&lab, &|_, _, _| ());
    for (length, words) in [("-400", "in mm"), ("-40", "in cm")] {
        let robot = arm(1.0).replace("-0.4]", &format!("{length}]"));
        let centre = if length == "-40" { "-20]" } else { "-0.2]" };
        lab.write("arm.toml", robot.replace("-0.2]", centre));
        let said = lab.run(MODEL).exits(3).stdout.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(said.starts_with("not acceptable: The distances between joints"), "{said}");
        assert!(said.contains(&format!("of the description are probably {words}: ")), "{said}");
    }
}
