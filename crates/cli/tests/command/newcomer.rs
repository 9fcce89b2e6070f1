//! The path of a newcomer, as the guide has it.

use crate::fixture::Lab;
use crate::short::is_short_of_the_demo;

/// Returns the commands of the first block of a guide.
fn commands(guide: &str) -> Vec<String> {
    let lines = guide.lines().skip_while(|line| !line.starts_with("    reachtube "));
    let block: Vec<&str> = lines.take_while(|line| line.starts_with("    ")).collect();
    let joined = block.join("\n").replace("\\\n", " ");
    joined.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

#[test]
fn three_commands_lead_to_a_verified_stop_with_its_page_in_short_answers() {
    let lab = Lab::new();
    let commands = commands(include_str!("../../../../docs/verify.md"));
    let [demo, stop, verify] = &commands[..] else { panic!("{commands:?}") };
    let run = |command: &str, more: &str| {
        let arguments = command.strip_prefix("reachtube ").unwrap();
        lab.run(&format!("{arguments}{more}"))
    };
    is_short_of_the_demo(&run(demo, " --quiet").exits(0).stdout);
    let stop = run(stop, " --every 20").exits(0).stdout;
    assert!(stop.starts_with("stands: from each of "), "{stop}");
    assert!(lab.read("stops/stop.html").contains("Annex B"));
    let safe = run(verify, "").exits(0).stdout;
    assert!(safe.starts_with("safe: "), "{safe}");
    assert!(lab.names("cell").contains(&"verify.html".to_string()));
    assert!(lab.read("demo/page/report.html").contains("Conformant and useful"));
}
