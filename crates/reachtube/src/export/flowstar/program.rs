//! A C++ program for Flow*'s library: one step from each sample to the next, under the input that
//! is held there.

use std::fmt::Write;

use reachtube_scalar::Interval;

use crate::export::InputForm;
use crate::export::case::{ExportCase, bounds};
use crate::export::text::{number, numbers, terms};

/// Number of terms on one line.
const TERMS_PER_LINE: usize = 4;

/// The text before the numbers.
const HEAD: &str = r#"//
// Build beside the library, the folder flowstar-toolbox of its repository, and run here:
//   g++ -O2 -std=c++11 -I TOOLBOX flowstar.cpp -L TOOLBOX -lflowstar -lmpfr -lgmp -lgsl \
//     -lgslcblas -lm -lglpk -o flowstar_reach && ./flowstar_reach
#include "Continuous.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

using namespace flowstar;

"#;

/// The text after the numbers.
const PROGRAM: &str = r#"
// The order of the Taylor models, and the factor by which a remainder estimate that does not
// contain itself grows.
const unsigned int ORDER = 3;
const double GROWTH = 2.0;
const int ATTEMPTS = 60;

typedef std::map<std::string, double> Row;

std::vector<Row> our_bounds() {
  std::ifstream file("bounds.csv");
  std::string line, cell;
  std::getline(file, line);
  std::vector<std::string> names;
  for (std::stringstream head(line); std::getline(head, cell, ',');) names.push_back(cell);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    Row row;
    std::stringstream cells(line);
    for (size_t i = 0; std::getline(cells, cell, ','); ++i) row[names[i]] = std::stod(cell);
    rows.push_back(row);
  }
  return rows;
}

// The inputs over the step after sample k, as Flow* reads an interval.
std::vector<std::string> inputs(size_t k) {
  std::vector<std::string> texts;
  for (size_t j = 0; j < JOINTS; ++j) {
    Interval held(INPUTS[k % (sizeof INPUTS / sizeof *INPUTS)][j]);
    Interval side = held + Interval(U[j][0], U[j][1]);
    char text[80];
    std::snprintf(text, sizeof text, "[%.17g , %.17g]", side.inf(), side.sup());
    texts.push_back(text);
  }
  return texts;
}

// Steps over `time` seconds; the estimate grows until a remainder contains itself.
bool step(Flowpipe &set, const ODE<Interval> &ode, Variables &states, double time,
          double &estimate, std::vector<Interval> &box) {
  for (int attempt = 0; attempt < ATTEMPTS; ++attempt, estimate *= GROWTH) {
    Computational_Setting setting(states);
    setting.setFixedStepsize(time, ORDER);
    setting.setCutoffThreshold(1e-12);
    setting.printOff();
    setting.setRemainderEstimation(
        std::vector<Interval>(STATES.size(), Interval(-estimate, estimate)));
    Result_of_Reachability result;
    // Flow* begins at its threshold, so that this is one step.
    ode.reach(result, set, time + THRESHOLD_HIGH, setting, std::vector<Constraint>());
    if (!result.isCompleted()) continue;
    set = result.fp_end_of_time;
    set.intEval(box, ORDER, setting.tm_setting.cutoff_threshold);
    return true;
  }
  return false;
}

