// The interactive figure of a suite: its panels, lines and colours, as Plotly takes them.

const NARROW = 640; // Width below which one joint is shown at first, without buttons, px.
const PANEL_WIDTH = 190; // Smallest width of a panel with its labels, px.
const [LEFT, RIGHT, NAME, BETWEEN, BELOW] = [54, 10, 24, 12, 44]; // Room around a panel, px.
const TOOLS = 26; // Height of the row of Plotly's buttons, px.

const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const isDark = matchMedia("(prefers-color-scheme: dark)");
// Names from files are no markup for Plotly.
const plain = text => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");

// Returns the colour at a place from 0 to 1 on the scale of the static figures; lighter on dark
// ground.
function scaleColour(place) {
  const anchors = JSON.parse(element("scale").textContent);
  const at = Math.min(Math.max(place, 0), 1) * (anchors.length - 1);
  const below = Math.min(Math.floor(at), anchors.length - 2);
  const mix = (from, to, part) => Math.round(from + (to - from) * part);
  const colour = anchors[below].map((from, c) => mix(from, anchors[below + 1][c], at - below));
  return `rgb(${colour.map(c => (isDark.matches ? mix(c, 255, 0.4) : c)).join()})`;
}

// Returns the colours of the runs by a quantity, and the two ends of the scale in words.
function runColours(suite, by) {
  const values = suite.runs.map(run => run[by]);
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const words = {
    order: [`run ${low + 1}`, `run ${high + 1}`],
    temperature: [`${low.toFixed(1)} °C`, `${high.toFixed(1)} °C`],
    gauge: [`${(100 * low).toFixed(0)} % of the set`, `${(100 * high).toFixed(0)} %`],
  };
  const colours = values.map(value => scaleColour(high > low ? (value - low) / (high - low) : 0.5));
  return { colours, ends: words[by] };
}

// Returns the panels of the chosen joints in a width, and the height of all of them, px.
function panels(suite, joint, width) {
  const joints = joint === "" ? suite.joints.map((_, index) => index) : [Number(joint)];
  const most = Math.max(1, Math.min(6, Math.floor(width / PANEL_WIDTH)));
  const rows = Math.ceil(joints.length / most);
  const columns = Math.ceil(joints.length / rows);
  const height = joints.length === 1 ? 220 : 150;
  const tools = width < NARROW ? 0 : TOOLS;
  const block = NAME + 2 * height + BETWEEN + BELOW;
  const cell = width / columns;
  const placed = joints.flatMap((index, place) => [0, 1].map(second => {
    const column = place % columns;
    const above = tools + NAME + second * (height + BETWEEN);
    const top = block * Math.floor(place / columns) + above;
    return {
      state: index + second * suite.joints.length,
      heading: suite.headings[index],
      isVelocity: second === 1,
      isFirst: column === 0,
      left: column * cell + LEFT,
      right: (column + 1) * cell - RIGHT,
      top,
      bottom: top + height,
    };
  }));
  return { placed, height: tools + block * rows };
}

const suffix = place => (place === 0 ? "" : String(place + 1));

// Returns the layout: axes in their places, times linked.
function figureLayout(suite, state, width) {
  const { placed, height } = panels(suite, state.joint, width);
  const [ink, soft, line] = ["--ink", "--soft", "--line"].map(css);
  const layout = {
    width,
    height,
    margin: { l: 0, r: 0, t: 0, b: 0 },
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    font: { family: "inherit", size: 11, color: ink },
    hoverlabel: {
      bgcolor: css("--raised"), bordercolor: soft, font: { color: ink }, align: "left",
    },
    modebar: { bgcolor: "rgba(0,0,0,0)", color: soft, activecolor: ink },
    showlegend: false,
    hovermode: "closest",
    hoverdistance: 12,
    dragmode: "zoom",
    uirevision: [state.suite, state.view, state.joint, state.reset].join(),
    annotations: [],
  };
  const axis = {
    gridcolor: line, linecolor: soft, zeroline: false, showline: true, mirror: true,
    ticks: "outside", ticklen: 3, nticks: 6, automargin: false,
  };
  placed.forEach((panel, place) => {
    const [x, y] = [`x${suffix(place)}`, `y${suffix(place)}`];
    layout[`xaxis${suffix(place)}`] = {
      ...axis,
      domain: [panel.left / width, panel.right / width],
      anchor: y,
      ...(place > 0 && { matches: "x" }),
      range: [...state.range], // Plotly changes it in place.
      showticklabels: panel.isVelocity,
      title: panel.isVelocity ? { text: "time [s]", standoff: 4 } : undefined,
    };
    layout[`yaxis${suffix(place)}`] = {
      ...axis,
      domain: [1 - panel.bottom / height, 1 - panel.top / height],
      anchor: x,
      autorange: true,
      title: panel.isFirst ? { text: suite.axes[panel.state], standoff: 4 } : undefined,
    };
    if (!panel.isVelocity) {
      layout.annotations.push({
        text: `<b>${plain(panel.heading)}</b>`,
        xref: "paper", yref: "paper", x: (panel.left + panel.right) / 2 / width,
        y: 1 - (panel.top - 3) / height, xanchor: "center", yanchor: "bottom",
        showarrow: false, font: { size: 12.5 },
      });
    }
  });
  return layout;
}

