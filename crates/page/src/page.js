// The controls of the page. Until the library is read, they choose among the static figures; then
// the interactive figure takes their place.

document.documentElement.classList.add("js");

const state = {
  suite: 0, view: "motion", colour: "order", joint: "", range: null, reset: 0,
  hidden: new Set(), pinned: null,
};
const plot = element("plot");
const suite = () => readSuite(state.suite);
const isReady = () => document.documentElement.dataset.ready === "yes";

// Makes a row of buttons choose a value.
function choice(id, current, choose) {
  const group = element(id);
  if (!group) return;
  group.hidden = false;
  const buttons = all("button", group);
  buttons.forEach(button => button.addEventListener("click", () => choose(button.value)));
  group.mark = () => buttons.forEach(button => {
    button.setAttribute("aria-pressed", String(button.value === current()));
  });
  group.mark();
}

// Shows the static figure of the suite and the view, as long as there is no other.
function showStatic() {
  all("[data-suite]").forEach(pane => {
    pane.hidden = isReady() || Number(pane.dataset.suite) !== state.suite;
  });
  all("[data-view]").forEach(pane => { pane.hidden = pane.dataset.view !== state.view; });
  ["suites", "views"].forEach(id => element(id) && element(id).mark());
}

function chooseSuite(index) {
  Object.assign(state, { suite: index, hidden: new Set(), pinned: null, range: null });
  if (isReady()) openSuite();
  showStatic();
}

function chooseView(view) {
  state.view = view;
  showStatic();
  if (isReady()) draw();
}

// Fills the controls for the suite that was chosen and draws it.
function openSuite() {
  const { runs, joints, views, times } = suite();
  if (!views.includes(state.view)) state.view = views[0];
  if (element("views")) element("views").hidden = views.length < 2;
  const has = key => runs.length > 0 && runs.every(run => run[key] !== null);
  const names = { order: "order", temperature: "temperature", gauge: "part of the set used" };
  const quantities = Object.keys(names).filter(key => key === "order" || has(key));
  if (!quantities.includes(state.colour)) state.colour = "order";
  options("colour", quantities.map(key => [key, names[key]]), state.colour);
  if (Number(state.joint) >= joints.length) state.joint = "";
  options("joint", [["", "all"], ...joints.map((name, k) => [String(k), name])], state.joint);
  state.range = state.range || [times[0], times[times.length - 1]];
  listRuns();
  draw();
}

function options(id, pairs, chosen) {
  element(id).replaceChildren(...pairs.map(([value, label]) => (
    new Option(label, value, false, value === chosen)
  )));
}

// Lists the runs: a box that shows or hides each, and a button that highlights it.
function listRuns() {
  element("run-list").replaceChildren(...suite().runs.map((run, r) => {
    const item = document.createElement("li");
    const box = item.appendChild(document.createElement("input"));
    Object.assign(box, { type: "checkbox", checked: !state.hidden.has(r) });
    box.setAttribute("aria-label", `Show ${run.name}`);
    box.addEventListener("change", () => {
      if (box.checked) state.hidden.delete(r); else state.hidden.add(r);
      draw();
    });
    const button = item.appendChild(document.createElement("button"));
    button.type = "button";
    button.append(document.createElement("i"), run.name);
    const more = button.appendChild(document.createElement("small"));
    const degrees = run.temperature === null ? "" : `${run.temperature.toFixed(1)} °C `;
    const leaves = suite().tight.some(spot => spot.run === r && spot.margin < 0);
    const decides = run.touches > 0 ? `decides ${run.touches}` : "";
    more.textContent = degrees + (leaves ? "outside" : decides);
    button.addEventListener("click", () => pin(r));
    item.addEventListener("pointerenter", () => highlight(r));
    item.addEventListener("pointerleave", () => highlight(null));
    button.addEventListener("focus", () => highlight(r));
    button.addEventListener("blur", () => highlight(null));
    return item;
  }));
}

function showRuns(shown) {
  state.hidden = new Set(suite().runs.flatMap((run, r) => (shown(run, r) ? [] : [r])));
  listRuns();
  draw();
}

// Keeps a run highlighted until it is chosen again.
function pin(r) {
  state.pinned = state.pinned === r ? null : r;
  highlight(null);
}

// Dims all runs but one, or but the one kept. A style sheet does it without drawing again.
const sheet = document.head.appendChild(document.createElement("style"));
function highlight(r) {
  const lit = r === null ? state.pinned : r;
  const line = `#plot g.trace[class*="tracerun${lit}-"]`;
  sheet.textContent = lit === null ? "" :
    `#plot g.trace[class*="tracerun"] { opacity: .1 !important; }
     ${line} { opacity: 1 !important; }
     ${line} path { stroke-width: 2.2px !important; }`;
  all("#run-list button").forEach((button, k) => {
    button.classList.toggle("lit", k === lit);
    button.setAttribute("aria-pressed", String(k === state.pinned));
  });
}

const figureWidth = () => Math.max(280, Math.floor(element("explorer").clientWidth));

