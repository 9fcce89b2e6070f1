// The phase planes: each static one becomes interactive when it comes near the window.

function planeTraces({ series }, place) {
  const lighter = c => (isDark.matches ? Math.round(c + (255 - c) * 0.35) : c);
  const ink = colour => `rgb(${colour.map(lighter).join()})`;
  return series.map(({ points, mark, colour }, k) => ({
    type: "scatter", mode: mark === "dots" ? "markers" : "lines", uid: `plane${place}-${k}x`,
    x: points.map(p => p[0]), y: points.map(p => p[1]),
    line: { color: ink(colour), width: 1.3 }, marker: { color: ink(colour), size: 5 },
    ...(mark === "dots"
      ? { hovertemplate: "%{x:.6~g}, %{y:.6~g}<extra></extra>" } : { hoverinfo: "skip" }),
  }));
}

// Returns the range of a coordinate of all points with room beyond its ends.
function rangeOf(series, coordinate) {
  const values = series.flatMap(({ points }) => points.map(p => p[coordinate]));
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const margin = 0.05 * (high - low) || 0.5;
  return [low - margin, high + margin];
}

function planeLayout({ title, x, y, series }, width) {
  const [ink, soft, line] = ["--ink", "--soft", "--line"].map(css);
  const axis = {
    gridcolor: line, linecolor: soft, zeroline: false, showline: true, mirror: true, nticks: 6,
    ticks: "outside", ticklen: 3,
  };
  return {
    width, height: Math.round(0.7 * width),
    margin: { l: 62, r: 10, t: 30, b: 44 },
    title: {
      text: `<b>${plain(title)}</b>`, font: { size: 12.5 }, y: 0.97, x: 0, xref: "paper",
    },
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
    font: { family: "inherit", size: 11, color: ink }, showlegend: false, hovermode: "closest",
    modebar: { bgcolor: "rgba(0,0,0,0)", color: soft, activecolor: ink },
    hoverlabel: { bgcolor: css("--raised"), bordercolor: soft, font: { color: ink } },
    xaxis: { ...axis, title: { text: x, standoff: 4 }, range: rangeOf(series, 0) },
    yaxis: { ...axis, title: { text: y, standoff: 4 }, range: rangeOf(series, 1) },
  };
}

function watchPlanes() {
  const section = element("planes");
  if (!section) return;
  const charts = JSON.parse(element("plane-data").textContent);
  const width = Math.min(400, section.clientWidth);
  const drawPlane = (place, at) => Plotly.react(
    place, planeTraces(charts[at], at), planeLayout(charts[at], width),
    {
      displaylogo: false,
      // On a narrow screen the buttons would cover the title.
      displayModeBar: document.documentElement.clientWidth >= NARROW && "hover",
      modeBarButtonsToRemove: ["select2d", "lasso2d", "zoomIn2d", "zoomOut2d"],
    },
  );
  const places = all(":scope > svg", section).map(svg => {
    const place = document.createElement("div");
    place.className = "plane";
    svg.replaceWith(place);
    place.append(svg);
    return place;
  });
  const drawn = new Set();
  const watcher = new IntersectionObserver(seen => {
    seen.filter(entry => entry.isIntersecting).forEach(({ target }) => {
      watcher.unobserve(target);
      target.replaceChildren();
      drawn.add(places.indexOf(target));
      drawPlane(target, places.indexOf(target));
    });
  }, { rootMargin: "300px" });
  places.forEach(place => watcher.observe(place));
  isDark.addEventListener("change", () => drawn.forEach(at => drawPlane(places[at], at)));
}
