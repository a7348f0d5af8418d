"""Where launch descriptions come from."""

from .._missing import explain_missing
from .any_launch_description_source import AnyLaunchDescriptionSource
from .python_launch_description_source import PythonLaunchDescriptionSource

__all__ = ["AnyLaunchDescriptionSource", "PythonLaunchDescriptionSource"]

__getattr__ = explain_missing(
    __name__,
    {
        "FrontendLaunchDescriptionSource": "XML and YAML launch files are not here, Python ones are",
        "XMLLaunchDescriptionSource": "XML launch files are not here, Python ones are",
        "YAMLLaunchDescriptionSource": "YAML launch files are not here, Python ones are",
    },
)
