"use strict";
// Numbers of the figures: packed arrays are read, and lines thinned to what a plot can show.

const element = id => document.getElementById(id);
const all = (selector, within = document) => [...within.querySelectorAll(selector)];

function bytes(text) {
  const binary = atob(text);
  const read = new Uint8Array(binary.length);
  for (let k = 0; k < read.length; k++) read[k] = binary.charCodeAt(k);
  return read.buffer;
}

// Reads a line that is stored as 16-bit differences of multiples of a step.
function unpack({ base, step, deltas }) {
  const differences = new Int16Array(bytes(deltas));
  const values = new Float64Array(differences.length);
  let at = 0;
  for (let k = 0; k < values.length; k++) {
    at += differences[k];
    values[k] = base + step * at;
  }
  return values;
}

const suites = [];

// Reads the numbers of a suite when it is first shown.
function readSuite(index) {
  if (suites[index]) return suites[index];
  const data = JSON.parse(element(`data-${index}`).textContent);
  const times = new Float64Array(bytes(data.times));
  const nominal = data.nominal && data.nominal.map(unpack);
  const edge = rows => rows.map(row => new Float32Array(bytes(row)));
  const bands = data.bands.map(({ label, lower, upper }) => (
    { label, lower: edge(lower), upper: edge(upper) }
  ));
  const shared = data.run_times ? new Float64Array(bytes(data.run_times)) : times;
  const runs = data.runs.map(run => {
    const states = run.states.map(unpack);
    const own = run.times ? new Float64Array(bytes(run.times)) : shared;
    return { ...run, states, times: own.subarray(0, states[0].length) };
  });
  suites[index] = { ...data, times, nominal, bands, runs };
  return suites[index];
}

// Returns the first index whose time is not below t.
function firstFrom(times, t) {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < t) low = middle + 1; else high = middle;
  }
  return low;
}

// Returns the value of a line at a time; beyond its ends, the value at the end. The bounds of a
// column hold from its time to the next one.
function valueAt(times, values, t, columns = false) {
  const after = firstFrom(times, t);
  if (after === 0 || after >= values.length) return values[Math.min(after, values.length - 1)];
  if (times[after] === t) return values[after];
  if (columns) return values[after - 1];
  const part = (t - times[after - 1]) / (times[after] - times[after - 1]);
  return values[after - 1] + (values[after] - values[after - 1]) * part;
}

// Returns the line of a run in a view: the state, or the state minus the nominal motion.
function runLine(suite, run, state, view) {
  const values = run.states[state];
  if (view === "motion" || !suite.nominal) return values;
  const nominal = suite.nominal[state];
  const isShared = run.times.buffer === suite.times.buffer;
  const at = k => (isShared ? nominal[k] : valueAt(suite.times, nominal, run.times[k]));
  return values.map((x, k) => x - at(k));
}

// Returns an edge of a band in a view.
function edgeLine(suite, edge, state, view) {
  const deviations = edge[state];
  if (view === "deviation" || !suite.nominal) return deviations;
  return suite.nominal[state].map((x, k) => x + deviations[k]);
}

// Returns how far a deviation is inside the outer band; negative outside.
function distance(suite, state, t, deviation) {
  const { lower, upper } = suite.bands[0];
  const at = edge => valueAt(suite.times, edge[state], t, suite.columns);
  return Math.min(deviation - at(lower), at(upper) - deviation);
}

// Returns the indices of the samples to draw between two times: in each of a number of columns
// the lowest and the highest, so that no peak is lost; all where they are few. One sample beyond
// each end lets the line leave the plot.
function thin(times, values, [from, to], columns) {
  const first = Math.max(0, firstFrom(times, from) - 1);
  const last = Math.min(values.length, firstFrom(times, to) + 2) - 1;
  const kept = [];
  if (last - first < 3 * columns) {
    for (let k = first; k <= last; k++) kept.push(k);
    return kept;
  }
  const column = k => Math.floor(columns * (times[k] - from) / (to - from));
  for (let k = first; k <= last;) {
    let [low, high, end] = [k, k, k];
    for (; end <= last && column(end) === column(k); end++) {
      if (values[end] < values[low]) low = end;
      if (values[end] > values[high]) high = end;
    }
    if (k === first) kept.push(k);
    kept.push(Math.min(low, high), Math.max(low, high));
    k = end;
  }
  kept.push(last);
  return kept.filter((k, place) => k !== kept[place - 1]);
}
