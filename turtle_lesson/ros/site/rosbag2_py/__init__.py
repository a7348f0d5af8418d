"""Bags read and written by programs: rosbag2_py, as far as the simulation has it (SequentialReader, SequentialWriter, Info).

Names and sentences are those of rosbag2_py's _reader.cpp, _writer.cpp and _storage.cpp, of Humble and Jazzy.
"""

from __future__ import annotations

from typing import Any

from ._info import Info
from ._reader import SequentialCompressionReader, SequentialReader, get_registered_readers
from ._storage import (
    BagMetadata,
    ConverterOptions,
    FileInformation,
    StorageFilter,
    StorageOptions,
    TopicInformation,
    TopicMetadata,
    get_default_storage_id,
)
from ._writer import (
    SequentialWriter,
    get_registered_compressors,
    get_registered_serializers,
    get_registered_writers,
)

__all__ = [
    "BagMetadata",
    "ConverterOptions",
    "FileInformation",
    "Info",
    "SequentialCompressionReader",
    "SequentialReader",
    "SequentialWriter",
    "StorageFilter",
    "StorageOptions",
    "TopicInformation",
    "TopicMetadata",
    "get_default_storage_id",
    "get_registered_compressors",
    "get_registered_readers",
    "get_registered_serializers",
    "get_registered_writers",
]

_ELSEWHERE = {
    "Recorder": "`ros2 bag record` does it",
    "RecordOptions": "`ros2 bag record` does it",
    "Player": "`ros2 bag play` does it",
    "PlayOptions": "`ros2 bag play` does it",
    "Reindexer": "`ros2 bag reindex` does it",
    "SequentialCompressionWriter": "SequentialWriter writes without compression",
    "CompressionOptions": "SequentialWriter writes without compression",
    "CompressionMode": "SequentialWriter writes without compression",
    "bag_rewrite": "read with SequentialReader and write with SequentialWriter instead",
    "MetadataIo": "Info().read_metadata(uri, storage_id) reads metadata.yaml",
}


def __getattr__(name: str) -> Any:
    if name in _ELSEWHERE:
        raise NotImplementedError(f"rosbag2_py.{name} is not available here: {_ELSEWHERE[name]}.")
    raise AttributeError(f"module 'rosbag2_py' has no attribute {name!r}")
