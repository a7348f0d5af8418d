"""Many runs of one function in fresh worlds, over seeds and parameters, on all cores or a cluster; replay."""

from .experiment import experiment
from .one_run import ExperimentError
from .results import Results

__all__ = ["ExperimentError", "Results", "experiment"]
