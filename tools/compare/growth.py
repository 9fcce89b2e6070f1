"""How time and memory grow with runs, suites, samples and joints, and a figure of it."""

import recordings
from measure import in_turn


def grown(reachtube, before, folder, root):
    """Measures `conform` of the linear model. Returns, for each quantity, its values and the costs
    now and before."""
    data = recordings.base(reachtube, root, folder)

    def costs(commands):
        found = []
        for arguments in commands:
            common = ["conform", "--torque", "compensated", *arguments, "--out", folder / "m.json"]
            old = before and [before, *common]
            found.append(in_turn([[reachtube, "--quiet", *common], old], rounds=2))
        return [own for own, _ in found], [old for _, old in found if old]

    def arm(robot, data, *more):
        return ["--robot", robot, "--data", data, *more]

    counts = [1, 3, 10, 30]
    runs = [recordings.copies(data, folder / f"few{n}", n, False) for n in counts]
    suites = [recordings.copies(data, folder / f"many{n}", n, True) for n in counts]
    times = [0.5, 1.0, 2.0, 4.0]
    joints = [2, 3, 4, 6, 8, 10]
    arms = [recordings.arm(n, folder) for n in joints]
    return {
        "runs, in 4 suites": ([73 * n for n in counts], costs(arm("lwa4p", of) for of in runs)),
        "suites, of 18 runs": ([4 * n for n in counts], costs(arm("lwa4p", of) for of in suites)),
        "samples of a run, of 2,190 runs": (
            [250 * t for t in times],
            costs(arm("lwa4p", runs[-1], "--until", str(t)) for t in times),
        ),
        "joints, of 16 runs": (joints, costs(arm(*of) for of in arms)),
    }


def draw(found, path):
    """Draws time and memory over each quantity."""
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    matplotlib.rcParams["svg.hashsalt"] = "reachtube"
    figure, axes = pyplot.subplots(2, len(found), figsize=(11, 5), sharey="row")
    for column, (quantity, (values, (own, old))) in zip(axes.T, found.items()):
        for axis, cost in zip(column, ("cpu", "memory")):
            for costs, label, style in [(old, "before", "o:"), (own, "now", "o-")]:
                if costs:
                    axis.plot(values, [getattr(c, cost) for c in costs], style, label=label)
            axis.set_ylim(bottom=0)
            axis.grid(alpha=0.3)
        column[1].set_xlabel(quantity)
    axes[0, 0].set_ylabel("processor time [s]")
    axes[1, 0].set_ylabel("memory [MB]")
    axes[0, 0].legend()
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
    print(f"\nwrote {path}")
