//! HyLAA 2, in Python: a script that computes the bounds of each state at each sample.

use super::case::ExportCase;
use super::meaning::Meaning;
use super::text::{comment, number, numbers, rows};
use super::{ExportFile, InputForm, Tool};

/// The text after the numbers. HyLAA has no drift: it is a state `one` that stays 1.
const PROGRAM: &str = r#"

def automaton():
    """Return the mode of the system, ready to step, and its initial set."""
    a, b, start = A, B, [(x + c - r, x + c + r) for x, c, r in zip(X_START, X0_CENTRE, X0_RADIUS)]
    if DRIFT.any():
        a = np.block([[A, DRIFT[:, None]], [np.zeros((1, len(A) + 1))]])
        b = np.vstack([B, np.zeros(B.shape[1])])
        start.append((1.0, 1.0))
    mode = HybridAutomaton().new_mode("motion")
    mode.set_dynamics(a)
    inputs = range(len(U_CENTRE))
    sides = [[sign * float(i == j) for j in inputs] for i in inputs for sign in (1, -1)]
    limits = [r + sign * c for c, r in zip(U_CENTRE, U_RADIUS) for sign in (1, -1)]
    mode.set_inputs(b, sides, limits, allow_constants=True)
    state = StateSet(lputil.from_box(start, mode), mode)
    mode.init_time_elapse(STEP)
    return state


def reach(steps=STEPS, stride=1):
    """Yield the sample and the lower and upper bounds of the states, at every stride-th sample."""
    state = automaton()
    for k in range(0, steps + 1, stride):
        state.step(k)
        lp, states = state.lpi, range(len(A))
        direction = np.eye(lp.dims)

        def least(vector):
            return lp.minimize(vector, columns=[lp.cur_vars_offset + i for i in range(lp.dims)])

        lower = [least(direction[i])[i] for i in states]
        upper = [least(-direction[i])[i] for i in states]
        yield k, np.array(lower), np.array(upper)


def main():
    """Write hylaa_bounds.csv and compare with bounds.csv."""
    stride = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    with open("bounds.csv", newline="") as file:
        ours = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    worst = 0.0
    with open("hylaa_bounds.csv", "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["t"] + [f"{name}_{end}" for name in STATES for end in ("lower", "upper")])
        for k, lower, upper in reach(min(STEPS, len(ours) - 1), stride):
            if DEVIATION:
                nominal = np.array([ours[k][f"{name}_nominal"] for name in STATES])
                lower, upper = nominal + lower, nominal + upper
            table.writerow([k * STEP] + [x for pair in zip(lower, upper) for x in pair])
            for i, name in enumerate(STATES):
                low, high = ours[k][f"{name}_lower"], ours[k][f"{name}_upper"]
                width = max(high - low, 1e-12)
                worst = max(worst, abs(lower[i] - low) / width, abs(upper[i] - high) / width)
    print(f"wrote hylaa_bounds.csv; largest difference from bounds.csv: {worst:.3g} widths")


if __name__ == "__main__":
    main()
"#;

pub(super) fn files(case: &ExportCase, form: InputForm) -> Vec<ExportFile> {
    let Some(system) = &case.system.linear else { return Vec::new() };
    let lines = comment("", &Meaning::new(case, Tool::HyLaa, form).paragraphs);
    let (initial, inputs) = (case.initial_state(form), case.input_set(form));
    let list = |values: &[f64]| format!("[{}]", numbers(values.iter().copied(), ", "));
    let drift = match form {
        InputForm::Deviation => vec![0.0; system.states()],
        _ => system.drift().iter().copied().collect(),
    };
    let names: Vec<String> = case.system.states.iter().map(|name| format!("\"{name}\"")).collect();
    let text = format!(
        "\"\"\"{lines}\nRun: python hylaa_reach.py [stride]; a stride takes every stride-th \
         sample.\n\"\"\"\nimport csv\nimport sys\n\nimport numpy as np\nfrom hylaa import lputil\n\
         from hylaa.hybrid_automaton import HybridAutomaton\n\
         from hylaa.stateset import StateSet\n\n\
         STATES = [{}]\nDEVIATION = {}\nA = np.array([\n{}])\nB = np.array([\n{}])\n\
         DRIFT = np.array({})\nX_START = {}\nX0_CENTRE = {}\nX0_RADIUS = {}\nU_CENTRE = {}\n\
         U_RADIUS = {}\nSTEP = {}\nSTEPS = {}\n{PROGRAM}",
        names.join(", "),
        if form == InputForm::Deviation { "True" } else { "False" },
        rows(system.a(), ["[", ", ", "],"]),
        rows(system.b(), ["[", ", ", "],"]),
        list(&drift),
        list(&initial.start),
        list(&initial.set.centre),
        list(&initial.set.radius),
        list(&inputs.centre),
        list(&inputs.radius),
        number(case.step()),
        case.steps(),
    );
    vec![ExportFile::new("hylaa_reach.py", text)]
}
