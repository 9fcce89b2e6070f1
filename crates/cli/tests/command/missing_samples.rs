//! Logs in which samples are missing or wrong: no window crosses them.

use crate::fixture::Lab;
use crate::output_schema::fits;
use crate::wrong_inputs::{MODEL, Row, lab, write};

/// Returns the answer of `model` with the texts of its warnings about samples that are left out.
fn left_out(lab: &Lab, change: &dyn Fn(&mut Row, usize, usize)) -> (serde_json::Value, String) {
    write(lab, change);
    let run = lab.run(&format!("{MODEL} --json"));
    assert!(run.code != 2, "{run:#?}");
    let answer = run.json();
    fits("model", &answer);
    let findings = answer["findings"].as_array().unwrap().iter();
    let texts = findings.filter(|finding| finding["code"] == "missing-samples").map(|finding| {
        assert_eq!(finding["severity"], "warning");
        finding["text"].as_str().unwrap()
    });
    let texts = texts.collect::<Vec<_>>().join("\n");
    (answer, texts)
}

#[test]
fn no_window_crosses_samples_that_are_missing_or_wrong() {
    let lab = lab();
    let (whole, none) = left_out(&lab, &|_, _, _| ());
    assert_eq!(none, "");
    type Case<'a> = (&'a str, &'a dyn Fn(&mut Row, usize, usize));
    let lost = |row: &mut Row, k: usize, of: std::ops::Range<usize>| {
        if of.contains(&k) {
            row[0] = f64::NAN;
        }
    };
    let cases: [Case; 6] = [
        (
            "log_1.csv:502: 200 ms of samples are missing before 5.200 s: nothing is",
            &|row, k, number| {
                if number == 1 {
                    lost(row, k, 500..520);
                }
            },
        ),
        ("log_2.csv:402: 10 ms of samples are missing before 4.010 s (the first of 2 places)", {
            &|row, k, number| {
                if number == 2 {
                    lost(row, k, 400..401);
                    lost(row, k, 700..740);
                }
            }
        }),
        ("log_0.csv:7: 300 ms of samples are missing before 0.350 s", &|row, k, number| {
            if number == 0 {
                lost(row, k, 5..35);
            }
        }),
        ("log_3.csv:302: elbow at 3.000 s jumps by 0.5", &|row, k, number| {
            row[2] += if (k, number) == (300, 3) { 0.5 } else { 0.0 };
        }),
        (
            "log_1.csv:602: the sample at 6.000 s is the first of 3 rows of zeros",
            &|row, k, number| {
                if number == 1 && (600..603).contains(&k) {
                    row[1..].fill(0.0);
                }
            },
        ),
        ("log_1.csv:602: shoulder at 6.000 s has a torque of -999.0", &|row, k, number| {
            if (k, number) == (600, 1) {
                row[5] = -999.0;
            }
        }),
    ];
    for (place, change) in cases {
        let (answer, text) = left_out(&lab, change);
        assert!(text.starts_with(place), "{text}");
        assert!(text.contains("s are not used") && text.lines().count() == 1, "{text}");
        assert_eq!(answer["conformant"], true, "{text}: {answer}");
        let horizon = |of: &serde_json::Value| of["horizon"].as_f64().unwrap();
        assert!(horizon(&answer) >= 0.5 * horizon(&whole), "{text}: {answer}");
    }
}

#[test]
fn a_log_that_is_mostly_lost_is_refused_and_many_wrong_samples_contradict_the_robot() {
    let lab = lab();
    let lost = |is_lost: &dyn Fn(usize) -> bool| {
        write(&lab, &|row, k, number| {
            if number == 1 && is_lost(k) {
                row[0] = f64::NAN;
            }
        });
        lab.run(MODEL).exits(2).stderr
    };
    let text = lost(&|k| (300..500).contains(&k));
    let words = "log_1.csv:302: 2000 ms of samples are missing before 5.000 s; so much";
    assert!(text.contains(words) && text.contains("2.0 s of 10.0 s cannot be used"), "{text}");
    // One sample in a second: no stretch between is long enough for the low-pass.
    let text = lost(&|k| k % 100 == 99);
    assert!(text.contains("10 ms of samples are missing before 1.000 s (the first of 9"), "{text}");
    // A joint that counts from elsewhere, and zeros in many rows.
    let refused = |change: &dyn Fn(&mut Row, usize, usize)| {
        write(&lab, change);
        let text = lab.run(MODEL).exits(3).stdout;
        text.lines().take(4).collect::<Vec<_>>().join(" ")
    };
    let text = refused(&|row, k, number| row[1] += if number == 1 && k > 400 { 0.5 } else { 0.0 });
    let words = "not acceptable: log_1.csv:403: shoulder at 4.010 s jumps by 0.5";
    assert!(text.starts_with(words), "{text}");
    let text = refused(&|row, k, number| {
        if number == 1 && k % 20 == 7 {
            row[1..].fill(0.0);
        }
    });
    let words = "not acceptable: log_1.csv:9: the sample at 0.070 s is a row of zeros";
    assert!(text.starts_with(words), "{text}");
}

#[test]
fn check_leaves_out_what_is_missing_or_wrong_and_says_so() {
    let lab = lab();
    write(&lab, &|_, _, _| ());
    // Sets of the recorded starts alone touch them, and a low-pass of shorter stretches differs.
    lab.write("limits.toml", "largest-growth = 1.0\n");
    lab.run(&format!("{MODEL} --horizon 0.3 --settings limits.toml"));
    let check = |change: &dyn Fn(&mut Row, usize, usize)| {
        write(&lab, change);
        let run = lab.run("check --model made/model.json --data logs --json");
        (run.json()["suites"].as_array().unwrap().len(), run)
    };
    let (all, run) = check(&|_, _, _| ());
    assert!(!run.stderr.contains("are not used"), "{run:#?}");
    let (some, gap) = check(&|row, k, number| {
        if number == 2 && (500..550).contains(&k) {
            row[0] = f64::NAN;
        }
    });
    assert!(gap.stderr.contains("log_2.csv:502: 500 ms of samples are missing"), "{gap:#?}");
    assert!(some < all && gap.code == run.code, "{some} of {all}: {gap:#?}");
    let (some, wrong) = check(&|row, k, number| {
        row[1] += if (k, number) == (500, 2) { 0.5 } else { 0.0 };
    });
    assert!(wrong.stderr.contains("log_2.csv:502: shoulder at 5.000 s jumps"), "{wrong:#?}");
    assert!(some < all && wrong.code == run.code, "{some} of {all}: {wrong:#?}");
    let words = "no window of a log crosses one";
    lab.run("check --model made/model.json --data logs --max-gap 0.1").fails_with(&[words]);
}
