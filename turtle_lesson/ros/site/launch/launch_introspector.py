"""`LaunchIntrospector`: a description as a tree of text, which is what `ros2 launch --print` shows."""

from __future__ import annotations

from collections.abc import Iterable

from .action import Action
from .launch_description import LaunchDescription
from .launch_description_entity import LaunchDescriptionEntity


class LaunchIntrospector:
    """Describes what is in a description, without carrying it out."""

    def format_launch_description(self, launch_description: LaunchDescription) -> str:
        """The tree: a line for the description, and one for each entity below it."""
        lines = [f"<{LaunchDescription.__module__}.{LaunchDescription.__qualname__} object>"]
        return "\n".join([*lines, *_branches(launch_description.entities)])


def _branches(entities: Iterable[LaunchDescriptionEntity]) -> list[str]:
    """The lines of several entities, with the signs that join them."""
    blocks = [_lines(entity) for entity in entities]
    found = []
    for number, (first, *others) in enumerate(blocks):
        last = number == len(blocks) - 1
        found.append(f"{'└──' if last else '├──'} {first}")
        found += [f"{'    ' if last else '│   '}{line}" for line in others]
    return found


def _lines(entity: LaunchDescriptionEntity) -> list[str]:
    from .actions import EmitEvent, ExecuteLocal, LogInfo, RegisterEventHandler, TimerAction

    if isinstance(entity, LogInfo):
        return [f"LogInfo({' + '.join(piece.describe() for piece in entity.msg)})"]
    if isinstance(entity, EmitEvent):
        return [f"Emit event '{entity.event.name}'"]
    if isinstance(entity, ExecuteLocal):
        return [_process(entity)]
    if isinstance(entity, RegisterEventHandler):
        description, inner = entity.event_handler.describe()
        return [f"RegisterEventHandler('{description}'):", *_branches(inner)]
    if isinstance(entity, TimerAction):
        seconds = " + ".join(piece.describe() for piece in entity.period)
        return [f"TimerAction(period={seconds}):", *_branches(entity.actions)]
    name = _named(entity)
    inner = list(entity.describe_sub_entities())
    inner += [each for _, group in entity.describe_conditional_sub_entities() for each in group]
    return [f"{name}:" if inner else name, *_branches(inner)]


def _named(entity: LaunchDescriptionEntity) -> str:
    if not isinstance(entity, Action):
        return f"<{type(entity).__qualname__}>"
    name = getattr(entity, "name", None)
    return f"{type(entity).__name__}({name!r})" if isinstance(name, str) else entity.describe()


def _process(action: Action) -> str:
    """A command as it would be run: `ExecuteProcess(cmd=[…], cwd=None, env=None, shell=False)`."""
    from .actions import ExecuteLocal

    assert isinstance(action, ExecuteLocal)
    description = action.process_description
    words = [" + ".join(piece.describe() for piece in word) for word in description.cmd]
    words += getattr(action, "_described_ros_words", [])
    cwd = None if description.cwd is None else " + ".join(piece.describe() for piece in description.cwd)
    return f"ExecuteProcess(cmd=[{', '.join(words)}], cwd={cwd}, env={description.env}, shell={action.shell})"