// Returns the lines of one panel: the bands, the runs that are shown, and the tight spots.
function panelTraces(suite, state, panel, place, colours) {
  const axes = { xaxis: `x${suffix(place)}`, yaxis: `y${suffix(place)}` };
  const columns = Math.ceil(panel.right - panel.left);
  const i = panel.state;
  const bands = suite.bands.flatMap((band, b) => [band.lower, band.upper].map((edge, side) => {
    const values = edgeLine(suite, edge, i, state.view);
    const kept = suite.columns
      ? [...values.keys()] : thin(suite.times, values, state.range, columns);
    return {
      ...axes, type: "scatter", mode: "lines", hoverinfo: "skip", uid: `band${b}-${side}-${i}x`,
      x: kept.map(k => suite.times[k]), y: kept.map(k => values[k]),
      line: { color: css(`--band-${b}-edge`), width: 1, shape: suite.columns ? "hv" : "linear" },
      ...(side === 1 && { fill: "tonexty", fillcolor: css(`--band-${b}`) }),
    };
  }));
  const unit = suite.units[i];
  const hover = `<b>%{fullData.name}</b><br>%{x:.4f} s: %{y:.7~g} ${unit}` +
    `<br>%{customdata:.3~g} ${unit} to the edge of the set<extra></extra>`;
  const deviation = (run, k) => {
    const nominal = suite.nominal ? valueAt(suite.times, suite.nominal[i], run.times[k]) : 0;
    return run.states[i][k] - nominal;
  };
  const runs = suite.runs.flatMap((run, r) => {
    if (state.hidden.has(r)) return [];
    const values = runLine(suite, run, i, state.view);
    const kept = thin(run.times, values, state.range, columns);
    return [{
      ...axes, type: "scatter", mode: "lines", name: plain(run.name), uid: `run${r}-${i}x`,
      meta: { run: r }, x: kept.map(k => run.times[k]), y: kept.map(k => values[k]),
      customdata: kept.map(k => distance(suite, i, run.times[k], deviation(run, k))),
      line: { color: colours[r], width: 1.3 }, hovertemplate: hover,
    }];
  });
  return [...bands, ...runs, ...spotTraces(suite, state, i, axes)];
}

// Returns the rings of a state: tight spots, and samples outside the set larger and red.
function spotTraces(suite, state, i, axes) {
  const spots = suite.tight.filter(spot => spot.state === i && !state.hidden.has(spot.run));
  if (spots.length === 0) return [];
  const y = spots.map(({ run, time }) => (
    valueAt(suite.runs[run].times, runLine(suite, suite.runs[run], i, state.view), time)
  ));
  const outside = spots.map(spot => spot.margin < 0);
  return [{
    ...axes, type: "scatter", mode: "markers", uid: `spots-${i}x`, x: spots.map(s => s.time), y,
    customdata: spots.map((spot, k) => (
      [plain(suite.runs[spot.run].name), spot.margin, outside[k] ? "lies outside" : "decides"]
    )),
    marker: {
      symbol: "circle-open", size: outside.map(is => (is ? 12 : 8)),
      color: outside.map(is => css(is ? "--bad" : "--ink")), line: { width: 1.4 },
    },
    hovertemplate: `<b>%{customdata[0]}</b> %{customdata[2]} here<br>%{x:.4f} s: %{y:.7~g} ` +
      `${suite.units[i]}<br>margin %{customdata[1]:.3~g} ${suite.units[i]}<extra></extra>`,
  }];
}

function figureTraces(suite, state, width) {
  const { colours } = runColours(suite, state.colour);
  return panels(suite, state.joint, width).placed.flatMap((panel, place) => (
    panelTraces(suite, state, panel, place, colours)
  ));
}
