//! Tests of the page in a headless browser: what a reader does with the mouse and the keys.
//!
//! The tests need Chromium or Chrome on the PATH; they are ignored unless requested.

use super::html::write_html;
use super::library::{Assets, LIBRARY_FILE, write_library};
use super::sample;
use super::suite_figure::{Nominal, RunTrace};
use reachtube_testing::Tab;
use serde_json::{Value, json};
use std::fs;

fn page(assets: Assets) -> Vec<u8> {
    let mut html = Vec::new();
    write_html(&sample::page(), assets, &mut html).unwrap();
    html
}

/// Opens the page of the sample in a window of a size.
fn opened(width: u32, dark: bool) -> Tab {
    let mut tab = Tab::new(width, 900, dark);
    tab.open(&page(Assets::Inside)).unwrap();
    // The mouse needs the figure in the window.
    tab.script("plot.scrollIntoView({ block: 'center' })");
    tab
}

/// Returns the place in the window of a point of a panel, from its data.
const PLACE: &str = "((panel, x, y) => {
    const { _xaxis: a, _yaxis: b } = { _xaxis: plot._fullLayout['xaxis' + panel],
        _yaxis: plot._fullLayout['yaxis' + panel] };
    const box = plot.getBoundingClientRect();
    return [box.left + a._offset + a.l2p(x), box.top + b._offset + b.l2p(y)];
})";

fn place(tab: &mut Tab, panel: &str, x: f64, y: f64) -> [f64; 2] {
    let at = tab.script(&format!("{PLACE}({panel:?}, {x}, {y})"));
    [at[0].as_f64().unwrap(), at[1].as_f64().unwrap()]
}

#[test]
#[ignore = "needs a browser"]
fn the_page_opens_without_a_message_and_replaces_the_static_figure() {
    let mut tab = opened(1400, false);
    let shown = tab.script(
        "[...document.querySelectorAll('.suite')].filter(pane => !pane.hidden).length + 10 * \
         document.querySelectorAll('#plot .subplot').length",
    );
    assert_eq!(shown, json!(40), "no static figure, and 4 panels");
    assert!(tab.messages.is_empty(), "{:?}", tab.messages);
}

#[test]
#[ignore = "needs a browser"]
fn the_library_beside_the_page_is_read() {
    let mut tab = Tab::new(1400, 900, false);
    let mut library = Vec::new();
    write_library(&mut library).unwrap();
    fs::write(tab.folder().join(LIBRARY_FILE), library).unwrap();
    let page = page(Assets::Beside);
    assert!(page.len() < 2_000_000);
    tab.open(&page).unwrap();
    assert!(tab.messages.is_empty(), "{:?}", tab.messages);
}

#[test]
#[ignore = "needs a browser"]
fn without_the_library_the_static_figure_stays_and_the_console_says_why() {
    let mut tab = Tab::new(1400, 900, false);
    let reports = |tab: &mut Tab| {
        let state = tab.script("document.readyState");
        state == "complete" && tab.messages.iter().any(|message| message.contains("plotly.js"))
    };
    tab.open_until(&page(Assets::Beside), reports).unwrap();
    assert_ne!(tab.script("document.documentElement.dataset.ready"), "yes");
    let shown = "[...document.querySelectorAll('.suite')].filter(pane => !pane.hidden).length";
    assert_eq!(tab.script(shown), json!(1));
}

#[test]
#[ignore = "needs a browser"]
fn zooming_into_one_panel_moves_the_times_of_all_and_shows_every_sample() {
    let mut tab = opened(1400, false);
    let corners = [(0.5, 0.1), (0.75, 0.2), (1.0, 0.4)];
    let drag = corners.map(|(x, y)| place(&mut tab, "", x, y));
    tab.mouse(&drag, true);
    let range = |tab: &mut Tab, axis: &str| {
        let range = tab.script(&format!("plot._fullLayout.{axis}.range"));
        [range[0].as_f64().unwrap(), range[1].as_f64().unwrap()]
    };
    let [first, last] = [range(&mut tab, "xaxis"), range(&mut tab, "xaxis4")];
    assert!((first[0] - 0.5).abs() < 0.02 && (first[1] - 1.0).abs() < 0.02, "{first:?}");
    assert_eq!(first, last, "the times are linked");
    // 0.5 s at 100 Hz and one sample beyond each end.
    let drawn = tab.script("plot.data.find(line => line.meta?.run === 0).x.length");
    assert!((50..=54).contains(&drawn.as_u64().unwrap()), "{drawn}");
    tab.script("plot.focus(), plot.dispatchEvent(new KeyboardEvent('keydown', { key: '0' }))");
    assert_eq!(range(&mut tab, "xaxis"), [0.0, 2.0]);
}

#[test]
#[ignore = "needs a browser"]
fn a_run_is_hidden_by_its_box_and_highlighted_by_its_button() {
    let mut tab = opened(1400, false);
    let lines = "plot.data.filter(line => line.meta?.run === 1).length";
    assert_eq!(tab.script(lines), json!(4));
    tab.script("document.querySelectorAll('#run-list input')[1].click()");
    assert_eq!(tab.script(lines), json!(0));
    tab.script("document.querySelectorAll('#run-list input')[1].click()");
    assert_eq!(tab.script(lines), json!(4));
    let opacity = |tab: &mut Tab, run: usize| {
        let of = format!("document.querySelector('#plot g.tracerun{run}-0x')");
        tab.script(&format!("getComputedStyle({of}).opacity"))
    };
    tab.script("document.querySelectorAll('#run-list button')[1].click()");
    assert_eq!([opacity(&mut tab, 0), opacity(&mut tab, 1)], [json!("0.1"), json!("1")]);
}

