"""Two functions of numpy under the name that sensor_msgs_py gives them for very old versions of numpy."""

from numpy.lib.recfunctions import structured_to_unstructured, unstructured_to_structured

__all__ = ["structured_to_unstructured", "unstructured_to_structured"]
