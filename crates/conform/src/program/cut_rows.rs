//! The rows of cuts in the program.

use crate::data::settings::Noise;
use crate::program::cut::Cut;
use crate::program::dot::dot;
use crate::program::layout::Layout;
use crate::program::program::Program;
use crate::program::solver::Triplets;
use crate::sets::UncertaintySets;

impl Program<'_> {
    pub(super) fn add_cuts(
        &self,
        layout: &Layout,
        unit: &[f64],
        triplets: &mut Triplets,
        bounds: &mut Vec<f64>,
    ) {
        for cut in &self.cuts {
            let entries = layout.cut_entries(cut);
            let scale = entries.iter().map(|(j, a)| (a * unit[*j]).abs()).fold(0.0, f64::max);
            triplets.row(entries.into_iter().map(|(j, a)| (j, -a * unit[j] / scale)));
            bounds.push((self.known_noise(cut) - cut.bound) / (scale * self.scale));
        }
    }

    /// Returns how far the point of a cut is from the centre of the sets' reach, and how far they
    /// reach, along its direction.
    pub(crate) fn reach(&self, cut: &Cut, sets: &UncertaintySets) -> (f64, f64) {
        let unknowns = self.unknowns(sets);
        let noise: f64 = (0..cut.noise.len()).map(|i| cut.noise[i] * sets.noise_radius(i)).sum();
        let reach = dot(&cut.radius, &unknowns.radius) + noise;
        (cut.bound - dot(&cut.centre, &unknowns.centre), reach)
    }

    fn known_noise(&self, cut: &Cut) -> f64 {
        match &self.settings.noise {
            Noise::Fixed(radii) => dot(radii, &cut.noise),
            Noise::None | Noise::Fitted => 0.0,
        }
    }
}
