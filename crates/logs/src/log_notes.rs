//! Notes about the reading of a log.

use std::path::Path;

use reachtube_recordings::LogTime;

use crate::sample::{Labels, Sample};
use crate::seconds::decimal;
use crate::series::TopicStates;

pub(crate) fn time_note(path: &Path, series: &TopicStates, time: LogTime) -> String {
    let path = path.display();
    match time {
        LogTime::Receipt => {
            format!("{path}: times are the times at which the log received the messages")
        }
        LogTime::Header => {
            let delay = |sample: &Sample| sample.received.saturating_sub(sample.time);
            let delays = series.samples.iter().map(delay);
            let (least, most) = (delays.clone().min(), delays.max());
            format!(
                "{path}: times are the stamps in the headers; the log received the messages {} s \
                 to {} s later",
                decimal(least.unwrap_or(0)),
                decimal(most.unwrap_or(0))
            )
        }
    }
}

pub(crate) fn order_note(path: &Path, topic: &str, late: usize) -> String {
    format!(
        "{}: {late} messages of {topic} stand after later ones in the file; all were sorted by the \
         times at which the log received them",
        path.display()
    )
}

/// Notes by how much the stamps of a topic differ from the stamps of the first one, ns.
pub(crate) fn shift_note(labels: &Labels<'_>, topic: usize, largest: i64) -> String {
    format!(
        "{}: the values of {} were interpolated at the stamps of {}, from which its own differ by \
         up to {:.3} ms",
        labels.log.display(),
        labels.topics[topic],
        labels.topics[0],
        largest as f64 / 1e6
    )
}

/// Notes where the joints were found.
pub(crate) fn series_notes(
    path: &Path,
    topic: &str,
    series: &TopicStates,
    joints: &[String],
) -> Vec<String> {
    let path = path.display();
    let place = |(joint, place): (usize, &Option<usize>)| {
        let name = &joints[joint];
        place.map(|place| format!("q{} = {name} (place {place})", joint + 1))
    };
    let places: Vec<String> = series.first_places.iter().enumerate().filter_map(place).collect();
    let mut mapping =
        format!("{path}: joints of {topic} are matched by name: {}", places.join(", "));
    if series.changes > 0 {
        mapping += &format!("; the order of the names changes {} times", series.changes);
    }
    if !series.unused.is_empty() {
        let unused: Vec<&str> = series.unused.iter().map(String::as_str).collect();
        mapping += &format!("; not used: {}", unused.join(", "));
    }
    let foreign = (series.foreign > 0).then(|| {
        format!(
            "{path}: {} of {} messages of {topic} name no joint of the robot and are not used",
            series.foreign, series.messages
        )
    });
    std::iter::once(mapping).chain(foreign).collect()
}
