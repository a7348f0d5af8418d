"""What `ros2 bag info` asks."""

from __future__ import annotations

from ._reader import opened
from ._storage import BagMetadata, metadata_of


class Info:
    """Looks into bags without reading their messages."""

    def read_metadata(self, uri: str, storage_id: str = "") -> BagMetadata:
        """What there is to know of a bag. Raises RuntimeError if there is none."""
        return metadata_of(opened(uri, storage_id))
