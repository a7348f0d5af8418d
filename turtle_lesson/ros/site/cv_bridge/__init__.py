"""Images as messages and as numpy arrays, as OpenCV has them; compressed ones need OpenCV itself."""

from .core import CvBridge, CvBridgeError

__all__ = ["CvBridge", "CvBridgeError"]
