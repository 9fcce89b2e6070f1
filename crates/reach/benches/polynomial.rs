//! Benchmarks of the reachable sets of polynomial systems: a six-joint arm over 5 s at 250 Hz, and
//! problems of the ARCH competition, with their final widths.

#[path = "../tests/reach/arm.rs"]
mod arm;
#[path = "../tests/reach/lwa4p.rs"]
mod lwa4p;
#[path = "../tests/reach/systems.rs"]
#[allow(dead_code)]
mod systems;

use std::time::Instant;

use divan::{Bencher, black_box};
use reachtube_reach::{
    AutomaticFlowpipe, Flowpipe, FlowpipeMethod, FlowpipeSettings, Hyperrectangle,
    PolynomialSystem, TimeGrid, UncertainInput,
};

const SAMPLES: usize = 1251;

fn main() {
    print_widths();
    print_choices();
    divan::main();
}

/// The model has 12 states and 6 inputs; the sets come from the paper, the measured input is 0.
#[divan::bench(args = [None, Some(60)])]
fn lwa4p_model_1_of_order_3(bencher: Bencher, order: Option<usize>) {
    let (system, grid) = (lwa4p::model1(), TimeGrid::uniform(0.004, SAMPLES));
    let (initial, torque) = lwa4p::table2(1.0);
    let held = vec![0.0; 6 * SAMPLES];
    let input = UncertainInput { measured: &held, set: &torque };
    let settings = FlowpipeSettings { order, ..FlowpipeSettings::default() };
    bencher.bench(|| {
        Flowpipe::new(black_box(&system), &grid, &[0.0; 12], &initial, &input, &settings)
    });
}

/// A published problem: its name, system, initial set, step (s) and number of samples, and
/// settings.
type Problem = (String, PolynomialSystem, Hyperrectangle, (f64, usize), FlowpipeSettings);

fn in_pieces(pieces: &[usize]) -> FlowpipeSettings {
    FlowpipeSettings { pieces: pieces.to_vec(), ..FlowpipeSettings::default() }
}

fn taylor_models(order: u32) -> FlowpipeSettings {
    FlowpipeSettings {
        method: FlowpipeMethod::TaylorModels { order },
        ..FlowpipeSettings::default()
    }
}

fn problems() -> Vec<Problem> {
    let name = |problem: &str, settings: &FlowpipeSettings| {
        format!("{problem}, {:?} {:?}", settings.method, settings.pieces)
    };
    let van_der_pol = |settings| {
        let start = Hyperrectangle { centre: vec![1.4, 2.4], radius: vec![0.15, 0.05] };
        (name("Van der Pol", &settings), systems::van_der_pol(), start, (0.01, 701), settings)
    };
    let laub_loomis = |w: f64, settings| {
        let start = Hyperrectangle {
            centre: vec![1.2, 1.05, 1.5, 2.4, 1.0, 0.1, 0.45],
            radius: vec![w; 7],
        };
        let name = name(&format!("Laub-Loomis {w}"), &settings);
        (name, systems::laub_loomis(), start, (0.02, 1001), settings)
    };
    vec![
        van_der_pol(in_pieces(&[6, 3])),
        van_der_pol(in_pieces(&[16, 8])),
        van_der_pol(taylor_models(6)),
        van_der_pol(taylor_models(8)),
        laub_loomis(0.01, in_pieces(&[])),
        laub_loomis(0.01, taylor_models(3)),
        laub_loomis(0.05, in_pieces(&[])),
        laub_loomis(0.05, taylor_models(3)),
        laub_loomis(0.05, taylor_models(4)),
        laub_loomis(0.1, in_pieces(&[1, 1, 2, 2, 1, 1, 1])),
        laub_loomis(0.1, in_pieces(&[2, 2, 2, 2, 2, 1, 2])),
        laub_loomis(0.1, taylor_models(4)),
        laub_loomis(0.1, taylor_models(5)),
    ]
}

fn solve((_, system, start, (step, samples), settings): &Problem) -> Flowpipe {
    let none = Hyperrectangle::zero(0);
    let input = UncertainInput { measured: &[], set: &none };
    let zero = vec![0.0; start.dimension()];
    Flowpipe::new(system, &TimeGrid::uniform(*step, *samples), &zero, start, &input, settings)
        .expect("sizes fit")
}

fn print_widths() {
    for problem in problems() {
        let flowpipe = solve(&problem);
        let end = flowpipe.sample(flowpipe.len() - 1);
        let sides: Vec<String> =
            end.iter().map(|x| format!("[{:.4}, {:.4}]", x.lo(), x.hi())).collect();
        println!("{}: {:?}, {}", problem.0, flowpipe.outcome(), sides.join(" x "));
    }
}

#[divan::bench(args = 0..problems().len())]
fn published(bencher: Bencher, which: usize) {
    let problem = &problems()[which];
    bencher.bench(|| solve(black_box(problem)));
}

/// A problem without settings: its name, system, initial set, step (s) and number of samples.
type Open = (&'static str, PolynomialSystem, Hyperrectangle, (f64, usize));

fn open_problems() -> Vec<Open> {
    let set = |centre: &[f64], radius: &[f64]| Hyperrectangle {
        centre: centre.to_vec(),
        radius: radius.to_vec(),
    };
    let laub_loomis = |w: f64| {
        let start = set(&[1.2, 1.05, 1.5, 2.4, 1.0, 0.1, 0.45], &[w; 7]);
        ("Laub-Loomis", systems::laub_loomis(), start, (0.02, 1001))
    };
    let production = || set(&[9.75, 0.01, 0.01, 0.09308], &[0.25, 0.0, 0.0, 0.00218]);
    let coupled = set(&[1.4, 2.4, 1.4, 2.4, 70.0], &[0.15, 0.05, 0.15, 0.05, 10.0]);
    vec![
        ("Van der Pol", systems::van_der_pol(), set(&[1.4, 2.4], &[0.15, 0.05]), (0.01, 701)),
        laub_loomis(0.01),
        laub_loomis(0.05),
        laub_loomis(0.1),
        ("Production-destruction", systems::production_destruction(), production(), (0.05, 2001)),
        ("Production-destruction", systems::production_destruction(), production(), (1.0, 101)),
        ("Coupled Van der Pol", systems::coupled_van_der_pol(), coupled, (0.01, 701)),
    ]
}

fn find((_, system, start, (step, samples)): &Open) -> AutomaticFlowpipe {
    let none = Hyperrectangle::zero(0);
    let input = UncertainInput { measured: &[], set: &none };
    let zero = vec![0.0; start.dimension()];
    Flowpipe::automatic(system, &TimeGrid::uniform(*step, *samples), &zero, start, &input)
        .expect("sizes fit")
}

fn print_choices() {
    for problem in open_problems() {
        let begin = Instant::now();
        let found = find(&problem);
        let time = begin.elapsed().as_secs_f64();
        let (flowpipe, settings) = (&found.flowpipe, &found.settings);
        let end = flowpipe.sample(flowpipe.len() - 1);
        let widths: Vec<String> = end.iter().map(|x| format!("{:.4}", x.width())).collect();
        println!(
            "{} {:?}: {:?} {:?}, {} parts, {:?} in {time:.2} s, widths {}",
            problem.0,
            problem.2.radius,
            settings.method,
            settings.pieces,
            found.parts,
            flowpipe.outcome(),
            widths.join(" ")
        );
    }
}

#[divan::bench(args = 0..open_problems().len() - 1)]
fn automatic(bencher: Bencher, which: usize) {
    let problem = &open_problems()[which];
    bencher.bench(|| find(black_box(problem)));
}
