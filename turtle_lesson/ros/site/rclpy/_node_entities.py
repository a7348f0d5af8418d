"""The part of a node that makes publishers, subscriptions, timers, services and the like, and takes them away."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from turtle_lesson.ros.rmw.endpoint import Quality

from . import type_support
from ._entity import Assignment, Entity
from ._hints import refuse_unbuilt
from ._node_graph import NodeGraph
from .callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from .client import Client
from .clock import Clock, ROSClock
from .context import Context
from .event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from .exceptions import RCLError, not_valid
from .guard_condition import GuardCondition
from .publisher import Publisher
from .qos import QoSProfile, checked_profile, qos_profile_services_default
from .service import Service
from .subscription import Subscription
from .timer import Rate, Timer, period_ns


class NodeEntities(NodeGraph):
    """Mixed into Node."""

    def _ros_setup_entities(self, context: Context) -> None:
        self._ros_context = context
        self._ros_assignment = Assignment()
        self._ros_made = 0
        self._ros_publishers: list[Publisher] = []
        self._ros_waiting_entities: list[Entity] = []
        self._ros_default_callback_group = MutuallyExclusiveCallbackGroup()
        self._ros_clock = ROSClock()

    def _ros_keep(self, entity: Any) -> Any:
        self._ros_made += 1
        entity._number, entity._node = self._ros_made, self
        entity._assign(self._ros_assignment)
        self._ros_waiting_entities.append(entity)
        if self._ros_assignment.executor is not None:
            self._ros_assignment.executor._adopt(entity, self)  # type: ignore[arg-type]
        else:
            self._ros_assignment.missed[entity] = None
        return entity

    def create_publisher(
        self,
        msg_type: Any,
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: None = None,
        publisher_class: type[Publisher] = Publisher,
    ) -> Publisher:
        """Publish messages of a type on a topic. `qos_profile`: a QoSProfile, or how many to keep for late takers.

        Raises InvalidTopicNameException, AttributeError or RuntimeError (no message type), TypeError, ValueError,
        RCLError, and NotImplementedError for QoS overrides.
        """
        refuse_unbuilt(qos_overriding_options=qos_overriding_options)
        callbacks = event_callbacks or PublisherEventCallbacks()
        full_name, profile, quality = self._ros_topic_end("publisher", msg_type, topic, qos_profile, callbacks)
        kind = msg_type if isinstance(msg_type, type) else type(msg_type)
        writer = self._ros_graph.add_writer(self._ros_entry, full_name, kind._TYPE_NAME, quality)  # type: ignore[attr-defined]
        writer.profile = profile
        group = callback_group or self._ros_default_callback_group
        publisher = publisher_class(writer, kind, topic, profile, event_callbacks=callbacks, callback_group=group)
        publisher._node = self  # type: ignore[assignment]
        self._ros_publishers.append(publisher)
        for handler in publisher.event_handlers:
            self._ros_keep(handler)
        return publisher

    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: None = None,
        raw: bool = False,
        content_filter_options: None = None,
    ) -> Subscription:
        """Have `callback(message)` called for each message of a topic; the queue keeps `qos_profile` of them.

        Raises InvalidTopicNameException, AttributeError or RuntimeError (no message type), TypeError, ValueError,
        RCLError, and NotImplementedError for QoS overrides and content filters.
        """
        refuse_unbuilt(qos_overriding_options=qos_overriding_options, content_filter_options=content_filter_options)
        callbacks = event_callbacks or SubscriptionEventCallbacks()
        full_name, profile, quality = self._ros_topic_end("subscription", msg_type, topic, qos_profile, callbacks)
        reader = self._ros_graph.add_reader(self._ros_entry, full_name, msg_type._TYPE_NAME, quality)
        reader.profile = profile
        group = callback_group or self._ros_default_callback_group
        subscription = Subscription(reader, msg_type, topic, callback, group, profile, raw, callbacks)
        self._ros_keep(subscription)
        for handler in subscription.event_handlers:
            self._ros_keep(handler)
        return subscription

    def _ros_topic_end(
        self, what: str, msg_type: Any, topic: str, qos_profile: QoSProfile | int, callbacks: object
    ) -> tuple[str, QoSProfile, Quality]:
        """Full name, profile and what of it counts for a publisher or subscription (`what`) that is to be made.

        Within one process ROS refuses a second type on a topic; between processes it only never connects.
        """
        self._ros_check_alive(f"Failed to create {what}: rcl node's")
        expected = PublisherEventCallbacks if what == "publisher" else SubscriptionEventCallbacks
        if not isinstance(callbacks, expected):
            raise TypeError(f"event_callbacks must be such as {expected.__name__}(deadline=…), got {callbacks!r}")
        full_name = self._ros_full_name_of(topic)
        profile = checked_profile(qos_profile)
        quality = profile.quality(what)
        type_support.check_is_valid_msg_type(msg_type)
        found, own_type = self._ros_graph.topic(full_name), msg_type._TYPE_NAME
        ends: list[tuple[Any, str]] = [] if found.types in ([], [own_type]) else [*found.writers, *found.readers]
        for end, type_name in ends:
            if end.node.process is self._ros_entry.process and type_name != own_type:
                raise RCLError(
                    f"Failed to create {what}: failed to create topic [rt{full_name}] because it's already in use in this "
                    f"context with a different message type: it is {type_name}, asked for was {own_type}"
                )
        return full_name, profile, quality

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., Any],
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """Have `callback()` called every `timer_period_sec` seconds, for the first time after one period.

        A destroyed node can make timers, too, but no executor has it any more, so they never tick.
        """
        if self._ros_shut_down:
            raise not_valid("timer")
        period = period_ns(timer_period_sec)
        group = callback_group or self._ros_default_callback_group
        return self._ros_keep(Timer(callback, group, period, clock or self._ros_clock, autostart=autostart))

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        """Offer a service: `callback(request, response)` fills the response in and returns it.

        Raises InvalidServiceNameException, AttributeError or RuntimeError (no service type).
        """
        self._ros_check_alive("failed to create service: rcl node's")
        full_name = self._ros_full_name_of(srv_name, is_service=True)
        type_support.check_is_valid_srv_type(srv_type)
        server = self._ros_graph.add_server(self._ros_entry, full_name, srv_type._TYPE_NAME)
        group = callback_group or self._ros_default_callback_group
        return self._ros_keep(Service(server, srv_type, srv_name, callback, group, qos_profile))

    def create_client(
        self,
        srv_type: Any,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client:
        """Make a client of a service. Raises InvalidServiceNameException, AttributeError or RuntimeError."""
        self._ros_check_alive("failed to create client: rcl node's")
        full_name = self._ros_full_name_of(srv_name, is_service=True)
        type_support.check_is_valid_srv_type(srv_type)
        end = self._ros_graph.add_client(self._ros_entry, full_name, srv_type._TYPE_NAME)
        group = callback_group or self._ros_default_callback_group
        return self._ros_keep(Client(end, srv_type, srv_name, qos_profile, group))

    def create_guard_condition(
        self, callback: Callable[[], Any], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Have `callback()` called whenever the guard condition is triggered."""
        self._ros_check_alive()
        if self._ros_shut_down:
            raise not_valid("guard_condition")
        group = callback_group or self._ros_default_callback_group
        return self._ros_keep(GuardCondition(callback, group))

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Something to sleep by, `frequency` times a second."""
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        callback: Any = None  # the rate brings its own
        timer = self.create_timer(1.0 / frequency, callback, ReentrantCallbackGroup(), clock)
        return Rate(timer, context=self._ros_context)

    def _ros_destroy(self, entity: object) -> bool:
        if entity not in self._ros_waiting_entities:
            return False
        entity.destroy()
        return True

    def destroy_publisher(self, publisher: Publisher) -> bool:
        """Stop publishing; False if it is not this node's."""
        if publisher not in self._ros_publishers:
            return False
        self._ros_publishers.remove(publisher)
        publisher.destroy()
        return True

    def destroy_subscription(self, subscription: Subscription) -> bool:
        """Stop hearing; False if it is not this node's."""
        return self._ros_destroy(subscription)

    def destroy_client(self, client: Client) -> bool:
        """Take a client away; False if it is not this node's."""
        return self._ros_destroy(client)

    def destroy_service(self, service: Service) -> bool:
        """Take a service away; False if it is not this node's."""
        return self._ros_destroy(service)

    def destroy_timer(self, timer: Timer) -> bool:
        """Take a timer away; False if it is not this node's."""
        return self._ros_destroy(timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """Take a guard condition away; False if it is not this node's."""
        return self._ros_destroy(guard)

    def destroy_rate(self, rate: Rate) -> bool:
        """Take a rate away; False if it is not this node's."""
        rate.destroy()
        return self._ros_destroy(rate._timer)
