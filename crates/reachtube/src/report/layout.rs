//! Where things stand in a figure, in pixels: positions above velocities, a column a joint, up to
//! six columns abreast.

/// Drawing units a pixel: the drawing library places on integers, and a pixel is too coarse for a
/// thin band.
pub(super) const UNITS: f64 = 8.0;

const WIDTH: f64 = 1240.0;
const WIDEST_CELL: f64 = 600.0;
const MOST_COLUMNS: usize = 6;
const LEFT: f64 = 20.0;
const JOINT_NAME: f64 = 22.0;
const PLOT_HEIGHT: f64 = 172.0;
const BELOW_POSITION: f64 = 12.0;
const BELOW_VELOCITY: f64 = 36.0;

/// Room left of a plot for its tick labels \[px\].
pub(super) const BESIDE_PLOT: f64 = 44.0;
/// Room right of a plot \[px\].
pub(super) const AFTER_PLOT: f64 = 10.0;
/// Height of a line of the legend \[px\].
pub(super) const LEGEND_ROW: f64 = 22.0;

/// Pixels in drawing units.
pub(super) fn units(pixels: f64) -> i32 {
    (pixels * UNITS).round() as i32
}

/// A rectangle \[px\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rect {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

/// The grid of panels under `legend_rows` lines of legend.
pub(super) struct Layout {
    joints: usize,
    columns: usize,
    cell: f64,
    top: f64,
}

impl Layout {
    /// The layout for so many joints.
    pub(super) fn new(joints: usize) -> Self {
        let columns = joints.div_ceil(joints.div_ceil(MOST_COLUMNS));
        let cell = ((WIDTH - LEFT) / columns as f64).floor().min(WIDEST_CELL);
        Layout { joints, columns, cell, top: 0.0 }
    }

    /// The same below a legend of so many rows.
    pub(super) fn below(self, legend_rows: usize) -> Self {
        Layout { top: 8.0 + LEGEND_ROW * legend_rows as f64, ..self }
    }

    /// Width of the figure \[px\].
    pub(super) fn width(&self) -> f64 {
        LEFT + self.cell * self.columns as f64
    }

    /// Height of the figure \[px\].
    pub(super) fn height(&self) -> f64 {
        self.top + self.block() * self.joints.div_ceil(self.columns) as f64
    }

    /// Width and height of a plot without its labels \[px\].
    pub(super) fn plot(&self) -> (f64, f64) {
        (self.cell - BESIDE_PLOT - AFTER_PLOT, PLOT_HEIGHT)
    }

    /// The panel of a state: the plot and its tick labels.
    pub(super) fn panel(&self, state: usize) -> Rect {
        let joint = state % self.joints;
        let mut y = self.block_top(state) + JOINT_NAME;
        if self.is_velocity(state) {
            y += PLOT_HEIGHT + BELOW_POSITION;
        }
        let x = LEFT + self.cell * (joint % self.columns) as f64;
        Rect { x, y, width: self.cell, height: PLOT_HEIGHT + self.below_plot(state) }
    }

    /// Room below the plot of a state \[px\].
    pub(super) fn below_plot(&self, state: usize) -> f64 {
        if self.is_velocity(state) { BELOW_VELOCITY } else { BELOW_POSITION }
    }

    /// Whether the state is a velocity: the lower row, which carries the time axis.
    pub(super) fn is_velocity(&self, state: usize) -> bool {
        state >= self.joints
    }

    /// Whether the panel of this state starts a row.
    pub(super) fn starts_row(&self, state: usize) -> bool {
        (state % self.joints).is_multiple_of(self.columns)
    }

    /// Top of the row of joint names that the state belongs to \[px\].
    pub(super) fn block_top(&self, state: usize) -> f64 {
        self.top + self.block() * ((state % self.joints) / self.columns) as f64
    }

    fn block(&self) -> f64 {
        JOINT_NAME + 2.0 * PLOT_HEIGHT + BELOW_POSITION + BELOW_VELOCITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apart(a: Rect, b: Rect) -> bool {
        a.x + a.width <= b.x
            || b.x + b.width <= a.x
            || a.y + a.height <= b.y
            || b.y + b.height <= a.y
    }

    #[test]
    fn panels_of_one_to_ten_joints_fit_without_overlap() {
        for joints in 1..=10 {
            let layout = Layout::new(joints).below(2);
            let panels: Vec<Rect> = (0..2 * joints).map(|state| layout.panel(state)).collect();
            for (k, a) in panels.iter().enumerate() {
                assert!(
                    a.x + a.width <= layout.width() && a.y + a.height <= layout.height(),
                    "{joints} {a:?}"
                );
                assert!(panels[..k].iter().all(|b| apart(*a, *b)), "{joints} joints, panel {k}");
            }
        }
    }

    #[test]
    fn rows_are_balanced_and_at_most_six_wide() {
        let columns = |joints| Layout::new(joints).columns;
        assert_eq!([1, 6, 7, 8, 10, 13].map(columns), [1, 6, 4, 4, 5, 5]);
    }
}
