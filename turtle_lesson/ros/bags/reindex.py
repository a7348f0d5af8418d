"""Writing metadata.yaml anew, as `ros2 bag reindex` does it: for a recording that was not stopped, or a lost file.

Facts: rosbag2_storage's yaml.hpp. It is written in version 5, that of Humble, which every later release reads and which
asks for nothing that a data file does not say. An empty bag begins at the end of time there, and so it does here.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from .bag import METADATA, Bag, BagTopic, open_bag

VERSION = 5
NEVER = (1 << 63) - 1


def reindex(folder: Path) -> Bag:
    """Write the metadata.yaml of a bag's folder anew, from all data files that are in it. Returns the bag.

    Raises BagError if nothing there can be read.
    """
    bag = open_bag(folder, listed_only=False)
    found = {
        "version": VERSION,
        "storage_identifier": bag.storage,
        **_extent(bag),
        "topics_with_message_count": [_topic(topic) for topic in bag.topics],
        "compression_format": "zstd" if bag.compression else "",
        "compression_mode": bag.compression,
        "relative_file_paths": [file.name for file in bag.files],
        "files": [{"path": file.name, **_extent(open_bag(file))} for file in bag.files],
    }
    (folder / METADATA).write_text(yaml.safe_dump({"rosbag2_bagfile_information": found}, sort_keys=False), "utf-8")
    return open_bag(folder)


def _extent(bag: Bag) -> dict[str, Any]:
    return {
        "duration": {"nanoseconds": bag.duration},
        "starting_time": {"nanoseconds_since_epoch": NEVER if bag.start is None else bag.start},
        "message_count": bag.message_count,
    }


def _topic(topic: BagTopic) -> dict[str, Any]:
    from rosbags.rosbag2.metadata import dump_qos_v8

    about = {"name": topic.name, "type": topic.type_name, "serialization_format": topic.serialization}
    about["offered_qos_profiles"] = dump_qos_v8(topic.profiles)
    return {"topic_metadata": about, "message_count": topic.count}
