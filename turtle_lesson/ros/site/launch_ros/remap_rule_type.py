"""What may be given as remappings, for hints (names: launch_ros's remap_rule_type.py)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from launch.some_types import SomeSubstitutionsType
from launch.substitution import Substitution

SomeRemapRule = tuple[SomeSubstitutionsType, SomeSubstitutionsType]
SomeRemapRules = Iterable[SomeRemapRule]
RemapRule = tuple[Sequence[Substitution], Sequence[Substitution]]
RemapRules = Sequence[RemapRule]
