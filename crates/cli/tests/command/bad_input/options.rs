//! Bad options, and places that cannot be written.

use super::Case;

macro_rules! with {
    ($command:literal, $more:literal) => {
        concat!($command, " ", $more)
    };
}

macro_rules! conform {
    ($more:literal) => {
        with!("conform --robot arm.toml --data data --torque compensated", $more)
    };
}

/// Returns a case of a command line that is wrong whatever the files are.
const fn case(what: &'static str, command: &'static str, words: &'static [&'static str]) -> Case {
    Case::refused(what, |_| (), command, words)
}

pub(super) const CASES: &[Case] = &[
    case("no command", "", &["Usage: reachtube"]),
    case("an unknown command", "conforms", &["unrecognized subcommand 'conforms'", "conform"]),
    case(
        "an unknown option",
        conform!("--disturbence sample"),
        &["'--disturbence'", "--disturbance"],
    ),
    case("no data", "conform --robot arm.toml --torque motor", &["--data <FOLDER>"]),
    case(
        "no torque",
        "conform --robot arm.toml --data data",
        &["--torque motor, link or compensated"],
    ),
    case(
        "an unknown torque",
        "conform --robot arm.toml --data data --torque raw",
        &["invalid value 'raw'", "compensated, motor, link"],
    ),
    case(
        "another torque than the model's",
        "check --model model.json --data data --torque motor",
        &["--torque motor, but the model was found with --torque compensated"],
    ),
    case(
        "an unknown suite",
        conform!("--suites A,C"),
        &["there is no suite \"C\"; the data set has A, B"],
    ),
    case("a suite twice", conform!("--suites A,A"), &["a suite is named twice in A,A"]),
    case("a negative time", conform!("--until -1"), &["'-1'", "give a number of seconds above 0"]),
    case("too few weights", conform!("--weights 1,2,3"), &["--weights: 3 values given", "or 4"]),
    case("a weight of 0", conform!("--weights 0,1"), &["weight 1 is 0", "between 1e-9 and 1e9"]),
    case("a negative noise", conform!("--noise -1,0"), &["noise radius 1 is -1"]),
    case(
        "the robot's equations beside a model that is not linear",
        conform!("--method bisection --equations robot"),
        &["need a linear model", "(--equations model)"],
    ),
    case(
        "an expansion point of another robot",
        conform!("--expansion 1,2,3"),
        &["3 values", "the robot has 2 joints"],
    ),
    case("a fit of an unknown group", conform!("--fit inertai"), &["exists: 'inertia'"]),
    case(
        "a pull above 1",
        conform!("--fit viscous --pull 2"),
        &["the weight of the pull is 2; give a number from 0 to 1"],
    ),
    case("a negative pull", conform!("--fit viscous --pull -1"), &["the pull is -1"]),
    case(
        "a fit of an abstraction",
        "conform --abstraction a.json --data data --torque compensated --fit viscous",
        &["'--abstraction <FILE>' cannot be used with '--fit"],
    ),
    case("a huge order", conform!("--paper-model 3 --order 4000000000"), &["order"]),
    case("an order of 0", conform!("--order 0"), &["order 1 at least"]),
    case(
        "a file that is a folder",
        conform!("--out data"),
        &["data: cannot write: it is a folder"],
    ),
    case(
        "a folder that is a file",
        conform!("--report arm.toml"),
        &["arm.toml: this is a file, but a folder is needed"],
    ),
    case(
        "a file of others",
        conform!("--out arm.toml"),
        &["arm.toml: a file of this name exists", "--force"],
    ),
    case(
        "a motion without end",
        "excite --robot arm.toml --period 1e9 --out e.csv",
        &["100000000001 samples", "--most-samples"],
    ),
    case(
        "a motion without a period",
        "excite --robot arm.toml --period 0 --out e.csv",
        &["give a number of seconds above 0"],
    ),
    case(
        "too many harmonics",
        "excite --robot arm.toml --harmonics 100000 --out e.csv",
        &["100000 is not in 1..=1000"],
    ),
    case(
        "no logs",
        "prepare --robot arm.toml --data none.csv --out windows",
        &["none.csv", "cannot read"],
    ),
    case(
        "a cut-off beyond the rate",
        "prepare --robot arm.toml --data data/A_1.csv --cut-off 1e6 --out windows",
        &["cut_off = 1000000 Hz must be above 0 and below 50.0000 Hz"],
    ),
    case("no robot for identify", "identify --excitation data/A_1.csv", &["no robot is given"]),
    case("no exciting motions", "identify --robot arm.toml", &["--excitation"]),
    case(
        "a position of another robot",
        "robot show arm.toml --expansion 1",
        &["--expansion lists 1; give 2 positions"],
    ),
    Case {
        what: "windows longer than the logs",
        spoil: |lab| {
            let zeros = |k| format!("{:.2},0,0,0,0,0,0\n", f64::from(k) * 0.01);
            let samples: String = (0..300).map(zeros).collect();
            lab.write("log.csv", format!("t,q1,q2,qd1,qd2,tau1,tau2\n{samples}"));
        },
        command: "prepare --robot arm.toml --data log.csv --cut-off 10 --window 1000 --out windows",
        code: 2,
        words: &["no recording is left: the windows are 1000 s long, but the longest"],
    },
    Case {
        what: "an abstraction and a robot",
        spoil: |_| (),
        command: conform!("--abstraction a.json"),
        code: 2,
        words: &["cannot be used with"],
    },
];
