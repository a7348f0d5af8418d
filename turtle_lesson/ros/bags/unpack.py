"""Compressed parts of bags, unpacked up to a limit: a few kilobytes can stand for gigabytes.

The limit goes by what lies on the disk. Recordings of robots shrink to a half or a tenth, and hardly ever to a hundredth.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

MOST_TIMES = 100
"""How many times its size compressed data may become."""

ALWAYS = 64 << 20
"""How many bytes it may become in any case."""


class TooLargeError(ValueError):
    """Compressed data would become more than the limit."""


def limit(packed: int) -> int:
    """How many bytes may come of so many compressed ones."""
    return max(ALWAYS, MOST_TIMES * packed)


def too_large(what: str, packed: int) -> TooLargeError:
    """The error for data of so many compressed bytes."""
    most = f"{limit(packed) >> 20} MiB"
    return TooLargeError(f"{what} is not unpacked: it would become more than {most}, which is no usual recording")


def unpack(compression: str, data: bytes, most: int) -> tuple[bytes, bool]:
    """The first bytes of what was compressed, at most so many; and whether more follows.

    They are fewer where the data is cut short, and none where it is spoiled.

    Raises:
        KeyError: if nothing is known of this compression.
    """
    decompressor = DECOMPRESSORS[compression]()
    try:
        found = bytes(decompressor.decompress(data, most + 1))
    except Exception:
        return b"", False
    return found[:most], len(found) > most or bool(decompressor.unused_data)


def unpack_message(data: bytes) -> bytes:
    """A message that was compressed by zstd on its own. Raises TooLargeError, or ValueError if it is spoiled."""
    found, more = unpack("zstd", data, limit(len(data)))
    if more:
        raise too_large(f"a message of {len(data)} bytes", len(data))
    if data and not found:
        raise ValueError("a message is not compressed by zstd, as metadata.yaml says that it is")
    return found


def unpack_file(source: Path, target: Path) -> None:
    """Write what was compressed by zstd, as far as it can be read, into another file. Raises TooLargeError, OSError."""
    size = source.stat().st_size
    left = limit(size)
    with _zstd().open(source, "rb") as packed, target.open("wb") as unpacked:
        while True:
            try:
                piece = packed.read(1 << 20)
            except (EOFError, _zstd().ZstdError):
                return  # cut short or spoiled
            if not piece:
                return
            left -= len(piece)
            if left < 0:
                raise too_large(source.name, size)
            unpacked.write(piece)


def _zstd() -> Any:
    if sys.version_info >= (3, 14):
        from compression import zstd
    else:
        from backports import zstd
    return zstd


def _lz4() -> Any:
    from lz4.frame import LZ4FrameDecompressor

    return LZ4FrameDecompressor()


DECOMPRESSORS: dict[str, Callable[[], Any]] = {"zstd": lambda: _zstd().ZstdDecompressor(), "lz4": _lz4}
