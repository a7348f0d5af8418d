"""Where launch descriptions come from."""

from .._missing import explain_missing
from .any_launch_description_source import AnyLaunchDescriptionSource
from .frontend_launch_description_source import FrontendLaunchDescriptionSource
from .python_launch_description_source import PythonLaunchDescriptionSource

__all__ = ["AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource", "PythonLaunchDescriptionSource"]

__getattr__ = explain_missing(
    __name__,
    {
        "XMLLaunchDescriptionSource": "it is in launch_xml.launch_description_sources",
        "YAMLLaunchDescriptionSource": "it is in launch_yaml.launch_description_sources",
    },
)