// Draws the figure anew in the space there is.
function draw() {
  const width = figureWidth();
  const { colours, ends } = runColours(suite(), state.colour);
  all("#run-list i").forEach((swatch, r) => { swatch.style.background = colours[r]; });
  if (suite().runs.length > 0) {
    all("#scale-ends span").forEach((span, k) => { span.textContent = ends[k]; });
    const stops = [0, 0.25, 0.5, 0.75, 1].map(scaleColour);
    element("scale-bar").style.background = `linear-gradient(90deg, ${stops.join()})`;
  }
  element("band-names").replaceChildren(...suite().bands.map(({ label }, b) => {
    const entry = document.createElement("span");
    entry.append(document.createElement("i"), label);
    entry.firstChild.style.background = css(`--band-${b}`);
    entry.firstChild.style.borderColor = css(`--band-${b}-edge`);
    return entry;
  }));
  const [q, qd] = suite().rounding.map(error => error.toExponential(0));
  element("rounding").textContent = `Values at the cursor are the recorded samples, rounded by ` +
    `at most ${q} (positions) and ${qd} (velocities); the set's bounds are rounded outward.` +
    (suite().columns ? " Each step of a band is its extreme over that time." : "");
  const config = {
    displaylogo: false, doubleClick: false, displayModeBar: width >= NARROW,
    modeBarButtonsToRemove: ["autoScale2d", "resetScale2d", "select2d", "lasso2d"],
  };
  const data = figureTraces(suite(), state, width);
  highlight(null);
  return Plotly.react(plot, data, figureLayout(suite(), state, width), config);
}

// Draws the times that are shown at full resolution once the axes were moved.
function onMoved() {
  const [from, to] = plot.layout.xaxis.range;
  if (from === state.range[0] && to === state.range[1]) return;
  state.range = [from, to];
  draw();
}

const wholeRange = () => [suite().times[0], suite().times[suite().times.length - 1]];

function resetZoom() {
  state.range = wholeRange();
  state.reset += 1;
  draw();
}

// Shows a part of the time shown: moved and stretched by parts of its length.
function zoom(shift, stretch) {
  const [from, to] = state.range;
  const [middle, half] = [(from + to) / 2 + shift * (to - from), stretch * (to - from) / 2];
  Plotly.relayout(plot, { "xaxis.range": [middle - half, middle + half] });
}

const KEYS = {
  ArrowLeft: () => zoom(-0.2, 1), ArrowRight: () => zoom(0.2, 1), "+": () => zoom(0, 0.6),
  "=": () => zoom(0, 0.6), "-": () => zoom(0, 1 / 0.6), 0: resetZoom, Escape: resetZoom,
};

function onKey(event) {
  const act = KEYS[event.key];
  if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  act();
}

// Shows the place of a tight spot: its joint, a short time about it, its run highlighted.
function goTo({ suiteIndex: index, run, time, state: at }) {
  chooseSuite(Number(index));
  const { views, joints } = suite();
  state.joint = String(Number(at) % joints.length);
  state.pinned = Number(run);
  state.range = [Number(time) - 0.15, Number(time) + 0.15];
  state.reset += 1;
  if (views.includes("deviation")) state.view = "deviation";
  openSuite();
  showStatic();
  element("explorer").scrollIntoView({ block: "start" });
  plot.focus({ preventScroll: true });
}

// Makes the time in each row of the table of tight spots a button that goes there.
function linkSpots() {
  all("tr[data-time]").forEach(row => {
    const cell = row.querySelector(".number");
    const button = document.createElement("button");
    Object.assign(button, { type: "button", className: "link", textContent: cell.textContent });
    button.addEventListener("click", () => goTo(row.dataset));
    cell.replaceChildren(button);
  });
}

// Filters the buttons of the suites by what is typed.
function searchSuites() {
  const field = element("suite-search");
  if (!field) return;
  field.parentElement.hidden = false;
  field.addEventListener("input", () => {
    const wanted = field.value.trim().toLowerCase();
    all("#suites button").forEach(button => {
      button.hidden = !button.textContent.toLowerCase().includes(wanted);
    });
  });
}

function start() {
  if (document.documentElement.clientWidth < NARROW) state.joint = "0";
  if (suite().runs.every(run => run.temperature !== null)) state.colour = "temperature";
  element("explorer").hidden = false;
  document.documentElement.dataset.ready = "yes";
  openSuite();
  showStatic();
  const on = (id, event, act) => element(id).addEventListener(event, act);
  on("colour", "change", event => { state.colour = event.target.value; draw(); });
  on("joint", "change", event => { state.joint = event.target.value; draw(); });
  on("reset", "click", resetZoom);
  on("show-all", "click", () => showRuns(() => true));
  on("show-none", "click", () => showRuns(() => false));
  const marked = r => suite().tight.some(spot => spot.run === r);
  on("show-deciding", "click", () => showRuns((run, r) => marked(r)));
  on("plot", "keydown", onKey);
  plot.on("plotly_relayout", onMoved);
  plot.on("plotly_doubleclick", resetZoom);
  plot.on("plotly_hover", ({ points: [{ data }] }) => data.meta && highlight(data.meta.run));
  plot.on("plotly_unhover", () => highlight(null));
  plot.on("plotly_click", ({ points: [{ data }] }) => data.meta && pin(data.meta.run));
  // A phone changes the height of the window while it scrolls.
  addEventListener("resize", () => { if (plot.layout.width !== figureWidth()) draw(); });
  isDark.addEventListener("change", draw);
  linkSpots();
  watchPlanes();
}

// Reads the library after the first picture of the page is on the screen. In the page it is
// compressed; a browser that cannot read it keeps the static figures.
async function readLibrary() {
  const script = document.createElement("script");
  const inside = element("library");
  if (inside) {
    const packed = new Blob([bytes(inside.textContent)]).stream();
    const text = packed.pipeThrough(new DecompressionStream("gzip"));
    script.textContent = await new Response(text).text();
    document.head.append(script);
    start();
  } else {
    Object.assign(script, { src: "plotly.js", onload: start });
    document.head.append(script);
  }
}

if (plot) {
  choice("suites", () => String(state.suite), value => chooseSuite(Number(value)));
  choice("views", () => state.view, chooseView);
  const only = all("figure[data-only]")[0];
  if (only) state.view = only.dataset.only;
  searchSuites();
  showStatic();
  addEventListener("DOMContentLoaded", () => {
    requestAnimationFrame(() => setTimeout(readLibrary));
  });
}
