//! The reachable set of the Van der Pol oscillator, with settings that are found by trial.

use reachtube::scalar::{Interval, TaylorPolynomial, TaylorSpace};
use reachtube::{Flowpipe, Hyperrectangle, PolynomialSystem, TimeGrid, UncertainInput};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // ẋ = y, ẏ = (1 - x²) y - x from [1.25, 1.55] x [2.35, 2.45] over 7 s.
    let space = TaylorSpace::new(2, 3)?;
    let [x, y] = [0, 1].map(|i| TaylorPolynomial::<Interval>::variable(&space, i));
    let field = [y.clone(), y.clone() - &(&x * &x) * &y - x.clone()];
    let system = PolynomialSystem::new(2, 0, &field)?;
    let start = Hyperrectangle { centre: vec![0.0; 2], radius: vec![0.15, 0.05] };
    let none = Hyperrectangle::zero(0);
    let input = UncertainInput { measured: &[], set: &none };
    let grid = TimeGrid::uniform(0.01, 701);
    let found = Flowpipe::automatic(&system, &grid, &[1.4, 2.4], &start, &input)?;
    println!("chosen: {:?}, {} parts of each step", found.settings.method, found.parts);
    let flowpipe = found.flowpipe;
    for k in (0..flowpipe.len()).step_by(100) {
        let [x, y] = [0, 1].map(|i| flowpipe.sample(k)[i]);
        println!(
            "t = {:.1} s: x in [{:.4}, {:.4}], y in [{:.4}, {:.4}]",
            grid.times()[k],
            x.lo(),
            x.hi(),
            y.lo(),
            y.hi()
        );
    }
    Ok(())
}
