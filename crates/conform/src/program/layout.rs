use reachtube_reach::Hyperrectangle;

use crate::data::settings::{Centre, Noise, Settings};
use crate::data::shape::Shape;
use crate::data::side::Side;
use crate::program::cut::Cut;
use crate::program::solver::Triplets;
use crate::sets::UncertaintySets;

/// The largest that V and X0 may be, 2n each, rad and rad/s, where that is limited.
#[derive(Debug, Clone, Default)]
pub(crate) struct Limits {
    /// The largest radii of V.
    pub noise: Option<Vec<f64>>,
    /// The largest |x| of X0; infinite for a state that is not limited.
    pub start: Option<Vec<f64>>,
}

impl Limits {
    /// Returns the limit of radius `j` of (X0, U); infinite if there is none.
    pub(crate) fn of_start(&self, j: usize) -> f64 {
        self.start.as_ref().and_then(|start| start.get(j)).copied().unwrap_or(f64::INFINITY)
    }

    /// Makes the radii of X0 so small that X0 keeps its limit.
    pub(crate) fn shrink(&self, initial_set: &mut Hyperrectangle) {
        let Hyperrectangle { centre, radius } = initial_set;
        for ((radius, centre), limit) in
            radius.iter_mut().zip(centre).zip(self.start.iter().flatten())
        {
            *radius = radius.min((limit - centre.abs()).max(0.0));
        }
    }
}

/// Which column of the solver's matrix each unknown is: the centres (c_x, c_u) where they are
/// unknown, the radii (r_x, r_u), and the radii of the noise where they are unknown.
pub(crate) struct Layout {
    shape: Shape,
    has_centres: bool,
    /// Cost of each column; a centre has the cost of its radius, for scaling only.
    pub cost: Vec<f64>,
}

impl Layout {
    /// Lays out the unknowns for radii of X0 and U of the cost `cost`, and noise radii of
    /// `noise_cost`.
    pub(crate) fn new(settings: &Settings, shape: Shape, cost: &[f64], noise_cost: &[f64]) -> Self {
        let has_centres = settings.centre != Centre::Zero;
        let mut columns = if has_centres { cost.to_vec() } else { Vec::new() };
        columns.extend(cost);
        if settings.noise == Noise::Fitted {
            columns.extend(noise_cost);
        }
        // A radius without a cost is in no row (with one sample nothing depends on the input): any
        // cost makes it 0.
        let largest = columns.iter().copied().fold(0.0, f64::max);
        columns.iter_mut().filter(|w| **w == 0.0).for_each(|w| *w = largest);
        Self { shape, has_centres, cost: columns }
    }

    /// Returns the number of centres, which is the column of the first radius.
    pub(crate) fn centres(&self) -> usize {
        if self.has_centres { self.shape.radii() } else { 0 }
    }

    pub(crate) fn entries(
        &self,
        centre: &[f64],
        radius: impl Iterator<Item = f64>,
        state: usize,
        side: Side,
    ) -> Vec<(usize, f64)> {
        let signed = centre.iter().map(|a| side.sign() * a).take(self.centres());
        let mut row: Vec<(usize, f64)> = signed.chain(radius).enumerate().collect();
        let noise = self.centres() + self.shape.radii();
        if self.cost.len() > noise {
            row.push((noise + state, 1.0));
        }
        row
    }

    /// Returns the columns and entries of a row in any direction.
    pub(crate) fn cut_entries(&self, cut: &Cut) -> Vec<(usize, f64)> {
        let centre = cut.centre.iter().take(self.centres());
        let has_noise = self.cost.len() > self.centres() + self.shape.radii();
        let noise = cut.noise.iter().filter(|_| has_noise);
        centre.chain(&cut.radius).chain(noise).copied().enumerate().collect()
    }

    /// Returns the size of the unknown of column `j` in some sets: a radius, or the larger one of a
    /// centre's distance from 0 and its radius.
    pub(crate) fn value(&self, sets: &UncertaintySets, j: usize) -> f64 {
        let (Shape { states, .. }, centres) = (self.shape, self.centres());
        let width = self.shape.radii();
        let of = |set: &Hyperrectangle, i: usize| {
            let centre = if j < centres { set.centre[i].abs() } else { 0.0 };
            centre.max(set.radius[i])
        };
        match if j < centres { j } else { j - centres } {
            i if i < states => of(&sets.initial_set, i),
            i if i < width => of(&sets.input_set, i - states),
            i => sets.noise_radius(i - width),
        }
    }

