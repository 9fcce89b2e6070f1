//! Checks of shapes and values before anything is drawn, so that a wrong input is named instead of
//! misdrawn.

use super::error::Error;
use super::page::{Bounds, SetsTable};
use super::suite_figure::{Band, Nominal, RunTrace, SuiteFigure, TightSpot};

pub(super) fn suite(figure: &SuiteFigure) -> Result<(), Error> {
    let place = Place { suite: &figure.suite, states: 2 * figure.joints.len() };
    place.at_least("joints", figure.joints.len(), 1)?;
    place.at_least("times", figure.times.len(), 2)?;
    place.times("times", &figure.times)?;
    place.band("band", &figure.band, figure.times.len())?;
    if let Some(inner) = &figure.inner {
        place.band("inner", inner, figure.times.len())?;
    }
    if let Nominal::Shared(nominal) = &figure.nominal {
        place.table("nominal", nominal, figure.times.len())?;
    }
    figure.runs.iter().try_for_each(|run| place.run(run))?;
    figure.tight.iter().try_for_each(|spot| place.spot(spot, figure.runs.len()))
}

pub(super) fn sets(table: &SetsTable) -> Result<(), Error> {
    for (index, row) in table.joints.iter().enumerate() {
        let noise = row.noise.iter().flatten();
        let bounds: Vec<&Bounds> =
            [&row.x0_q, &row.x0_qd, &row.u].into_iter().chain(noise).collect();
        if let Some(&value) = bounds.into_iter().flatten().find(|bound| !bound.is_finite()) {
            let (place, what) =
                (format!("sets \"{}\"", table.notion), format!("joint {}", row.joint));
            return Err(Error::NotFinite { place, what, index, value });
        }
    }
    Ok(())
}

/// The suite that is checked, for the messages.
struct Place<'a> {
    suite: &'a str,
    /// Number of states, 2n.
    states: usize,
}

impl Place<'_> {
    fn shape(&self, what: &str, got: usize, expected: usize) -> Result<(), Error> {
        if got == expected {
            return Ok(());
        }
        Err(Error::Shape { suite: self.suite.into(), what: what.into(), got, expected })
    }

    fn at_least(&self, what: &str, got: usize, least: usize) -> Result<(), Error> {
        self.shape(what, got.min(least), least)
    }

    fn finite(&self, what: &str, values: &[f64]) -> Result<(), Error> {
        match values.iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(index) => Err(Error::NotFinite {
                place: format!("suite {}", self.suite),
                what: what.into(),
                index,
                value: values[index],
            }),
        }
    }

    fn times(&self, what: &str, times: &[f64]) -> Result<(), Error> {
        self.finite(what, times)?;
        match times.windows(2).position(|pair| pair[0] >= pair[1]) {
            None => Ok(()),
            Some(before) => Err(Error::Order {
                suite: self.suite.into(),
                what: what.into(),
                index: before + 1,
                value: times[before + 1],
            }),
        }
    }

    fn table(&self, what: &str, table: &[Vec<f64>], samples: usize) -> Result<(), Error> {
        self.shape(what, table.len(), self.states)?;
        for (state, row) in table.iter().enumerate() {
            let what = format!("{what}[{state}]");
            self.shape(&what, row.len(), samples)?;
            self.finite(&what, row)?;
        }
        Ok(())
    }

    fn band(&self, what: &str, band: &Band, samples: usize) -> Result<(), Error> {
        self.table(&format!("{what}.lower"), &band.lower, samples)?;
        self.table(&format!("{what}.upper"), &band.upper, samples)
    }

    fn run(&self, run: &RunTrace) -> Result<(), Error> {
        self.at_least(&format!("times of run {}", run.name), run.times.len(), 1)?;
        self.times(&format!("times of run {}", run.name), &run.times)?;
        self.table(&format!("states of run {}", run.name), &run.states, run.times.len())?;
        self.finite(&format!("temperature of run {}", run.name), run.temperature.as_slice())
    }

    fn spot(&self, spot: &TightSpot, runs: usize) -> Result<(), Error> {
        self.at_least("runs (an index of tight)", runs, spot.run + 1)?;
        self.at_least("states (an index of tight)", self.states, spot.state + 1)?;
        self.finite("time_s and margin of tight", &[spot.time_s, spot.margin])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn the_sample_passes() {
        suite(&sample::suite("S", 3)).unwrap();
    }

    #[test]
    fn wrong_inputs_are_named() {
        let words = |break_it: fn(&mut SuiteFigure)| {
            let mut figure = sample::suite("S", 2);
            break_it(&mut figure);
            suite(&figure).unwrap_err().to_string()
        };
        assert!(words(|f| f.band.lower.truncate(3)).contains("band.lower has length 3, but 4"));
        assert!(
            words(|f| f.runs[1].states[2][5] = f64::NAN)
                .contains("states of run run 2[2][5] is NaN")
        );
        assert!(words(|f| f.times[1] = 0.0).contains("times[1] is 0 s, not later"));
        assert!(
            words(|f| f.tight[0].state = 9)
                .contains("states (an index of tight) has length 4, but 10")
        );
        assert!(words(|f| f.joints.clear()).contains("joints has length 0"));
    }

    #[test]
    fn an_unbounded_set_is_named() {
        let mut table = sample::sets(2);
        table.joints[1].u[1] = f64::INFINITY;
        assert!(sets(&table).unwrap_err().to_string().contains("is inf"));
    }
}
