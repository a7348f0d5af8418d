"""A form for the messages of a topic, or for the requests of a service."""

from __future__ import annotations

import shlex
from functools import reduce
from typing import Any

import traitlets
from rclpy.node import Node
from rclpy.timer import Timer

from ...ros.idl.names import is_hidden
from ..recorder import find_class
from ..words import count, listed, suggestion, within
from .backend import LazyClient, LazyPublisher, Link, let_time_go_on
from .live_widget import LiveWidget
from .message_fields import fields_of


class Form(LiveWidget):
    """Publishes messages, once or at a rate, or calls a service and shows its answer.

    What stands in the fields is kept here as text, so that all views show the same, and an error stays beside its field.
    """

    SCRIPTS = ("dom", "small", "form_fields", "form")
    STYLES = ("base", "small", "form")
    RATE = 10.0

    name = traitlets.Unicode().tag(sync=True)
    kind = traitlets.Unicode().tag(sync=True)
    """"topic" or "service"."""
    type_name = traitlets.Unicode().tag(sync=True)
    fields = traitlets.List(traitlets.Dict()).tag(sync=True)
    """What there is to draw; `Field` says what there is of each."""
    values = traitlets.Dict().tag(sync=True)
    """What stands in each field, by its path."""
    errors = traitlets.Dict().tag(sync=True)
    """What is wrong in a field, by its path."""
    line = traitlets.Unicode().tag(sync=True)
    """The same for the terminal; "" while a field has an error."""
    rate = traitlets.Float(10.0).tag(sync=True)
    """Messages a second of robot time."""
    running = traitlets.Bool(False).tag(sync=True)
    """Whether it publishes at the rate, or waits for an answer."""
    published = traitlets.Int(0).tag(sync=True)
    answer = traitlets.Unicode().tag(sync=True)
    """The newest answer in YAML."""
    unheard = traitlets.Unicode().tag(sync=True)

    def __init__(self, backend: Link, name: str) -> None:
        full, kind, type_name = _look_up(backend.node, name)
        message_class = find_class(type_name)
        self._class = message_class if kind == "topic" else message_class.Request
        self._fields = fields_of(self._class())
        self._publisher = LazyPublisher(backend, full, message_class, type_name)
        self._client = LazyClient(backend, message_class, full)
        self._timer: Timer | None = None
        self._last: Any = None
        fields = [field.state() for field in self._fields]
        super().__init__(backend, name=full, kind=kind, type_name=type_name, fields=fields)
        self._bring_up_to_date()
        self.tick()

    def do_edit(self, path: str, text: str | bool) -> None:
        """Put a text (true or false, for a checkbox) into a field."""
        field = next((field for field in self._fields if field.path == path and field.is_single), None)
        if field is None or type(text) is not type(field.text):
            raise ValueError(f"This form has no field {path!r} that takes {text!r}.")
        field.text = text
        self._bring_up_to_date()

    def do_reset(self) -> None:
        """Put the defaults into all fields."""
        self._fields = fields_of(self._class())
        self._bring_up_to_date()

    def do_rate(self, rate: float) -> None:
        """Set how often to publish (messages a second)."""
        self.rate = within("rate", rate, 0.01, 100)
        if self._timer is not None:
            self._publish_again_and_again()
        self._bring_up_to_date()

    def do_publish(self) -> None:
        """Publish once."""
        self._publish(self._message())
        self.words = f"Published on {self.name}."
        let_time_go_on(self.backend)

    def do_repeat(self) -> None:
        """Publish at the rate, until `stop`. What is edited meanwhile is published as soon as it is sound."""
        self._publish(self._message())
        self._publish_again_and_again()
        let_time_go_on(self.backend)

    def do_stop(self) -> None:
        """Publish no more; wait for no answer any more."""
        if self._timer is not None:
            self._drop_timer()
            self._bring_up_to_date()
            self.words = f"Stopped after {count(self.published, 'message')} on {self.name}."
        elif self._client.asking:
            self._client.give_up()
            self.words = f"No longer waiting for {self.name}; whether it does what was asked is unknown."

    def do_call(self) -> None:
        """Call the service."""
        request = self._message()
        self.answer = ""
        self.words = f"Asked {self.name}; waiting for its answer."
        self._client.ask(request, self._answered)
        if self._client.asking:
            let_time_go_on(self.backend)

    def _publish_again_and_again(self) -> None:
        self._drop_timer()
        self._timer = self.backend.node.create_timer(1 / self.rate, self._repeat)
        self.words = f"Publishing on {self.name}, {self.rate:g} times a second of robot time."
        self._bring_up_to_date()

    def _repeat(self) -> None:
        self._publish(self._last if self.errors else self._message())

    def _publish(self, message: Any) -> None:
        self._last = message
        self._publisher.publish(message)
        self.published += 1

    def _answered(self, words: str, answer: str) -> None:
        self.answer, self.words = answer, words
        self.running = False

    def _message(self) -> Any:
        """What stands in the fields. Raises ValueError while a field is wrong."""
        if self.errors:
            raise ValueError(f"Not sent: {'; '.join(f'{path}: {words}' for path, words in self.errors.items())}.")
        message = self._class()
        for field in self._fields:
            if field.control == "now":
                field.put_into(message, self.backend.node.get_clock().now().to_msg())
            elif field.path in self._changed:
                field.put_into(message, self._changed[field.path])
        return message

    def tick(self) -> None:
        self._client.look()
        self._publisher.flush()
        self.running = self._timer is not None or self._client.asking
        if self.due("listeners", 3):
            self.unheard = self._publisher.why_unheard() if self.kind == "topic" else self._client.why_unheard()

    def left(self) -> None:
        self._drop_timer()
        self._publisher.close()
        self._client.close()

    def _drop_timer(self) -> None:
        if self._timer is not None:
            self.backend.node.destroy_timer(self._timer)
            self._timer = None
        self.running = False

    def _bring_up_to_date(self) -> None:
        """Read what stands in the fields, and try whether a message takes it."""
        self._changed, errors, trial = dict[str, Any](), dict[str, str](), self._class()
        singles = [field for field in self._fields if field.is_single]
        for field in singles:
            try:
                if (value := field.value()) != field.default:
                    field.put_into(trial, value)
                    self._changed[field.path] = value
            except ValueError as error:
                errors[field.path] = str(error)
        self.values, self.errors = {field.path: field.text for field in singles}, errors
        how = "--once" if self._timer is None else f"--rate {self.rate:g}"
        does = f"topic pub {how}" if self.kind == "topic" else "service call"
        self.line = "" if errors else f"ros2 {does} {self.name} {self.type_name} {in_yaml(self._changed)}"

    def _text(self) -> str:
        what = "messages on" if self.kind == "topic" else "requests to"
        wrong = listed([f"{path} ({words})" for path, words in self.errors.items()])
        now = f"to correct first: {wrong}" if self.errors else self.line
        return f"Form for {what} {self.name} ({self.type_name}): {now}"


