//! Every code of a finding is in docs/reference.md.

use reachtube::{conform, pipeline, systems, tracking, verify};

#[test]
fn every_code_is_in_the_docs() {
    let docs = include_str!("../../../../docs/reference.md");
    let of_models = conform::Code::ALL.iter().map(|code| code.name());
    let of_logs = pipeline::Code::ALL.iter().map(|code| code.name());
    let of_scenarios = verify::Code::ALL.iter().map(|code| code.name());
    let of_commands = tracking::Code::ALL.iter().map(|code| code.name());
    let of_systems = systems::Code::ALL.iter().map(|code| code.name());
    let of_commands = of_commands.chain(of_systems);
    for name in of_models.chain(of_logs).chain(of_scenarios).chain(of_commands) {
        assert!(docs.contains(&format!("| `{name}` |")), "{name}");
    }
}
