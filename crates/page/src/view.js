"use strict";
// The worst motion in three dimensions: capsules and obstacles as meshes of Plotly.

const element = id => document.getElementById(id);
const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const isDark = matchMedia("(prefers-color-scheme: dark)");
const data = JSON.parse(element("view-data").textContent);
const [AROUND, RINGS] = [16, 8]; // Points of a ring of a capsule, and rings of each end.
const SHOWN = 4; // Number of times of which a swept set is drawn: more would hide each other.
const ORANGE = "#e08a00";
const frames = [...data.frames, ...data.stop];

const times = (v, s) => v.map(x => x * s);
const plus = (...all) => [0, 1, 2].map(i => all.reduce((sum, v) => sum + v[i], 0));
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
];
const unit = v => times(v, 1 / (Math.hypot(...v) || 1));

// Returns two directions that are at right angles to a direction and to each other.
function across(axis) {
  const other = Math.abs(axis[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
  const first = unit(cross(axis, other));
  return [first, cross(axis, first)];
}

// Adds a capsule to a mesh: rings from one end to the other.
function addCapsule(mesh, [a, b, c, d, e, f, radius]) {
  const [from, to] = [[a, b, c], [d, e, f]];
  const between = plus(to, times(from, -1));
  const axis = Math.hypot(...between) > 1e-9 ? unit(between) : [0, 0, 1];
  const [u, v] = across(axis);
  const start = mesh.x.length;
  for (let ring = 0; ring < 2 * RINGS; ring++) {
    const end = ring < RINGS ? from : to;
    const step = ring < RINGS ? ring : ring - 1;
    const latitude = Math.PI * (step / (2 * RINGS - 2) - 0.5);
    for (let k = 0; k < AROUND; k++) {
      const angle = 2 * Math.PI * k / AROUND;
      const flat = radius * Math.cos(latitude);
      addPoint(mesh, plus(
        end, times(axis, radius * Math.sin(latitude)),
        times(u, flat * Math.cos(angle)), times(v, flat * Math.sin(angle)),
      ));
    }
  }
  for (let ring = 0; ring + 1 < 2 * RINGS; ring++) {
    for (let k = 0; k < AROUND; k++) {
      const [p, q] = [k, (k + 1) % AROUND].map(at => start + ring * AROUND + at);
      addTriangles(mesh, [[p, q, p + AROUND], [q, q + AROUND, p + AROUND]]);
    }
  }
}

function addPoint(mesh, [x, y, z]) {
  mesh.x.push(x);
  mesh.y.push(y);
  mesh.z.push(z);
}

function addTriangles(mesh, triangles) {
  for (const [i, j, k] of triangles) {
    mesh.i.push(i);
    mesh.j.push(j);
    mesh.k.push(k);
  }
}

const emptyMesh = () => ({ x: [], y: [], z: [], i: [], j: [], k: [] });

function capsules(all) {
  const mesh = emptyMesh();
  all.forEach(capsule => addCapsule(mesh, capsule));
  return mesh;
}

// Returns an obstacle as it has grown until a time; a box grows along its sides.
function obstacleMesh({ solid, speed }, time) {
  const mesh = emptyMesh();
  const grown = speed * time;
  if (solid.capsule) {
    const { from, to, radius } = solid.capsule;
    addCapsule(mesh, [...from, ...to, radius + grown]);
  } else if (solid.box) {
    const { centre, axes, half } = solid.box;
    for (let corner = 0; corner < 8; corner++) {
      const sides = axes.map((axis, i) => (
        times(axis, (half[i] + grown) * (corner >> i & 1 ? 1 : -1))
      ));
      addPoint(mesh, plus(centre, ...sides));
    }
    addTriangles(mesh, [
      [0, 1, 3], [0, 3, 2], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
      [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 3, 7], [1, 7, 5],
    ]);
  } else {
    const { normal, offset } = solid["half-space"];
    const [axis, length] = [unit(normal), Math.hypot(...normal)];
    const [u, v] = across(axis);
    const middle = times(axis, offset / length + grown);
    for (const [s, t] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
      addPoint(mesh, plus(middle, times(u, s * 1.2), times(v, t * 1.2)));
    }
    addTriangles(mesh, [[0, 1, 2], [0, 2, 3]]);
  }
  return mesh;
}

function trace(name, mesh, color, opacity) {
  return {
    type: "mesh3d", name, ...mesh, color, opacity, hoverinfo: "name", flatshading: false,
    lighting: { ambient: 0.65, diffuse: 0.6, specular: 0.1 },
  };
}

// Returns what is swept at a few times, among them the last.
function few(all) {
  const stride = Math.max(1, Math.ceil(all.length / SHOWN));
  return all.filter((_, k) => (all.length - 1 - k) % stride === 0).flatMap(({ swept }) => swept);
}

// Returns what is drawn at a time.
function traces(frame) {
  const inPair = (_, k) => data.link.includes(k);
  const notInPair = (_, k) => !data.link.includes(k);
  const { nominal, swept, closest, time } = frame;
  const isStop = data.stop.includes(frame);
  const [blue, red, grey] = isDark.matches
    ? ["#6ea8ff", "#ff6b62", "#aab4c0"] : ["#1f5fa8", "#c62828", "#808890"];
  const shown = [
    trace("nominal motion", capsules(nominal.filter(notInPair)), blue, 1),
    trace("link of the closest pair", capsules(nominal.filter(inPair)), red, 1),
    trace(isStop ? "the worst stop" : "all motions of the model", capsules(swept),
      isStop ? ORANGE : grey, 0.25),
  ];
  if (closest.length) shown.push(trace("closest motion", capsules(closest), red, 0.45));
  if (element("whole").checked) {
    shown.push(trace("the whole motion", capsules(few(data.frames)), grey, 0.1));
  }
  const stopped = element("stopped");
  if (stopped && stopped.checked) {
    shown.push(trace("the worst stop", capsules(few(data.stop)), ORANGE, 0.1));
  }
  for (const obstacle of data.obstacles) {
    const isClosest = obstacle.name === data.obstacle;
    const mesh = obstacleMesh(obstacle, time);
    shown.push(trace(obstacle.name, mesh, isClosest ? red : "#9a6b3f", isClosest ? 0.6 : 0.5));
  }
  return shown;
}

function draw() {
  const frame = frames[Number(element("slider").value)];
  const when = data.stop.includes(frame) ? " in the worst stop" : "";
  element("time").textContent = `${frame.time.toFixed(3)} s${when}`;
  const [ink, soft, line] = ["--ink", "--soft", "--line"].map(css);
  const axis = title => ({ title: { text: title }, color: ink, gridcolor: line });
  const layout = {
    margin: { l: 0, r: 0, t: 0, b: 0 }, showlegend: false, uirevision: "kept",
    paper_bgcolor: "rgba(0,0,0,0)", font: { color: ink },
    modebar: { bgcolor: "rgba(0,0,0,0)", color: soft, activecolor: ink },
    scene: {
      aspectmode: "data", uirevision: "kept",
      xaxis: axis("x [m]"), yaxis: axis("y [m]"), zaxis: axis("z [m]"),
    },
  };
  window.Plotly.react("scene", traces(frame), layout, { responsive: true, displaylogo: false });
}

function start() {
  const slider = element("slider");
  slider.max = frames.length - 1;
  slider.value = data.first;
  element("view").hidden = false;
  slider.addEventListener("input", draw);
  ["whole", "stopped"].map(element).forEach(box => box && box.addEventListener("change", draw));
  isDark.addEventListener("change", draw);
  draw();
  document.documentElement.dataset.ready = "yes";
}

async function readLibrary() {
  const binary = atob(element("library").textContent);
  const packed = new Blob([Uint8Array.from(binary, byte => byte.charCodeAt(0))]).stream();
  const text = packed.pipeThrough(new DecompressionStream("gzip"));
  const script = document.createElement("script");
  script.textContent = await new Response(text).text();
  document.head.append(script);
  start();
}

addEventListener("DOMContentLoaded", () => {
  if (data.frames.length) requestAnimationFrame(() => setTimeout(readLibrary));
});