def _look_up(node: Node, name: str) -> tuple[str, str, str]:
    """Full name, "topic" or "service", and type. Raises ValueError with what was meant perhaps."""
    if not isinstance(name, str) or not name:
        raise ValueError(f'a form is for a topic or a service such as "/turtle1/cmd_vel", got {name!r}')
    full = name if name.startswith("/") else f"{node.get_namespace().rstrip('/')}/{name}"
    there = {"topic": dict(node.get_topic_names_and_types()), "service": dict(node.get_service_names_and_types())}
    for kind, known in there.items():
        if full in known:
            return full, kind, known[full][0]
    names = {each for known in there.values() for each in known if "parameter" not in each and not is_hidden(each)}
    raise ValueError(f'there is no topic or service called "{name}" now. {suggestion(name, sorted(names))}')


def in_yaml(by_path: dict[str, Any]) -> str:
    """Values by their paths as one word of a shell: in double quotes as in ROS's own examples, unless a sign has a meaning."""
    import yaml

    values: dict[str, Any] = {}
    for path, value in by_path.items():
        *groups, name = path.split("/")
        reduce(lambda inner, group: inner.setdefault(group, {}), groups, values)[name] = value
    for allow_unicode in (True, False):  # some rare signs, such as U+0085, come back as blanks if they are not escaped
        options: dict[str, Any] = {"default_flow_style": True, "width": float("inf"), "sort_keys": False}
        text = yaml.safe_dump(values, allow_unicode=allow_unicode, **options).strip()
        if yaml.safe_load(text) == values:
            break
    return shlex.quote(text) if set(text) & set('"$`\\!') else f'"{text}"'
