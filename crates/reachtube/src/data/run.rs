use std::path::Path;

use sha2::{Digest, Sha256};

use super::Defect;

/// A longer time between two samples than this many usual ones is a gap, where the rate is fixed.
const FIXED_RATE_GAP: f64 = 1.5;

/// The same where the times jitter.
const JITTER_GAP: f64 = 10.0;

/// Part of the samples that must follow at the usual time for the rate to be called fixed.
const FIXED_RATE_SHARE: f64 = 0.9;

/// How long the time between two samples may be. The input is taken as held until the next sample, so a gap is a guess about the input.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum GapLimit {
    /// 1.5 times the usual time between samples at a fixed rate, 10 times where the times jitter.
    #[default]
    Usual,
    /// As many seconds.
    Seconds(f64),
}

/// One recording: K samples of n joints.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Number of joints n.
    pub joints: usize,
    /// Sample times as recorded, s, strictly increasing, K.
    pub times: Vec<f64>,
    /// States x = (q, q̇), rad and rad/s, row-major K x 2n.
    pub states: Vec<f64>,
    /// Recorded torques, N m, row-major K x n.
    pub torques: Vec<f64>,
    /// SHA-256 of the file, lower-case hexadecimal.
    pub sha256: String,
}

impl Run {
    /// Reads the run in the file `path`; samples later than `until` seconds after the first are left out. A run of other than `joints` joints is
    /// a defect.
    ///
    /// # Errors
    ///
    /// Every defect of the file, with line and joint.
    pub fn read(
        path: &Path,
        joints: Option<usize>,
        gap_limit: GapLimit,
        until: Option<f64>,
    ) -> Result<Self, Vec<Defect>> {
        let bytes = std::fs::read(path).map_err(|source| {
            vec![Defect::new(path, None, format!("cannot read: {source}"), "check the path and its permissions")]
        })?;
        let mut reading = Reading { path, joints: 0, lines: Vec::new(), run: None, defects: Vec::new() };
        reading.header_and_rows(&bytes, joints);
        reading.gaps(gap_limit);
        match reading.run {
            Some(mut run) if reading.defects.is_empty() => {
                run.sha256 = hex(&Sha256::digest(&bytes));
                run.truncate(until);
                Ok(run)
            }
            _ => Err(reading.defects),
        }
    }

    /// Number of samples K.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Time from the first to the last sample, s.
    pub fn duration(&self) -> f64 {
        self.times.last().map_or(0.0, |last| last - self.times[0])
    }

    /// The state (q, q̇) at sample k, 2n entries.
    pub fn state(&self, k: usize) -> &[f64] {
        &self.states[k * 2 * self.joints..(k + 1) * 2 * self.joints]
    }

    /// Joint positions at sample k, rad.
    pub fn q(&self, k: usize) -> &[f64] {
        &self.state(k)[..self.joints]
    }

    /// Joint velocities at sample k, rad/s.
    pub fn qd(&self, k: usize) -> &[f64] {
        &self.state(k)[self.joints..]
    }

    /// Recorded torques at sample k, N m.
    pub fn torque(&self, k: usize) -> &[f64] {
        &self.torques[k * self.joints..(k + 1) * self.joints]
    }

    fn truncate(&mut self, until: Option<f64>) {
        let Some(until) = until else { return };
        let end = self.times[0] + until * (1.0 + 1e-12);
        let count = self.times.partition_point(|&t| t <= end);
        self.times.truncate(count);
        self.states.truncate(count * 2 * self.joints);
        self.torques.truncate(count * self.joints);
    }
}

pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A file while it is read.
struct Reading<'a> {
    path: &'a Path,
    joints: usize,
    /// Line of each sample.
    lines: Vec<u64>,
    run: Option<Run>,
    defects: Vec<Defect>,
}

