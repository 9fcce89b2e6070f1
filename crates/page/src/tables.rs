//! The tables of the page: the uncertainty sets, the tight spots, the settings.

use super::page::{Bounds, JointSets, Page, SetsTable};
use super::skeleton::wide_table;
use super::suite_figure::{SuiteFigure, TightSpot};
use super::terms::{self, Explained};
use super::text::Text;
use maud::{Markup, PreEscaped, html};
use reachtube_conform::data::Side;
use reachtube_finding::Units;
use reachtube_robot::JointKind;
use reachtube_scalar::number::{column_decimals, outward, significant};

/// The set X0: as HTML, and as a term.
const X0: [&str; 2] = ["X<sub>0</sub>", "X0"];

/// A column of a table of sets.
struct Column {
    /// The set, as HTML.
    set: &'static str,
    /// What the set is.
    meaning: &'static str,
    /// The quantity.
    quantity: &'static str,
    unit: Units,
    /// One interval per joint.
    intervals: Vec<Bounds>,
}

pub(super) fn sets(table: &SetsTable) -> Markup {
    let columns = columns(table);
    let cells: Vec<Vec<Markup>> = columns.iter().map(interval_cells).collect();
    let head = html! {
        th scope="col" { "Joint" }
        @for column in &columns { (column_head(column)) }
    };
    let rows = html! {
        @for (row, joint) in table.joints.iter().enumerate() {
            tr {
                th scope="row" { (Text(&joint.joint)) }
                @for column in &cells { (column[row]) }
            }
        }
    };
    wide_table("sets", &table.notion, &head, &rows)
}

fn columns(table: &SetsTable) -> Vec<Column> {
    let kinds: Vec<_> = table.joints.iter().map(|joint| joint.kind).collect();
    let column =
        |[set, term]: [&'static str; 2], quantity, unit, pick: fn(&JointSets) -> Bounds| Column {
            set,
            meaning: terms::meaning(term),
            quantity,
            unit: JointKind::column(&kinds, unit),
            intervals: table.joints.iter().map(pick).collect(),
        };
    let mut columns = vec![
        column(X0, ": q", JointKind::position_unit, |joint| joint.x0_q),
        column(X0, ": q̇", JointKind::velocity_unit, |joint| joint.x0_qd),
        column(["U", "U"], "", JointKind::force_unit, |joint| joint.u),
    ];
    if table.joints.iter().any(|joint| joint.noise.is_some()) {
        let position = |joint: &JointSets| joint.noise.unwrap_or_default()[0];
        let velocity = |joint: &JointSets| joint.noise.unwrap_or_default()[1];
        columns.push(column(["V", "V"], ": q", JointKind::position_unit, position));
        columns.push(column(["V", "V"], ": q̇", JointKind::velocity_unit, velocity));
    }
    columns
}

fn column_head(column: &Column) -> Markup {
    html! {
        th scope="col" {
            abbr title=(column.meaning) { (PreEscaped(column.set)) } (column.quantity)
            @if let Some(shared) = column.unit.shared() { " " (unit(shared)) }
        }
    }
}

fn unit(unit: &str) -> Markup {
    html! { span.unit { "[" (unit) "]" } }
}

/// Returns the cells of a column: each interval in digits, and as a bar on the scale of the
/// column's largest bound.
fn interval_cells(column: &Column) -> Vec<Markup> {
    let intervals = &column.intervals;
    let decimals = column_decimals(intervals);
    let largest =
        intervals.iter().flatten().fold(f64::MIN_POSITIVE, |most, bound| most.max(bound.abs()));
    let cell = |(joint, bounds): (usize, &Bounds)| {
        let [lower, upper] = outward(*bounds, decimals);
        let text = column.unit.cell(joint, format!("[{lower}, {upper}]"));
        let [from, to] = bounds.map(|bound| 50.0 + 50.0 * bound / largest);
        let bar = format!("left:{from:.1}%;width:{:.1}%", to - from);
        html! {
            td { (text) span.bar { i style=(bar) {} } }
        }
    };
    intervals.iter().enumerate().map(cell).collect()
}

/// Returns the tight spots of all suites, in the order given.
pub(super) fn tight(page: &Page) -> Markup {
    html! {
        div.tall tabindex="0" role="region" aria-label="Tight spots" {
            table {
                thead {
                    tr {
                        th scope="col" { (Explained("Suite")) }
                        th scope="col" { "Run" }
                        th.number scope="col" { "Time " (unit("s")) }
                        th scope="col" { "State" }
                        th scope="col" { "Side" }
                        th.number scope="col" { (Explained("Margin")) }
                        th scope="col" { "Unit" }
                    }
                }
                tbody {
                    @for (index, suite) in page.suites.iter().enumerate() {
                        @for spot in &suite.tight { (spot_row(index, suite, spot)) }
                    }
                }
            }
        }
    }
}

fn spot_row(index: usize, suite: &SuiteFigure, spot: &TightSpot) -> Markup {
    let side = match spot.side {
        Side::Lower => "lower",
        Side::Upper => "upper",
    };
    let outside = spot.margin < 0.0;
    html! {
        tr class=[outside.then_some("outside")] data-suite-index=(index) data-run=(spot.run)
            data-time=(spot.time_s) data-state=(spot.state) {
            td { (Text(&suite.suite)) }
            td { (Text(&suite.runs[spot.run].name)) }
            td.number { (significant(spot.time_s, 6)) }
            td { (Text(&suite.state_label(spot.state))) }
            td { (side) }
            td.number { (significant(spot.margin, 3)) @if outside { " outside" } }
            td { (suite.state_unit(spot.state)) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn sets_print_their_intervals_and_units() {
        let html = sets(&sample::sets(3)).into_string();
        assert_eq!(html.matches("<td>[-2.7201, 3.6017]").count(), 3);
        assert_eq!(html.matches("scope=\"row\"").count(), 3);
        assert!(html.contains(">V</abbr>: q ") && html.contains("[N m]"));
    }

    #[test]
    fn sets_of_a_scara_print_the_unit_of_each_joint() {
        let mut table = sample::sets(3);
        table.joints[1].kind = JointKind::Prismatic;
        let html = sets(&table).into_string();
        for part in ["[-2.7201, 3.6017] N m<", "[-2.7201, 3.6017] N<", "] rad<", "] m<", "] m/s<"] {
            assert!(html.contains(part), "{part} is not in {html}");
        }
        assert!(!html.contains("[N m]") && !html.contains("[rad]"));
    }

    #[test]
    fn noise_has_no_columns_where_none_was_modelled() {
        let mut table = sample::sets(1);
        table.joints[0].noise = None;
        assert!(!sets(&table).into_string().contains(">V</abbr>: q"));
    }

    #[test]
    fn a_sample_outside_is_marked() {
        let mut page = sample::page();
        assert!(!tight(&page).into_string().contains("class=\"outside\""));
        page.suites[0].tight[0].margin = -0.01;
        let html = tight(&page).into_string();
        assert!(html.contains("class=\"outside\"") && html.contains("-0.01 outside"));
    }
}
