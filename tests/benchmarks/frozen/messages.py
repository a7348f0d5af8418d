"""Generated classes, as those of ROS: a field is checked when it is set, and a copy has the precision of the wire."""

from __future__ import annotations

import struct
from array import array
from typing import Any

FIELDS = {  # of each type: its default value, what a good value is, and how it is copied ("" where it is packed)
    "float32": ("0.0", "type({0}) is float and -3.402823466e+38 <= {0} <= 3.402823466e+38", ""),
    "float64": ("0.0", "type({0}) is float", "self._{0}"),
    "uint8": ("0", "type({0}) is int and 0 <= {0} <= 255", "self._{0}"),
    "uint32": ("0", "type({0}) is int and 0 <= {0} <= 4294967295", "self._{0}"),
    "string": ("''", "type({0}) is str", "self._{0}"),
    "float32[]": ("array('f')", "type({0}) is array and {0}.typecode == 'f'", "self._{0}[:]"),
    "Vector3": ("Vector3()", "type({0}) is Vector3", "self._{0}.copy()"),
}


def refuse(value: Any) -> None:
    """A field was set to something else than its type allows."""
    raise TypeError(f"not a value of this field: {value!r}")


def message_class(name: str, **fields: str) -> Any:
    """Make a class of messages with these fields and types."""
    lines = [f"class {name}:", f"    __slots__ = {[f'_{field}' for field in fields]}"]
    lines.append(f"    def __init__(self, *, {', '.join(f'{field}=None' for field in fields)}):")
    for field, kind in fields.items():
        default, good, _ = FIELDS[kind]
        lines.append(f"        if {field} is None: {field} = {default}")
        lines.append(f"        self._{field} = {field} if {good.format(field)} else refuse({field})")
    lines += ["    def copy(self):", f"        new = {name}.__new__({name})"]
    packed = [field for field, kind in fields.items() if kind == "float32"]
    if packed:
        values, targets = (", ".join(f"{each}._{field}" for field in packed) for each in ("self", "new"))
        lines.append(f"        {targets}, = unpack(pack({values}))")
    for field, kind in fields.items():
        if copied := FIELDS[kind][2]:
            lines.append(f"        new._{field} = {copied.format(field)}")
    lines.append("        return new")
    for field, kind in fields.items():
        lines += ["    @property", f"    def {field}(self): return self._{field}", f"    @{field}.setter"]
        lines += [f"    def {field}(self, {field}):"]
        lines += [f"        self._{field} = {field} if {FIELDS[kind][1].format(field)} else refuse({field})"]
    row = struct.Struct(f"<{len(packed)}f")
    scope: dict[str, Any] = {**globals(), "array": array, "pack": row.pack, "unpack": row.unpack}
    exec("\n".join(lines), scope)
    return scope[name]


Vector3 = message_class("Vector3", x="float64", y="float64", z="float64")
Twist = message_class("Twist", linear="Vector3", angular="Vector3")
Pose = message_class(
    "Pose", x="float32", y="float32", theta="float32", linear_velocity="float32", angular_velocity="float32"
)
Color = message_class("Color", r="uint8", g="uint8", b="uint8")
Status = message_class(
    "Status", x="float32", y="float32", theta="float32", vel_x="float32", vel_y="float32", battery="float32"
)
Scan = message_class(
    "Scan",
    sec="uint32",
    nanosec="uint32",
    frame_id="string",
    angle_min="float32",
    angle_max="float32",
    angle_increment="float32",
    scan_time="float32",
    range_min="float32",
    range_max="float32",
    ranges="float32[]",
)