    pub(crate) fn unknowns(&self, sets: &UncertaintySets) -> Vec<f64> {
        let (start, input) = (&sets.initial_set, &sets.input_set);
        let centres = start.centre.iter().chain(&input.centre).take(self.centres());
        let radii = start.radius.iter().chain(&input.radius);
        let noise = sets.noise_set.iter().flat_map(|set| &set.radius);
        centres.chain(radii).chain(noise).take(self.cost.len()).copied().collect()
    }

    /// Returns the largest that the unknown of column `j` may be; infinite if it has no limit.
    pub(crate) fn limit_of(&self, limits: &Limits, j: usize) -> f64 {
        let (width, centres) = (self.shape.radii(), self.centres());
        match if j < centres { j } else { j - centres } {
            i if i < width => limits.of_start(i),
            i => limits.noise.as_ref().map_or(f64::INFINITY, |noise| noise[i - width]),
        }
    }

    /// Adds r >= 0, and |c| <= r where the origin must lie in the sets; `unit` is the unit of each
    /// unknown.
    pub(crate) fn restrict(
        &self,
        kind: Centre,
        triplets: &mut Triplets,
        bounds: &mut Vec<f64>,
        unit: &[f64],
    ) {
        for column in self.centres()..self.cost.len() {
            triplets.row([(column, -1.0)]);
            bounds.push(0.0);
        }
        if kind == Centre::Origin {
            for centre in 0..self.centres() {
                let radius = centre + self.centres();
                for sign in [1.0, -1.0] {
                    triplets.row([(centre, sign * unit[centre] / unit[radius]), (radius, -1.0)]);
                    bounds.push(0.0);
                }
            }
        }
    }

    /// Adds what limits V and X0; `unit` is the unit of each unknown.
    pub(crate) fn limit(
        &self,
        limits: &Limits,
        triplets: &mut Triplets,
        bounds: &mut Vec<f64>,
        unit: &[f64],
    ) {
        let noise = self.centres() + self.shape.radii();
        for (column, limit) in (noise..self.cost.len()).zip(limits.noise.iter().flatten()) {
            triplets.row([(column, 1.0)]);
            bounds.push(limit / unit[column]);
        }
        let starts = limits.start.iter().flatten().enumerate();
        for (i, limit) in starts.filter(|(_, limit)| limit.is_finite()) {
            let radius = i + self.centres();
            let signs: &[f64] = if self.has_centres { &[1.0, -1.0] } else { &[1.0] };
            for sign in signs {
                let centre = self.has_centres.then(|| (i, sign * unit[i] / unit[radius]));
                triplets.row(centre.into_iter().chain([(radius, 1.0)]));
                bounds.push(limit / unit[radius]);
            }
        }
    }

    pub(crate) fn sets(&self, unknowns: &[f64], settings: &Settings) -> UncertaintySets {
        let (Shape { states, outputs, .. }, centres) = (self.shape, self.centres());
        let width = self.shape.radii();
        let set = |from: usize, to: usize| {
            let radius: Vec<f64> =
                unknowns[centres + from..centres + to].iter().map(|r| r.max(0.0)).collect();
            let mut centre =
                if self.has_centres { unknowns[from..to].to_vec() } else { vec![0.0; to - from] };
            if settings.centre == Centre::Origin {
                centre.iter_mut().zip(&radius).for_each(|(c, r)| *c = c.clamp(-r, *r));
            }
            Hyperrectangle { centre, radius }
        };
        let noise = |radius: Vec<f64>| Some(Hyperrectangle { centre: vec![0.0; outputs], radius });
        let noise_set = match &settings.noise {
            Noise::None => None,
            Noise::Fixed(given) => noise(given.clone()),
            Noise::Fitted => {
                noise(unknowns[centres + width..].iter().map(|r| r.max(0.0)).collect())
            }
        };
        UncertaintySets { initial_set: set(0, states), input_set: set(states, width), noise_set }
    }
}