impl Reading<'_> {
    fn defect(&mut self, line: Option<u64>, joint: Option<usize>, problem: String, remedy: &str) {
        self.defects.push(Defect::new(self.path, line, problem, remedy).of_joint(joint));
    }

    fn header_and_rows(&mut self, bytes: &[u8], joints: Option<usize>) {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let mut reader = csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(bytes);
        let header = match reader.byte_headers() {
            Ok(header) => header.iter().map(|name| String::from_utf8_lossy(name).into_owned()).collect::<Vec<_>>(),
            Err(error) => return self.defect(Some(1), None, error.to_string(), "write the file as UTF-8 CSV"),
        };
        if !self.header(&header, joints) {
            return;
        }
        let run = Run { joints: self.joints, times: vec![], states: vec![], torques: vec![], sha256: String::new() };
        self.run = Some(run);
        let mut record = csv::ByteRecord::new();
        let mut values = vec![0.0; 1 + 3 * self.joints];
        loop {
            match reader.read_byte_record(&mut record) {
                Ok(true) => self.row(&record, header.len(), &mut values),
                Ok(false) => break,
                Err(error) => self.defect(None, None, error.to_string(), "mend the line"),
            }
        }
        if self.lines.is_empty() && self.defects.is_empty() {
            self.defect(None, None, "no sample after the header".into(), "record at least one, or leave the run out of runs.csv");
        }
    }

    /// Whether the header is `t,q1..qn,qd1..qdn,tau1..taun`, possibly with more columns after that.
    fn header(&mut self, header: &[String], joints: Option<usize>) -> bool {
        let n = header.iter().skip(1).take_while(|name| is_numbered(name, "q")).count();
        let expected: Vec<String> = std::iter::once("t".into()).chain(column_names(n.max(1))).collect();
        let wrong = expected.iter().enumerate().find(|(i, name)| header.get(*i) != Some(name));
        if let Some((i, name)) = wrong {
            let found = header.get(i).map_or("missing".into(), |found| format!("\"{found}\""));
            let problem = format!("column {} of the header is {found}, expected \"{name}\"", i + 1);
            self.defect(Some(1), None, problem, "the header is t,q1..qn,qd1..qdn,tau1..taun, in s, rad, rad/s and N m");
            return false;
        }
        if joints.is_some_and(|robot| robot != n) {
            let problem = format!("the run has {n} joints, the robot {}", joints.unwrap_or(0));
            self.defect(Some(1), None, problem, "name the robot that was recorded, or the right data set");
            return false;
        }
        self.joints = n;
        true
    }

    fn row(&mut self, record: &csv::ByteRecord, fields: usize, values: &mut [f64]) {
        let line = record.position().map(|position| position.line());
        if record.len() != fields {
            let problem = format!("{} fields, the header has {fields}", record.len());
            return self.defect(line, None, problem, "the line is cut short or has a stray comma: mend it or record again");
        }
        let mut sound = true;
        for (column, value) in values.iter_mut().enumerate() {
            let text = std::str::from_utf8(&record[column]).unwrap_or("");
            match text.parse::<f64>() {
                Ok(number) if number.is_finite() => *value = number,
                _ => {
                    sound = false;
                    self.bad_number(line, column, text);
                }
            }
        }
        if sound {
            self.sample(line.unwrap_or(0), values);
        }
    }

    fn bad_number(&mut self, line: Option<u64>, column: usize, text: &str) {
        let n = self.joints;
        let joint = column.checked_sub(1).map(|index| index % n + 1);
        let name = column.checked_sub(1).map_or("t".into(), |index| column_names(n).nth(index).unwrap_or_default());
        let problem = format!("{name} is \"{text}\", not a finite number");
        self.defect(line, joint, problem, "no value may be missing: cut the run before it, or record again");
    }

    fn sample(&mut self, line: u64, values: &[f64]) {
        let n = self.joints;
        let Some(run) = &mut self.run else { return };
        if let Some(&previous) = run.times.last()
            && values[0] <= previous
        {
            let what = if values[0] == previous { "is the time of the sample before it too" } else { "is before the sample above it" };
            let problem = format!("t = {} s {what} (t = {previous} s)", values[0]);
            return self.defect(Some(line), None, problem, "times must increase strictly: sort the samples, drop duplicates");
        }
        self.lines.push(line);
        run.times.push(values[0]);
        run.states.extend_from_slice(&values[1..1 + 2 * n]);
        run.torques.extend_from_slice(&values[1 + 2 * n..]);
    }

    fn gaps(&mut self, limit: GapLimit) {
        let Some(run) = &self.run else { return };
        if !self.defects.is_empty() {
            return; // a sample that was not taken is no gap
        }
        let steps: Vec<f64> = run.times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let longest = match limit {
            GapLimit::Seconds(seconds) => seconds * (1.0 + 1e-9),
            GapLimit::Usual => usual_limit(&steps),
        };
        let gaps: Vec<(u64, f64, f64)> = steps
            .iter()
            .enumerate()
            .filter(|(_, step)| **step > longest)
            .map(|(k, &step)| (self.lines[k + 1], run.times[k], step))
            .collect();
        for (line, from, step) in gaps {
            let problem = format!("a gap of {step:.6} s after t = {from} s, the limit is {longest:.6} s");
            self.defect(
                Some(line),
                None,
                problem,
                "samples are missing and the input there is unknown: record again, cut the run, or accept it with --max-gap SECONDS",
            );
        }
    }
}

fn usual_limit(steps: &[f64]) -> f64 {
    let mut sorted = steps.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(&usual) = sorted.get(sorted.len() / 2) else { return f64::INFINITY };
    let same = steps.iter().filter(|&&step| (step - usual).abs() <= 1e-3 * usual).count();
    let fixed_rate = same as f64 >= FIXED_RATE_SHARE * steps.len() as f64;
    usual * if fixed_rate { FIXED_RATE_GAP } else { JITTER_GAP }
}

fn is_numbered(name: &str, prefix: &str) -> bool {
    name.strip_prefix(prefix).is_some_and(|rest| !rest.is_empty() && rest.bytes().all(|b| b.is_ascii_digit()))
}

/// q1..qn, qd1..qdn, tau1..taun.
pub(crate) fn column_names(n: usize) -> impl Iterator<Item = String> {
    ["q", "qd", "tau"].into_iter().flat_map(move |prefix| (1..=n).map(move |i| format!("{prefix}{i}")))
}

/// The column of state `i` (from 0) of a robot of `joints` joints: q1..qn, qd1..qdn.
pub(crate) fn state_name(i: usize, joints: usize) -> String {
    column_names(joints).nth(i).unwrap_or_default()
}
