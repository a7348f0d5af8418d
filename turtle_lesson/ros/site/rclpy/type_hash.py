"""By which a type is known on the wire, whatever its name (rclpy of Iron and newer)."""

from __future__ import annotations


class TypeHash:
    """A hash by REP 2011: a version and 32 bytes; as text `RIHS01_…`, or `INVALID`."""

    version: int
    value: bytes
    _TYPE_HASH_SIZE = 32

    def __init__(self, version: int = -1, value: bytes = bytes(_TYPE_HASH_SIZE)) -> None:
        self.version = version
        self.value = value

    def __setattr__(self, name: str, value: object) -> None:
        kind = {"version": int, "value": bytes}.get(name, object)
        assert isinstance(value, kind), f"{name} must be of type {kind.__name__}, got {value!r}"
        object.__setattr__(self, name, value)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, TypeHash) and vars(self) == vars(other)

    __hash__ = None  # type: ignore[assignment]

    def __str__(self) -> str:
        if self.version <= 0 or len(self.value) != self._TYPE_HASH_SIZE:
            return "INVALID"
        return f"RIHS{self.version:02}_{self.value.hex()}"

    def __repr__(self) -> str:
        return f"<TypeHash {self}>"
