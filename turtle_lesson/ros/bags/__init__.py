"""Bags: recordings of topics in files, which are written, described, read and played as `ros2 bag` does it (rosbag2).

    with lesson.record("run1"):                     # or: ros2 bag record -a -o run1
        lesson.run(5)
    bag = bags.bag.open_bag("run1")                 # a damaged one, too: bag.damage says what is lost
    for topic, time, type_name, data in bag.messages(): ...

`rosbags` writes the files. It is imported when it is first needed, since that takes half a second.
"""

from __future__ import annotations


class BagError(ValueError):
    """A bag cannot be written or read; the text says why, and what to try."""


class UnrecordableType(BagError):
    """Messages of this type cannot be put into a bag."""
