"""What can go wrong with a transform. In tracebacks these are called `tf2.…`, as the real ones."""

from __future__ import annotations


class TransformException(Exception):
    """Something is wrong with a transform; the others are kinds of it."""

    __module__ = "tf2"


class ConnectivityException(TransformException):
    """Two frames hang on trees that are not connected."""

    __module__ = "tf2"


class LookupException(TransformException):
    """A frame is asked for that nobody has told of."""

    __module__ = "tf2"


class ExtrapolationException(TransformException):
    """A time is asked for that the kept transforms do not reach to."""

    __module__ = "tf2"


class InvalidArgumentException(TransformException):
    """A frame's name is none: empty, or with a slash before it."""

    __module__ = "tf2"


class TimeoutException(TransformException):
    """Nothing came in time."""

    __module__ = "tf2"
