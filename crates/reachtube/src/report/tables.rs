//! The tables of the page: the uncertainty sets, the tight spots, the settings.

use super::number::{decimals, outward, short};
use super::text::escape;
use super::{Bounds, Page, SetsTable, Side, SuiteFigure, TightSpot};

/// A column of a table of sets: its heading, its unit, its intervals.
type Column = (&'static str, &'static str, Vec<Bounds>);

/// The uncertainty sets per joint, as Table II.
pub(super) fn sets(table: &SetsTable) -> String {
    let columns = columns(table);
    let heads: String = columns.iter().map(|(name, unit, _)| head(name, unit)).collect();
    let cells: Vec<Vec<String>> = columns.iter().map(|(_, _, column)| intervals(column)).collect();
    let row = |(row, sets): (usize, &super::JointSets)| {
        let cells: String = cells.iter().map(|column| column[row].as_str()).collect();
        format!("<tr><th scope=\"row\">{}</th>{cells}</tr>\n", escape(&sets.joint))
    };
    let rows: String = table.joints.iter().enumerate().map(row).collect();
    format!(
        "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\"><table class=\"sets\">\n\
         <caption>{0}</caption>\n<thead><tr><th scope=\"col\">Joint</th>{heads}</tr></thead>\n\
         <tbody>\n{rows}</tbody></table></div>\n",
        escape(&table.notion)
    )
}

fn columns(table: &SetsTable) -> Vec<Column> {
    let column = |pick: fn(&super::JointSets) -> Bounds| table.joints.iter().map(pick).collect();
    let mut columns: Vec<Column> = vec![
        ("X<sub>0</sub>: q", "rad", column(|joint| joint.x0_q)),
        ("X<sub>0</sub>: q̇", "rad/s", column(|joint| joint.x0_qd)),
        ("U", "N m", column(|joint| joint.u)),
    ];
    if table.joints.iter().any(|joint| joint.noise.is_some()) {
        columns.push(("V: q", "rad", column(|joint| joint.noise.unwrap_or_default()[0])));
        columns.push(("V: q̇", "rad/s", column(|joint| joint.noise.unwrap_or_default()[1])));
    }
    columns
}

fn head(name: &str, unit: &str) -> String {
    format!("<th scope=\"col\">{name} <span class=\"unit\">[{unit}]</span></th>")
}

/// The cells of a column: each interval in digits, and as a bar on the scale of the column's
/// largest bound.
fn intervals(column: &[Bounds]) -> Vec<String> {
    let decimals = decimals(column);
    let largest =
        column.iter().flatten().fold(f64::MIN_POSITIVE, |most, bound| most.max(bound.abs()));
    let cell = |bounds: &Bounds| {
        let [lower, upper] = outward(*bounds, decimals);
        let [from, to] = bounds.map(|bound| 50.0 + 50.0 * bound / largest);
        format!(
            "<td>[{lower}, {upper}]<span class=\"bar\"><i style=\"left:{from:.1}%;width:{:.1}%\"></i></span></td>",
            to - from
        )
    };
    column.iter().map(cell).collect()
}

/// The tight spots of all suites, in the order given.
pub(super) fn tight(page: &Page) -> String {
    let rows: String = page
        .suites
        .iter()
        .flat_map(|suite| suite.tight.iter().map(move |spot| spot_row(suite, spot)))
        .collect();
    if rows.is_empty() {
        return "<p>None was listed.</p>\n".into();
    }
    format!(
        "<div class=\"tall\" tabindex=\"0\" role=\"region\" aria-label=\"Tight spots\"><table>\n\
         <thead><tr><th scope=\"col\">Suite</th><th scope=\"col\">Run</th>\
         <th scope=\"col\" class=\"number\">Time <span class=\"unit\">[s]</span></th><th scope=\"col\">State</th>\
         <th scope=\"col\">Side</th><th scope=\"col\" class=\"number\">Margin</th><th scope=\"col\">Unit</th></tr></thead>\n\
         <tbody>\n{rows}</tbody></table></div>\n"
    )
}

fn spot_row(suite: &SuiteFigure, spot: &TightSpot) -> String {
    let (side, unit) = match spot.side {
        Side::Lower => ("lower", suite.state_unit(spot.state)),
        Side::Upper => ("upper", suite.state_unit(spot.state)),
        Side::Plane => ("facet in (q, q̇)", "scaled"),
    };
    let outside = spot.margin < 0.0;
    let (class, word) = if outside { (" class=\"outside\"", " outside") } else { ("", "") };
    format!(
        "<tr{class}><td>{}</td><td>{}</td><td class=\"number\">{}</td><td>{}</td><td>{side}</td>\
         <td class=\"number\">{}{word}</td><td>{unit}</td></tr>\n",
        escape(&suite.suite),
        escape(&suite.runs[spot.run].name),
        short(spot.time_s, 6),
        escape(&suite.spot_label(spot)),
        short(spot.margin, 3),
    )
}

/// Names and values.
pub(super) fn facts(facts: &[(String, String)]) -> String {
    let row = |(name, value): &(String, String)| {
        format!("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape(name), escape(value))
    };
    format!(
        "<table class=\"facts\"><tbody>\n{}</tbody></table>\n",
        facts.iter().map(row).collect::<String>()
    )
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    #[test]
    fn sets_print_their_intervals_and_units() {
        let html = sets(&sample::sets(3));
        assert_eq!(html.matches("<td>[-2.7201, 3.6017]").count(), 3);
        assert_eq!(html.matches("scope=\"row\"").count(), 3);
        assert!(html.contains("V: q ") && html.contains("[N m]"));
    }

    #[test]
    fn noise_has_no_columns_where_none_was_modelled() {
        let mut table = sample::sets(1);
        table.joints[0].noise = None;
        assert!(!sets(&table).contains("V: q"));
    }

    #[test]
    fn a_sample_outside_is_called_so() {
        let mut page = sample::page();
        assert!(!tight(&page).contains("outside"));
        page.suites[0].tight[0].margin = -0.01;
        assert!(
            tight(&page).contains("class=\"outside\"") && tight(&page).contains("-0.01 outside")
        );
    }
}
