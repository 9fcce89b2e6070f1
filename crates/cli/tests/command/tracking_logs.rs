//! Commanded and actual positions in other formats than CSV give the model of the CSV files.

use serde_json::Value;

use crate::fixture::Lab;
use crate::robot_logs::{JOINT_STATE, Message, SECOND, State, bag, mcap_bytes};
use crate::servo::log;

/// Writes the logs of the servo as CSV, as MCAP and as bags, with names and stamps of ROS.
fn lab() -> Lab {
    let lab = Lab::new();
    for folder in ["csv", "mcap"] {
        std::fs::create_dir_all(lab.path(folder)).unwrap();
    }
    for number in 1..=4 {
        let log = log(number);
        let names = ["commanded", "actual"].map(|kind| format!("{kind}_position"));
        let [r, y] = &names;
        let mut text = format!("stamp [ns],{r} a,{y} a,{r} b,{y} b\n");
        let mut messages = Vec::new();
        for (k, time) in log.times.iter().enumerate() {
            let stamp = 1_700_000_000 * SECOND + (time * 1e9).round() as i64;
            let [r, y] = [log.command[k], log.actual[k]];
            text += &format!("{stamp},{},{},{},{}\n", r[0], y[0], r[1], y[1]);
            for (topic, values) in [("/joint_states", y), ("/joint_commands", r)] {
                let state = State::new(stamp, &["a", "b"], [&values, &[], &[]]);
                let data = state.encode(false);
                messages.push(Message::new(topic, JOINT_STATE, stamp + 1000, data));
            }
        }
        lab.write(&format!("csv/{number}.csv"), text);
        lab.write(&format!("mcap/{number}.mcap"), mcap_bytes("zstd", &messages));
        let folder = format!("bags/{number}");
        std::fs::create_dir_all(lab.path(&folder)).unwrap();
        lab.write(&format!("{folder}/metadata.yaml"), "");
        bag(&lab.path(&folder), &messages);
    }
    lab
}

#[test]
fn names_of_joints_in_messages_are_kept_as_they_are() {
    let (lab, names) = (Lab::new(), ["fr3_joint1", "tool_lift_d"]);
    std::fs::create_dir_all(lab.path("logs")).unwrap();
    for number in 1..=4 {
        let log = log(number);
        let messages = log.times.iter().enumerate().flat_map(|(k, time)| {
            let stamp = SECOND + (time * 1e9).round() as i64;
            [("/joint_states", log.actual[k]), ("/joint_commands", log.command[k])].map(
                |(topic, values)| {
                    let data = State::new(stamp, &names, [&values, &[], &[]]).encode(false);
                    Message::new(topic, JOINT_STATE, stamp, data)
                },
            )
        });
        let messages: Vec<Message> = messages.collect();
        lab.write(&format!("logs/{number}.mcap"), mcap_bytes("none", &messages));
    }
    lab.run("model --data logs --out arm").exits(0);
    let joints = numbers(&lab, "arm");
    assert_eq!([0, 1].map(|joint| &joints[0][joint]["name"]), names);
    // Columns of CSV files have nothing to say about messages.
    lab.run("check --model arm/model.json --data logs").exits(0);
    lab.run("model --data logs --columns angle=deg,time=t_2 --out degrees").exits(0);
    assert_eq!(numbers(&lab, "degrees"), joints);
}

#[test]
fn joints_that_are_chosen_by_number_are_found_in_other_logs() {
    let lab = Lab::new();
    std::fs::create_dir_all(lab.path("logs")).unwrap();
    for number in 1..=4 {
        let log = log(number);
        let mut text = String::from("time [s],action_0,action_1,action_2");
        text += ",observation.state_0,observation.state_1,observation.state_2\n";
        for (k, time) in log.times.iter().enumerate() {
            let [r, y] = [log.command[k], log.actual[k]];
            text += &format!("{time},{},7,{},{},7,{}\n", r[0], r[1], y[0], y[1]);
        }
        lab.write(&format!("logs/{number}.csv"), text);
    }
    lab.run("model --data logs --joints 0,2 --out two").exits(0);
    assert_eq!(numbers(&lab, "two")[0][1]["name"], "joint_2");
    lab.run("check --model two/model.json --data logs/2.csv").exits(0);
    lab.run("reach --model two/model.json --plan logs/3.csv --out tube").exits(0);
}

/// Returns the numbers of a model.
fn numbers(lab: &Lab, model: &str) -> Value {
    let model: Value = serde_json::from_str(&lab.read(&format!("{model}/model.json"))).unwrap();
    serde_json::json!([model["joints"], model["factor"], model["delay"], model["step"]])
}

#[test]
fn logs_of_ros_give_the_model_of_their_csv_files() {
    let lab = lab();
    lab.run("model --data csv --out of-csv").exits(0);
    for folder in ["mcap", "bags"] {
        let run = lab.run(&format!("model --data {folder} --out of-{folder}")).exits(0);
        assert!(run.stderr.contains("come from /joint_commands, /joint_states"), "{}", run.stderr);
        assert_eq!(numbers(&lab, &format!("of-{folder}")), numbers(&lab, "of-csv"));
        lab.run(&format!("check --model of-csv/model.json --data {folder}")).exits(0);
    }
    lab.run("check --model of-mcap/model.json --data csv").exits(0);
    // A log is a plan too.
    lab.run("reach --model of-csv/model.json --plan mcap/1.mcap --out tube").exits(0);
    // One joint may be chosen.
    lab.run("model --data mcap --joints b --out one").exits(0);
    assert_eq!(numbers(&lab, "one")[0][0]["name"], "b");
    lab.run("check --model one/model.json --data csv").exits(0);
    let run = lab.run("model --data mcap --topic /joint_states --out none").exits(2);
    assert!(run.stderr.contains("--topic STATE COMMAND"), "{}", run.stderr);
    let run = lab.run("model --data mcap --joints c --out none").exits(2);
    assert!(run.stderr.contains("no topic has actual positions"), "{}", run.stderr);
    let run = lab.run("model --data csv --joints c --out none").exits(2);
    assert!(run.stderr.contains("1.csv:1: "), "{}", run.stderr);
}
