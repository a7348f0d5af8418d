"""Descriptions of parameters under the name by which most launch files import them."""

from launch._missing import explain_missing

from .parameter_descriptions import Parameter, ParameterFile, ParameterValue

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]

_COMPOSABLE = "composable nodes are C++ libraries, and this classroom runs Python; use Node"

__getattr__ = explain_missing(
    __name__,
    {"ComposableNode": _COMPOSABLE, "ComposableLifecycleNode": _COMPOSABLE, "RosExecutable": "use Node"},
)
