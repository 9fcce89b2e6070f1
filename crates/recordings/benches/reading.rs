//! Reading of a recording in memory: 1000 samples of six joints, 19 columns of CSV with six
//! decimals. The SHA-256 of the bytes, which every recording has, is measured by itself too.

use std::fmt::Write;

use divan::counter::BytesCount;
use divan::{Bencher, black_box};
use reachtube_recordings::{ReadOptions, parse_csv};
use sha2::{Digest, Sha256};

const SAMPLES: usize = 1000;
const COLUMNS: usize = 18;

fn main() {
    divan::main();
}

/// Returns the content of a recording. `tools/compare` gives its peers the same.
fn content() -> String {
    let names = ["q", "qd", "tau"].map(|of| (1..=6).map(move |joint| format!("{of}{joint}")));
    let names: Vec<String> = names.into_iter().flatten().collect();
    let mut content = format!("t,{}\n", names.join(","));
    for k in 0..SAMPLES {
        write!(content, "{:.3}", 0.004 * k as f64).unwrap();
        for column in 0..COLUMNS {
            write!(content, ",{:.6}", (0.01 * k as f64 + column as f64).sin()).unwrap();
        }
        content.push('\n');
    }
    content
}

#[divan::bench]
fn read_csv_and_digest_of_six_joints(bencher: Bencher) {
    let (content, options) = (content(), ReadOptions::default());
    bencher
        .counter(BytesCount::new(content.len()))
        .bench(|| parse_csv("run.csv".as_ref(), black_box(content.as_bytes()), &options).unwrap());
}

#[divan::bench]
fn digest_of_six_joints(bencher: Bencher) {
    let content = content();
    bencher
        .counter(BytesCount::new(content.len()))
        .bench(|| Sha256::digest(black_box(content.as_bytes())));
}
