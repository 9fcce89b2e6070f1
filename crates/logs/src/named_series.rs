//! Positions of joints by name: what the messages of one topic say of the same joints.

use crate::align::{Place, places};
use crate::container::RawMessage;
use crate::message::Positions;

/// Number of sets of joints in one topic after which further ones are not read.
const MOST_SETS: usize = 16;

/// The positions of the same joints in one topic.
#[derive(Debug, Clone, Default)]
pub(crate) struct NamedSeries {
    /// Number of the topic among the topics that were met.
    pub(crate) topic: usize,
    /// The joints, in the order of the values.
    pub(crate) names: Vec<String>,
    /// Whether each sample has the commanded positions, and the actual ones after them.
    pub(crate) has_commands: bool,
    /// Times of the samples, and when the log received them, ns.
    pub(crate) times: Vec<[i64; 2]>,
    /// Positions, row-major.
    pub(crate) values: Vec<f64>,
}

/// The positions of all topics, and what was not used of them.
#[derive(Debug, Default)]
pub(crate) struct AllSeries {
    pub(crate) series: Vec<NamedSeries>,
    /// The topic of each message that does not have a position for each of its joints, or names one
    /// twice.
    pub(crate) incomplete: Vec<usize>,
}

impl AllSeries {
    /// Adds a message of a topic.
    ///
    /// # Errors
    ///
    /// A clause about a message that cannot be decoded.
    pub(crate) fn add(
        &mut self,
        message: RawMessage<'_>,
        (topic, is_of_controller): (usize, bool),
        receipt: bool,
    ) -> Result<(), String> {
        let Positions { stamp, names, values } = Positions::decode(message.data, is_of_controller)?;
        let is_repeated = |(at, name): (usize, &&str)| names[..at].contains(name);
        if names.is_empty()
            || values.iter().any(|of| of.len() != names.len())
            || names.iter().enumerate().any(is_repeated)
        {
            self.incomplete.push(topic);
            return Ok(());
        }
        let time = [if receipt { message.log_time } else { stamp }, message.log_time];
        let of_topic = |of: &NamedSeries| of.topic == topic;
        let known = self.series.iter().position(|of| of_topic(of) && of.has(&names));
        let index = known.unwrap_or(self.series.len());
        if known.is_none() {
            if self.series.iter().filter(|of| of_topic(of)).count() >= MOST_SETS {
                self.incomplete.push(topic);
                return Ok(());
            }
            let names = names.iter().map(|name| (*name).to_string()).collect();
            let has_commands = is_of_controller;
            self.series.push(NamedSeries { topic, names, has_commands, ..NamedSeries::default() });
        }
        let at = &mut self.series[index];
        at.times.push(time);
        for of_kind in values {
            // Messages may have the joints in another order.
            let place = |name: &String| names.iter().position(|other| other == name);
            let value = |name| of_kind.get(place(name)?);
            at.values.extend(at.names.iter().map(|name| value(name).unwrap_or(f64::NAN)));
        }
        Ok(())
    }
}

impl NamedSeries {
    /// Returns whether these are the joints of the series, in any order.
    fn has(&self, names: &[&str]) -> bool {
        self.names.iter().eq(names)
            || (self.names.len() == names.len()
                && self.names.iter().all(|name| names.contains(&name.as_str())))
    }

    pub(crate) fn width(&self) -> usize {
        if self.has_commands { 2 * self.names.len() } else { self.names.len() }
    }

    pub(crate) fn increases(&self) -> bool {
        self.times.windows(2).all(|pair| pair[0][0] < pair[1][0])
    }

    /// Brings samples into the order of their times, or else of receipt, and omits repetitions
    /// of a sample. Returns how many came late or were repeated.
    pub(crate) fn sort(&mut self) -> usize {
        if self.increases() {
            return 0;
        }
        let late = self.times.windows(2).filter(|pair| pair[1][0] <= pair[0][0]).count();
        let width = self.width();
        let mut order: Vec<usize> = (0..self.times.len()).collect();
        order.sort_by_key(|index| self.times[*index][1]);
        let row = |index: &usize| &self.values[index * width..][..width];
        order.dedup_by(|b, a| self.times[*a][0] == self.times[*b][0] && row(a) == row(b));
        let values = order.iter().flat_map(row).copied().collect();
        self.times = order.iter().map(|index| self.times[*index]).collect();
        self.values = values;
        late
    }

    /// Returns the times of the samples, ns.
    pub(crate) fn stamps(&self) -> Vec<i64> {
        self.times.iter().map(|time| time[0]).collect()
    }

    /// Returns the columns of some joints: of their commanded and then of their actual positions,
    /// if the series has both.
    pub(crate) fn columns(&self, names: &[String]) -> Vec<usize> {
        let of = |name: &String| self.names.iter().position(|other| other == name);
        let columns: Vec<usize> = names.iter().filter_map(of).collect();
        let kinds = [0, self.names.len()].into_iter().take(1 + usize::from(self.has_commands));
        kinds.flat_map(|first| columns.iter().map(move |column| first + column)).collect()
    }

    /// Returns where stamps lie among the samples.
    pub(crate) fn places(&self, stamps: &[i64]) -> Vec<Place> {
        let own = self.stamps();
        // Own stamps may have defects, which are the reader's to name.
        match own == stamps {
            true => (0..own.len()).map(Place::At).collect(),
            false => places(&own, stamps).unwrap_or_else(|| vec![Place::None; stamps.len()]),
        }
    }

    /// Returns the value of a column at a place; NaN at none.
    pub(crate) fn value(&self, place: Place, column: usize) -> f64 {
        let at = |index: usize| self.values[index * self.width() + column];
        match place {
            Place::None => f64::NAN,
            Place::At(index) => at(index),
            Place::After { index, part, .. } => at(index) + part * (at(index + 1) - at(index)),
        }
    }
}
