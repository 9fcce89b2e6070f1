//! Matrices, sets and inputs in the languages of CORA, HyLAA and JuliaReach.

use reachtube::export::{ExportCase, InputForm, Tool};

use crate::cases::{MODELS, in_clean_clones, lwa4p, recorded, text};
use crate::reader::{assert_bits, between, number, numbers_between};

/// How a language writes a vector or a matrix, and a number.
struct Language {
    tool: Tool,
    file: &'static str,
    /// The start and end of the values of a name.
    values: fn(&str) -> [String; 2],
    /// The start and end of the rows of a matrix.
    matrix: fn(&str) -> [String; 2],
    names: [&'static str; 5],
}

const SETS: [&str; 5] = ["x_start", "X0_centre", "X0_radius", "U_centre", "U_radius"];

const LANGUAGES: [Language; 3] = [
    Language {
        tool: Tool::Cora,
        file: "cora_data.m",
        values: |name| [format!("data.{name} = ["), "];".into()],
        matrix: |name| [format!("data.{name} = ["), "\n];".into()],
        names: SETS,
    },
    Language {
        tool: Tool::HyLaa,
        file: "hylaa_reach.py",
        values: |name| [format!("\n{name} = ["), "]\n".into()],
        matrix: |name| [format!("\n{name} = np.array(["), "\n])".into()],
        names: ["X_START", "X0_CENTRE", "X0_RADIUS", "U_CENTRE", "U_RADIUS"],
    },
    Language {
        tool: Tool::JuliaReach,
        file: "juliareach.jl",
        values: |name| [format!("\n{name} = ["), "]\n".into()],
        matrix: |name| [format!("\n{name} = ["), "\n]".into()],
        names: SETS,
    },
];

#[test]
fn matrices_and_sets_have_every_bit() {
    in_clean_clones().iter().for_each(read_back);
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn recorded_matrices_and_sets_have_every_bit() {
    recorded().iter().for_each(read_back);
}

fn read_back(case: &ExportCase) {
    for language in LANGUAGES {
        for form in [InputForm::Recorded, InputForm::Deviation, InputForm::Range] {
            if language.tool.check(case, form).is_ok() {
                language.read_back(case, form);
            }
        }
    }
}

impl Language {
    fn read_back(&self, case: &ExportCase, form: InputForm) {
        let text = text(case, self.tool, form, self.file);
        let read = |[start, end]: [String; 2]| numbers_between(&text, &start, &end);
        let (initial, inputs) = (case.initial_state(form), case.input_set(form));
        let sets = [
            &initial.start,
            &initial.set.centre,
            &initial.set.radius,
            &inputs.centre,
            &inputs.radius,
        ];
        for (name, written) in self.names.iter().zip(sets) {
            assert_bits(&read((self.values)(name)), written, name);
        }
        if let Some(system) = &case.system.linear {
            for (name, matrix) in [("A", system.a()), ("B", system.b())] {
                assert_bits(&read((self.matrix)(name)), matrix.transpose().as_slice(), name);
            }
        }
        if self.tool == Tool::Cora && form == InputForm::Recorded {
            let held = &case.inputs[..case.steps() * case.joints()];
            assert_bits(&numbers_between(&text, "data.u = [", "]';"), held, "u");
        }
    }
}

#[test]
fn horizon_step_and_start_are_those_of_the_recording() {
    let case = lwa4p(MODELS[0]);
    let text = text(&case, Tool::Cora, InputForm::Deviation, "cora_data.m");
    let value = |name: &str| number(between(&text, &format!("data.{name} = "), ";"));
    assert_eq!([value("step"), value("steps"), value("horizon")], [0.004, 3.0, 0.012]);
    assert_eq!(case.initial_state(InputForm::Deviation).start, vec![0.0; 12]);
    assert_eq!(case.initial_state(InputForm::Recorded).start, case.start);
}

#[test]
fn sines_start_around_those_of_the_angles() {
    let case = lwa4p(MODELS[2]);
    let bounds = case.initial_state(InputForm::Recorded).bounds();
    for j in 0..6 {
        for q in [bounds[j].lo(), bounds[j].mid(), bounds[j].hi()] {
            let sides = [(bounds[12 + j], q.sin()), (bounds[18 + j], q.cos())];
            assert!(sides.iter().all(|(side, value)| side.lo() <= *value && *value <= side.hi()));
        }
        assert!(bounds[12 + j].width() <= 1.001 * bounds[j].width() + 1e-15);
    }
}

#[test]
fn the_range_holds_every_input() {
    let case = lwa4p(MODELS[0]);
    let (range, u) = (case.input_set(InputForm::Range), &case.sets.input_set);
    for k in 0..case.steps() {
        for (j, value) in case.input(k).iter().enumerate() {
            for disturbance in [u.centre[j] - u.radius[j], u.centre[j] + u.radius[j]] {
                let distance = (value + disturbance - range.centre[j]).abs();
                assert!(distance <= range.radius[j] * (1.0 + 1e-15));
            }
        }
    }
}
