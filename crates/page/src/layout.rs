//! The grid of a figure in pixels: positions above velocities, one column per joint, at most six
//! columns in a row.

/// Width of a full figure \[px\].
const WIDTH: f64 = 1240.0;
/// Largest width of a column \[px\].
const WIDEST_CELL: f64 = 600.0;
/// Columns that a row holds at most.
const MOST_COLUMNS: usize = 6;
/// Room left of the first column \[px\].
const LEFT: f64 = 20.0;
/// Room above the first row \[px\].
const ABOVE: f64 = 8.0;
/// Height of the row of joint names \[px\].
const JOINT_NAME: f64 = 22.0;
/// Height of a plot \[px\].
const PLOT_HEIGHT: f64 = 172.0;
/// Room below a plot of positions \[px\].
const BELOW_POSITION: f64 = 12.0;
/// Room below a plot of velocities, for the time axis \[px\].
const BELOW_VELOCITY: f64 = 36.0;

/// Room left of a plot for its tick labels \[px\].
const BESIDE_PLOT: f64 = 44.0;
/// Room right of a plot \[px\].
const AFTER_PLOT: f64 = 10.0;
/// Height of a row of the legend \[px\].
pub(super) const LEGEND_ROW: f64 = 22.0;

/// A rectangle \[px\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rect {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

/// The grid of panels below the legend.
pub(super) struct Layout {
    joints: usize,
    columns: usize,
    cell: f64,
    top: f64,
}

impl Layout {
    /// Returns the layout for a number of joints, without a legend.
    pub(super) fn new(joints: usize) -> Self {
        let columns = joints.div_ceil(joints.div_ceil(MOST_COLUMNS));
        let cell = ((WIDTH - LEFT) / columns as f64).floor().min(WIDEST_CELL);
        Layout { joints, columns, cell, top: 0.0 }
    }

    /// Returns the layout moved below a legend with `legend_rows` rows.
    pub(super) fn below(self, legend_rows: usize) -> Self {
        Layout { top: ABOVE + LEGEND_ROW * legend_rows as f64, ..self }
    }

    pub(super) fn width(&self) -> f64 {
        LEFT + self.cell * self.columns as f64
    }

    pub(super) fn height(&self) -> f64 {
        self.top + self.block() * self.joints.div_ceil(self.columns) as f64
    }

    /// Returns the plot of a state, without its labels: a velocity has its place below the position
    /// of its joint, with the time axis.
    pub(super) fn plot(&self, state: usize) -> Rect {
        let joint = state % self.joints;
        let second = if state < self.joints { 0.0 } else { PLOT_HEIGHT + BELOW_POSITION };
        Rect {
            x: LEFT + self.cell * (joint % self.columns) as f64 + BESIDE_PLOT,
            y: self.top + self.block() * (joint / self.columns) as f64 + JOINT_NAME + second,
            width: self.cell - BESIDE_PLOT - AFTER_PLOT,
            height: PLOT_HEIGHT,
        }
    }

    pub(super) fn starts_row(&self, state: usize) -> bool {
        (state % self.joints).is_multiple_of(self.columns)
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
            let panel = |state: usize| {
                let Rect { x, y, width, height } = layout.plot(state);
                let below = if state < joints { BELOW_POSITION } else { BELOW_VELOCITY };
                let (x, width) = (x - BESIDE_PLOT, width + BESIDE_PLOT + AFTER_PLOT);
                Rect { x, y, width, height: height + below }
            };
            let panels: Vec<Rect> = (0..2 * joints).map(panel).collect();
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
