//! The report page in a headless browser: its script runs to the end without an error.

use reachtube_testing::Tab;
use serde_json::json;

use crate::fixture::Lab;

#[test]
fn the_page_and_its_figures_are_written() {
    let lab = Lab::new();
    let run = lab.conform("--out model.json --report report").exits(0);
    assert!(run.stdout.contains("wrote: model.json, report/report.html\n"), "{}", run.stdout);
    let figures = ["A_deviation.svg", "A_motion.svg", "B_deviation.svg", "B_motion.svg"];
    assert_eq!(lab.names("report"), [&figures[..], &["report.html"]].concat());
    for name in figures {
        let svg = lab.read(&format!("report/{name}"));
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{name}");
    }
    let html = lab.read("report/report.html");
    // The page works offline.
    let addresses = ["src=", "url("].map(|part| html.split(part).skip(1));
    let mut addresses = addresses.into_iter().flatten();
    assert!(addresses.all(|rest| !rest.trim_start_matches(['"', '\'']).starts_with("http")));
    let mut links = html.split("<link").skip(1).map(|rest| rest.split('>').next().unwrap());
    assert!(links.all(|link| !link.contains("http")));
    lab.run("report --model model.json --data data --torque compensated --out again").exits(0);
    assert_eq!(lab.read("again/report.html"), html);
}

#[test]
fn the_library_lies_beside_the_page_on_request() {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    let report = "report --model model.json --data data --torque compensated";
    lab.run(&format!("{report} --out beside --assets beside")).exits(0);
    assert!(lab.names("beside").contains(&"plotly.js".to_string()));
    assert!(lab.read("beside/plotly.js").contains("plotly.js v3"));
    assert!(!lab.read("beside/report.html").contains("id=\"library\""));
    // The command replaces its own file.
    lab.run(&format!("{report} --out beside --assets beside")).exits(0);
    lab.run(&format!("{report} --out inside")).exits(0);
    assert!(lab.read("inside/report.html").contains("id=\"library\""));
    assert!(!lab.names("inside").contains(&"plotly.js".to_string()));
}

#[test]
#[ignore = "needs a browser"]
fn the_page_opens() {
    let lab = Lab::new();
    lab.conform("--report report").exits(0);
    let mut tab = Tab::new(1400, 900, false);
    tab.open(lab.read("report/report.html").as_bytes()).unwrap();
    assert!(tab.messages.is_empty(), "{:?}", tab.messages);
    assert_eq!(tab.script("document.querySelectorAll('figure').length"), json!(5));
}

#[test]
#[ignore = "needs a browser"]
fn the_view_of_a_verification_follows_its_slider() {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    lab.write(
        "capsules.toml",
        "[[capsule]]\nlink = 2\nfrom = [0, 0, 0]\nto = [0.6, 0, 0]\nradius = 0.04\n",
    );
    lab.write("brakes.toml", "torque = [[5, 8], [5, 8]]\ndelay = [0.0, 0.01]\n");
    lab.write(
        "cell.toml",
        "model = \"model.json\"\ndata = \"data\"\ncapsules = \"capsules.toml\"\n\
         [[obstacle]]\nname = \"it\"\nsphere = { centre = [1, 1, 1], radius = 0.1 }\n\
         [stop]\nbrakes = \"brakes.toml\"\n",
    );
    lab.run("verify cell.toml --out cell").exits(0);
    let mut tab = Tab::new(400, 900, true);
    tab.open(lab.read("cell/verify.html").as_bytes()).unwrap();
    let count = "document.getElementById('scene').data.length";
    assert_eq!(tab.script(count), json!(5));
    let last = "const s = document.getElementById('slider'); s.value = s.max; \
                s.dispatchEvent(new Event('input')); document.getElementById('time').textContent";
    assert!(tab.script(last).as_str().unwrap().ends_with("in the worst stop"));
    let wide = "document.documentElement.scrollWidth <= innerWidth";
    assert_eq!(tab.script(wide), json!(true));
}