int main() {
  std::vector<Row> ours = our_bounds();
  Variables states;
  for (size_t i = 0; i < STATES.size(); ++i) states.declareVar(STATES[i]);
  std::vector<Interval> box;
  for (size_t i = 0; i < STATES.size(); ++i) box.push_back(Interval(X0[i][0], X0[i][1]));
  Flowpipe set(box);
  std::ofstream table("flowstar_bounds.csv");
  table.precision(17);
  table << "t";
  for (size_t i = 0; i < 2 * JOINTS; ++i)
    table << "," << STATES[i] << "_lower," << STATES[i] << "_upper";
  table << "\n";
  double estimate = 1e-4, outside = 0.0, ratio = 0.0;
  size_t steps = sizeof TIMES / sizeof *TIMES - 1, done = 0;
  for (bool lost = false; !lost && done < steps; ) {
    ODE<Interval> ode(rates(inputs(done)), states);
    lost = !step(set, ode, states, TIMES[done + 1] - TIMES[done], estimate, box);
    if (lost) break;
    ++done;
    table << TIMES[done];
    for (size_t i = 0; i < 2 * JOINTS; ++i) {
      table << "," << box[i].inf() << "," << box[i].sup();
      if (done >= ours.size()) continue;
      double low = ours[done][STATES[i] + "_lower"], high = ours[done][STATES[i] + "_upper"];
      double width = std::max(high - low, 1e-12);
      outside = std::max({outside, (box[i].inf() - low) / width, (high - box[i].sup()) / width});
      ratio = std::max(ratio, box[i].width() / width);
    }
    table << "\n";
  }
  std::printf("wrote flowstar_bounds.csv: %zu of %zu steps; bounds.csv is at most %.3g widths "
              "outside, and the sets are at most %.4g times as wide\n",
              done, steps, outside, ratio);
  return done == steps ? 0 : 1;
}
"#;

pub(super) fn stepping(case: &ExportCase, form: InputForm) -> String {
    let names: Vec<String> = case.system.states.iter().map(|name| format!("\"{name}\"")).collect();
    let sides = |name: &str, sides: Vec<Interval>| {
        let side =
            |side: &Interval| format!("  {{{}, {}}},\n", number(side.lo()), number(side.hi()));
        format!(
            "const double {name}[][2] = {{\n{}}};\n",
            sides.iter().map(side).collect::<String>()
        )
    };
    // Where the input may be anything in a box, the box is U and nothing is held.
    let held: Vec<Vec<f64>> = match form {
        InputForm::Recorded => (0..case.steps()).map(|k| case.input(k).to_vec()).collect(),
        _ => vec![vec![0.0; case.joints()]],
    };
    let row = |row: &Vec<f64>| format!("  {{{}}},\n", numbers(row.iter().copied(), ", "));
    let mut text = format!(
        "{HEAD}const size_t JOINTS = {};\nconst std::vector<std::string> STATES = {{{}}};\n\
         // Bounds of the states at the first sample, and of what is added to the held input.\n",
        case.joints(),
        names.join(", "),
    );
    text += &sides("X0", case.initial_state(form).bounds());
    text += &sides("U", bounds(&case.input_set(form)));
    let _ = write!(
        text,
        "const double TIMES[] = {{{}}};\n// The input that is held from each sample to the \
         next.\nconst double INPUTS[][JOINTS] = {{\n{}}};\n\n",
        numbers(case.grid.times().iter().copied(), ", "),
        held.iter().map(row).collect::<String>(),
    );
    text + &rates(case) + PROGRAM
}

/// Returns the function that gives the derivatives of the states as texts that Flow* parses.
fn rates(case: &ExportCase) -> String {
    let system = &case.system;
    let name = |variable: usize| match variable.checked_sub(system.dimension()) {
        None => system.states[variable].clone(),
        Some(j) => format!("\" + u[{j}] + \""),
    };
    let mut text = String::from(
        "std::vector<std::string> rates(const std::vector<std::string> &u) {\n  return {\n",
    );
    for rate in &system.rates {
        let terms = terms(rate, &name);
        let lines: Vec<String> =
            terms.chunks(TERMS_PER_LINE).map(|chunk| format!("\"{} \"", chunk.join(" "))).collect();
        let sum = if lines.is_empty() { "\"0.0\"".into() } else { lines.join("\n      ") };
        // Nothing stands before the first plus.
        let sum = sum.strip_prefix("\"+ ").map_or(sum.clone(), |rest| format!("\"{rest}"));
        let _ = writeln!(text, "    {sum},");
    }
    text + "  };\n}\n"
}