#[test]
#[ignore = "needs a browser"]
fn the_values_at_the_cursor_are_the_recorded_ones() {
    let mut tab = opened(1400, false);
    let figure = sample::suite("A", 2);
    // Run 3 lies apart from the others at 1.5 s; panel 2 is the velocity of the first joint.
    let (run, sample, state) = (2, 150, 2);
    let (time, value) = (figure.times[sample], figure.runs[run].states[state][sample]);
    let at = place(&mut tab, "2", time, value);
    let panel =
        tab.script("plot.data.find(line => line.meta?.run === 0 && line.yaxis === 'y2').uid");
    assert_eq!(panel, json!("run0-2x"));
    tab.mouse(&[[at[0] - 3.0, at[1]], at], false);
    let shown = "(({ data, x, y, customdata }) => \
                 [data.name, x, y, customdata])(plot._hoverdata[0])";
    let shown = tab.script(shown);
    let near = |k: usize, expected: f64, error: f64| {
        let value = shown[k].as_f64().unwrap();
        assert!((value - expected).abs() <= error, "{value} is not {expected}: {shown}");
    };
    assert_eq!(shown[0], json!("run 3"));
    near(1, time, 0.0);
    let rounding = tab.script("suite().rounding[1]").as_f64().unwrap();
    near(2, value, rounding + 1e-15);
    let inside = value - figure.band.lower[state][sample];
    near(3, inside.min(figure.band.upper[state][sample] - value), 2.0 * rounding + 1e-7);
    let label = tab.script("document.querySelector('#plot .hoverlayer').textContent");
    assert!(label.as_str().unwrap().contains("run 3") && label.as_str().unwrap().contains("edge"));
}

#[test]
#[ignore = "needs a browser"]
fn a_peak_of_one_sample_is_drawn_at_first() {
    let mut page = sample::page();
    let figure = &mut page.suites[0];
    let times: Vec<f64> = (0..20_000).map(|k| f64::from(k) * 1e-4).collect();
    let mut states = vec![vec![0.0; times.len()]; 4];
    states[0][12_345] = 1.0;
    figure.runs[0] = RunTrace { name: "peak".into(), times, states, ..RunTrace::default() };
    figure.nominal = Nominal::Unknown;
    let mut html = Vec::new();
    write_html(&page, Assets::Inside, &mut html).unwrap();
    let mut tab = Tab::new(1400, 900, false);
    tab.open(&html).unwrap();
    let line = "plot.data.find(line => line.uid === 'run0-0x')";
    let drawn = tab.script(&format!("{line}.y.length")).as_u64().unwrap();
    assert!(drawn < 3_000, "{drawn}");
    assert_eq!(tab.script(&format!("Math.max(...{line}.y)")).as_f64(), Some(1.0));
}

#[test]
#[ignore = "needs a browser"]
fn the_choices_and_a_tight_spot_change_the_figure() {
    let mut tab = opened(1400, false);
    tab.script("document.querySelector('#suites [value=\"1\"]').click()");
    assert_eq!(tab.script("document.querySelectorAll('#plot .subplot').length"), json!(14));
    tab.script("document.querySelector('tr[data-time] button').click()");
    let state = tab.script("[state.suite, state.view, state.joint, state.pinned, state.range]");
    let [from, to] = [1.35, 1.65];
    assert_eq!(state, json!([0, "deviation", "1", 2, [from, to]]));
    let nominal = tab.script("plot.data.some(line => line.uid.startsWith('run2-1x'))");
    assert_eq!(nominal, Value::Bool(true));
}

#[test]
#[ignore = "needs a browser"]
fn dark_and_phone_pages_do_not_overflow() {
    for (width, dark) in [(400, false), (400, true), (1400, true)] {
        let mut tab = opened(width, dark);
        let widest = tab.script("document.documentElement.scrollWidth").as_u64().unwrap();
        assert!(widest <= u64::from(width), "{widest} px in {width} px");
        let colours = tab.script("[plot._fullLayout.font.color, css('--ink')]");
        assert_eq!(colours[0], colours[1]);
        assert_eq!(colours[0] == "#e4e8ee", dark);
        assert!(tab.messages.is_empty(), "{:?}", tab.messages);
        // A table that is wider scrolls in a box of its own, which lies in the window.
        let cut = tab.script(
            "[...document.querySelectorAll('table')].filter(table => {
                 const box = table.closest('.wide, .tall');
                 const inside = box && box.getBoundingClientRect().right <= innerWidth;
                 return !inside || getComputedStyle(box).overflowX !== 'auto';
             }).map(table => table.textContent)",
        );
        assert_eq!(cut, json!([]), "in {width} px");
    }
}

#[test]
#[ignore = "needs a browser"]
fn messages_and_foreign_files_are_noticed() {
    let text = String::from_utf8(page(Assets::Inside)).unwrap();
    let planted = "<img src=\"https://example.invalid/x.png\" alt=\"\"></main>";
    let mut tab = Tab::new(1400, 900, false);
    tab.open(text.replacen("</main>", planted, 1).as_bytes()).unwrap();
    assert!(tab.messages.iter().any(|m| m.contains("Content Security Policy")));
}
