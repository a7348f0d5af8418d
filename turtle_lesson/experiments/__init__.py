"""Many runs of one function in fresh worlds, over seeds and parameters, on all cores or a cluster; replay."""

from .experiment import experiment, replay
from .one_run import ExperimentError
from .replay import Replay
from .results import Results

__all__ = ["ExperimentError", "Replay", "Results", "experiment", "replay"]
