//! Numbers that faults change: sudden torques, drags of parts and a payload.

use crate::data::residual::Torques;

/// Time over which a sudden torque is compared with the torque before it, s.
const BEFORE: f64 = 0.1;

/// Time over which drags and the payload are estimated, s.
const MEMORY: f64 = 10.0;

/// Part of that time in motion that an estimate needs, and the weight of no change in it.
const LEAST: f64 = 0.05;
const PRIOR: f64 = 0.1;

/// What statistics take from healthy motion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Shape {
    /// The speed above which a part counts as moving, n; infinite for a part that hardly moves.
    pub gate: Vec<f64>,
    /// The ripple of the torque over the motor torque, by the sine and the cosine of the motor's
    /// angle, n.
    pub ripple: Vec<[f64; 2]>,
    /// The mean square of the torque of 1 kg at the tip on moving parts, (N m)².
    pub load: f64,
}

/// A least and a largest value.
pub(crate) type Range = [f64; 2];

/// The torque and the two parts of the ripple.
pub(crate) type Parts = [f64; 3];

/// Sudden torques of the parts, then their drags, then the payload.
#[derive(Debug)]
pub(crate) struct Statistics {
    pub shape: Shape,
    step: f64,
    /// For how many samples each part has moved, n.
    moved: Vec<usize>,
    /// Means over the time before, n.
    means: Vec<Parts>,
    /// What is above the means, n; `None` if a part has not moved for long enough.
    pub above: Vec<Option<Parts>>,
    /// Sums for each part, by which its drag is estimated: of 1, of the torque along the motion,
    /// and of the weight along the motion, n.
    sums: Vec<Parts>,
    /// The sums of the squared weight, and of the weight times the torque.
    payload: [f64; 2],
    /// N m and kg; `None` if there is too little motion. 2n + 1.
    pub values: Vec<Option<f64>>,
}

impl Statistics {
    pub(crate) fn new(shape: Shape, step: f64) -> Self {
        let n = shape.gate.len();
        Self {
            shape,
            step,
            moved: vec![0; n],
            means: vec![[0.0; 3]; n],
            above: vec![None; n],
            sums: vec![[0.0; 3]; n],
            payload: [0.0; 2],
            values: vec![None; 2 * n + 1],
        }
    }

    pub(crate) fn clear(&mut self) {
        self.moved.fill(0);
        self.sums.fill([0.0; 3]);
        self.payload = [0.0; 2];
        self.above.fill(None);
        self.values.fill(None);
    }

    pub(crate) fn is_moving(&self, part: usize) -> bool {
        self.moved[part] > 0
    }

    pub(crate) fn take(&mut self, residual: &Torques) {
        let n = self.moved.len();
        let part = self.step / MEMORY;
        self.payload.iter_mut().for_each(|sum| *sum *= 1.0 - part);
        for j in 0..n {
            let parts = [residual.torque[j], residual.ripple[0][j], residual.ripple[1][j]];
            let speed = residual.speed[j];
            self.moved[j] = if speed.abs() > self.shape.gate[j] { self.moved[j] + 1 } else { 0 };
            self.compare(j, parts);
            self.sums[j].iter_mut().for_each(|sum| *sum *= 1.0 - part);
            if self.moved[j] > 0 {
                let (torque, weight) = (self.steady(j, parts), residual.weight[j]);
                let more = [1.0, torque, weight].map(|x| part * x);
                let [_, along, weight_along] = more.map(|x| x * speed.signum());
                let all = [more[0], along, weight_along];
                self.sums[j].iter_mut().zip(all).for_each(|(sum, more)| *sum += more);
                self.payload[0] += part * weight * weight;
                self.payload[1] += part * weight * torque;
            }
        }
        self.estimate();
    }

    fn steady(&self, part: usize, [torque, sine, cosine]: Parts) -> f64 {
        let [a, b] = self.shape.ripple[part];
        torque - a * sine - b * cosine
    }

    fn compare(&mut self, j: usize, parts: Parts) {
        let moved = self.moved[j];
        let before = (BEFORE / self.step).round().max(1.0);
        self.above[j] = None;
        if moved as f64 > before {
            let mut above = parts;
            above.iter_mut().zip(self.means[j]).for_each(|(part, mean)| *part -= mean);
            self.above[j] = Some(above);
        }
        if moved > 0 {
            let weight = 1.0 / before.min(moved as f64);
            let means = self.means[j].iter_mut().zip(parts);
            means.for_each(|(mean, part)| *mean += weight * (part - *mean));
        }
        // What takes torque from the input acts against it.
        self.values[j] = self.above[j].map(|above| -self.steady(j, above));
    }

    fn estimate(&mut self) {
        let n = self.moved.len();
        let prior = PRIOR * self.shape.load;
        let [mut square, mut product] = [self.payload[0] + prior, self.payload[1]];
        for [time, along, weight] in &self.sums {
            square -= weight * weight / (time + PRIOR);
            product -= weight * along / (time + PRIOR);
        }
        let payload = product / square;
        for (j, [time, along, weight]) in self.sums.iter().enumerate() {
            let drag = (along - payload * weight) / (time + PRIOR);
            self.values[n + j] = Some(drag).filter(|_| *time > LEAST);
        }
        let known = self.payload[0] > LEAST * self.shape.load && square > 0.0;
        self.values[2 * n] = Some(payload).filter(|_| known);
    }
}
