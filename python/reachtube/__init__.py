"""Robot models that provably cover recordings.

Load a robot (`Robot`), and make a model of its logs in one call (`model`). Or open recordings
(`Recordings`), filter and cut them (`prepare`), find the smallest uncertainty sets for which a
model encloses them (`conform`), check other recordings (`check`), compute reachable sets (`reach`),
draw a page (`report`), enclose stops (`stop`), decide whether links stay clear of obstacles
(`verify`), and watch a running robot (`monitor`). `identify` makes the robot from
recordings, `excite` the motions for it, `abstract` models of any order, and `flowpipe` reachable
sets of your own system. `System` is a linear system that is seen through its outputs,
`TrackingModel` a model of an arm under its controller.
"""

from . import errors, fleet, io, plot
from ._abstraction import Abstraction, abstract
from ._box import Box
from ._built import BuiltModel, Choice, HeldOut, HorizonWidths, JointRow, model
from ._check import Check
from ._conform import check, conform
from ._excite import Excitation, excite
from ._findings import Finding, Report
from ._flowpipe import Flowpipe, flowpipe
from ._identify import Identification, identify
from ._model import Model
from ._monitor import Alarm, Leave, Monitor, monitor
from ._polynomial import Polynomial, cos, sin, variables
from ._prepare import prepare
from ._reach import ReachableSet, reach, report
from ._reachtube import version as _version
from ._recordings import Recordings, Run
from ._robot import Robot
from ._stop import AnnexRow, RecordedStop, StopStudy, WorstStop, stop
from ._system import System
from ._system_model import OutputTube, SystemCheck, SystemModel
from ._tracking import PlanTube, TrackingCheck, TrackingModel
from ._verify import (
    Clearance,
    Margin,
    MotionVerdict,
    StopTrigger,
    Verification,
    Witness,
    WitnessStop,
    verify,
)
from .errors import (
    Defect,
    DefectsError,
    ModelFileError,
    ReachtubeError,
    ReachtubeWarning,
    SettingError,
)

__version__ = _version()

__all__ = [
    "Abstraction",
    "Alarm",
    "AnnexRow",
    "Box",
    "BuiltModel",
    "Check",
    "Choice",
    "Clearance",
    "Defect",
    "DefectsError",
    "Excitation",
    "Finding",
    "Flowpipe",
    "HeldOut",
    "HorizonWidths",
    "Identification",
    "JointRow",
    "Leave",
    "Margin",
    "Model",
    "ModelFileError",
    "Monitor",
    "MotionVerdict",
    "OutputTube",
    "PlanTube",
    "Polynomial",
    "ReachableSet",
    "ReachtubeError",
    "ReachtubeWarning",
    "RecordedStop",
    "Recordings",
    "Report",
    "Robot",
    "Run",
    "SettingError",
    "StopStudy",
    "StopTrigger",
    "System",
    "SystemCheck",
    "SystemModel",
    "TrackingCheck",
    "TrackingModel",
    "Verification",
    "Witness",
    "WitnessStop",
    "WorstStop",
    "abstract",
    "check",
    "conform",
    "cos",
    "errors",
    "excite",
    "fleet",
    "flowpipe",
    "identify",
    "io",
    "model",
    "monitor",
    "plot",
    "prepare",
    "reach",
    "report",
    "sin",
    "stop",
    "variables",
    "verify",
]
