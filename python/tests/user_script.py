"""A script of a user, whose types mypy checks strictly."""

import numpy as np

import reachtube as rt


def main() -> None:
    robot = rt.Robot.lwa4p()
    t = np.linspace(0.0, 0.1, 26)
    still = np.zeros((26, robot.joints), dtype=np.float32)
    data = rt.Recordings([rt.Run(t, still, still, robot.gravity(still), suite="A")])
    model: rt.Model = rt.conform(robot, data, torque="motor", notion="hull")
    radius: float = float(model.initial_set.radius.max())
    verdict: rt.Check = rt.check(model, data)
    sets: list[rt.ReachableSet] = rt.reach(model, data)
    built: rt.BuiltModel = rt.model(
        robot, ["logs"], "motor", horizon=0.2, gains=[1.0] * 6, fit=["inertia"]
    )
    ratios: list[float | None] = [row.ratio for row in built.joints]
    windows: rt.Recordings = rt.prepare(robot, "logs", window=0.5, compensate=True)
    print(built.held_out.outside, built.model.check("logs"), ratios, len(windows))
    q, qd = rt.variables("q qd")
    pipe: rt.Flowpipe = rt.flowpipe({q: qd, qd: -rt.sin(q)}, {q: 1.0, qd: (0.0, 0.1)}, t)
    print(verdict.conformant, radius, sets[0].upper.shape, pipe.is_reached)
    brakes = {"torque": [[40.0, 60.0]] * 6, "delay": [0.01, 0.03]}
    study: rt.StopStudy = rt.stop(model, data, brakes, category=0)
    ways: list[float] = [row.way for row in study.stops]
    answer: rt.Verification = rt.verify("cell.toml")
    smallest: float = min(pair.distance for one in answer.motions for pair in one.clearances)
    print(bool(study), ways, smallest, [str(finding) for finding in answer.findings])
    try:
        rt.Model.load("none.json")
    except rt.DefectsError as error:
        print([defect.line for defect in error.defects])
    except rt.ReachtubeError as error:
        print(error)


if __name__ == "__main__":
    main()
