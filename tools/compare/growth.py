"""How time and memory grow with runs, suites, samples and joints, and a figure of it."""

import recordings
from measure import in_turn


def grown(builds, folder, root, rounds):
    """Measures `conform` of the linear model. Returns, for each quantity, its values and the costs
    of each build by its name."""
    data = recordings.base(builds[-1].command, root, folder)

    def costs(commands):
        commands = list(commands)
        common = ["conform", "--torque", "compensated", "--out", folder / "m.json"]
        rows = [in_turn([[b.command, *common, *of] for b in builds], rounds) for of in commands]
        return {build.name: column for build, column in zip(builds, zip(*rows))}

    def lwa4p(data, *more):
        return ["--robot", "lwa4p", "--data", data, *more]

    runs = [10, 30, 73, 219, 730, 2190]
    sets = [recordings.runs_of(data, folder / f"runs{n}", n) for n in runs]
    copies = [1, 3, 10, 30]
    split = [recordings.suites_of(data, folder / f"many{n}", n) for n in copies]
    times = [0.5, 1.0, 2.0, 3.0, 4.0]
    joints = [1, 2, 3, 4, 5, 6, 7]
    arms = [recordings.arm(n, folder) for n in joints]
    return {
        "runs, in 4 suites": (runs, costs(lwa4p(of) for of in sets)),
        "suites, of 18 runs": ([4 * n for n in copies], costs(lwa4p(of) for of in split)),
        "samples of a run, of 2,190": (
            [250 * t for t in times],
            costs(lwa4p(sets[-1], "--until", str(t)) for t in times),
        ),
        "joints, of 16 runs": (
            joints, costs(["--robot", robot, "--data", of] for robot, of in arms)
        ),
    }


def draw(found, path):
    """Draws time and memory over each quantity, and prints them."""
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    matplotlib.rcParams["svg.hashsalt"] = "reachtube"
    figure, axes = pyplot.subplots(2, len(found), figsize=(11, 5))
    for column, (quantity, (values, builds)) in zip(axes.T, found.items()):
        for axis, cost in zip(column, ("cpu", "memory")):
            for at, (name, costs) in enumerate(builds.items()):
                known = [(v, getattr(c, cost)) for v, c in zip(values, costs) if c]
                style = "o-" if at + 1 == len(builds) else "o:"
                axis.plot(*zip(*known), style, label=name, markersize=3)
            axis.set_ylim(bottom=0)
            axis.set_xlim(left=0)
            axis.grid(alpha=0.3)
        column[1].set_xlabel(quantity)
        print_costs(quantity, values, builds)
    axes[0, 0].set_ylabel("processor time [s]")
    axes[1, 0].set_ylabel("memory [MB]")
    axes[0, 0].legend()
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
    print(f"\nwrote {path}")


def print_costs(quantity, values, builds):
    """Prints a table of one quantity."""
    print(f"\n| {quantity} | {' | '.join(builds)} |\n|{'---|' * (len(builds) + 1)}")
    for value, *costs in zip(values, *builds.values()):
        print(f"| {value:g} | {' | '.join(str(cost or '-') for cost in costs)} |", flush=True)
