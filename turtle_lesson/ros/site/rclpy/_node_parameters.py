"""The part of a node that keeps its parameters: declared with a type, described, checked, and told of changes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from . import exceptions
from ._node_parameter_setting import ParameterSetting
from ._parameter_rules import check_prefixes, is_listed, read_declaration
from .parameter import PARAMETER_SEPARATOR_STRING, Parameter

if TYPE_CHECKING:
    from .context import Context


class NodeParameters(ParameterSetting):
    """Mixed into Node."""

    context: Context
    _ros_allow_undeclared: bool

    # -- declaring -------------------------------------------------------------------------------------------------

    def declare_parameter(
        self, name: str, value: Any = None, descriptor: Any = None, ignore_override: bool = False
    ) -> Parameter:
        """Declare a parameter with its default value (or its Parameter.Type), and return it with the value in force.

        Raises ParameterAlreadyDeclaredException, InvalidParameterException, InvalidParameterTypeException or
        InvalidParameterValueException.
        """
        details: tuple[Any, ...] = (name,) if value is None and descriptor is None else (name, value)
        if descriptor is not None:
            details = (name, value, descriptor)
        return self.declare_parameters("", [details], ignore_override)[0]

    def declare_parameters(
        self, namespace: str, parameters: Sequence[tuple[Any, ...]], ignore_override: bool = False
    ) -> list[Parameter]:
        """Declare several: tuples of name, and optionally value and descriptor."""
        declared: list[tuple[Parameter, Any]] = []
        for index, details in enumerate(parameters):
            declared.append(self._ros_declaration(index, namespace, details, ignore_override))
        taken = [parameter.name for parameter, _ in declared if parameter.name in self._ros_parameters]
        if taken:
            raise exceptions.ParameterAlreadyDeclaredException(taken)
        for parameter, descriptor in declared:
            self._ros_declare(parameter, descriptor)
        return [self._ros_parameters[parameter.name] for parameter, _ in declared]

    def _ros_declaration(
        self, index: int, namespace: str, details: tuple[Any, ...], ignore_override: bool
    ) -> tuple[Parameter, Any]:
        name, value, descriptor = read_declaration(index, namespace, details)
        if not ignore_override and name in self._ros_overrides:
            return self._ros_overrides[name], descriptor
        return Parameter(name, value=value), descriptor

    def _ros_declare(self, parameter: Parameter, descriptor: Any) -> None:
        reason = self._ros_set([parameter], {parameter.name: descriptor})
        if reason.startswith("Wrong parameter type"):
            raise exceptions.InvalidParameterTypeException(parameter, Parameter.Type(descriptor.type).name)
        if reason:
            raise exceptions.InvalidParameterValueException(parameter.name, parameter.value, reason)

    def _ros_declare_overrides(self) -> None:
        """Declare what the parameter overrides name, as the real one does before it declares anything else.

        An empty list in a parameter file has no type, so Humble's node has the parameter, but no value for it.
        """
        from rcl_interfaces.msg import ParameterDescriptor

        found = [
            (name, each.value, ParameterDescriptor(dynamic_typing=each.value is None))
            for name, each in self._ros_overrides.items()
        ]
        self.declare_parameters("", found, ignore_override=True)

    def undeclare_parameter(self, name: str) -> None:
        """Forget a parameter. Raises ParameterNotDeclaredException or ParameterImmutableException."""
        self._ros_check_declared(name)
        if self._ros_descriptors[name].read_only:
            raise exceptions.ParameterImmutableException(name)
        del self._ros_parameters[name], self._ros_descriptors[name]

    # -- reading ---------------------------------------------------------------------------------------------------

    def has_parameter(self, name: str) -> bool:
        """Whether a parameter is declared."""
        return name in self._ros_parameters

    def get_parameter(self, name: str) -> Parameter:
        """A declared parameter. Raises ParameterNotDeclaredException or ParameterUninitializedException."""
        if name not in self._ros_parameters and self._ros_allow_undeclared:
            return Parameter(name)
        self._ros_check_declared(name)
        parameter = self._ros_parameters[name]
        if parameter.type_ == Parameter.Type.NOT_SET and not self._ros_descriptors[name].dynamic_typing:
            raise exceptions.ParameterUninitializedException(name)
        return parameter

    def get_parameters(self, names: list[str]) -> list[Parameter]:
        """Several declared parameters."""
        if not all(isinstance(name, str) for name in names):
            raise TypeError("All names must be instances of type str")
        return [self.get_parameter(name) for name in names]

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        """A declared parameter, or the alternative if it is not declared or has no value."""
        parameter = self._ros_parameters.get(name)
        if parameter is None or parameter.type_ == Parameter.Type.NOT_SET:
            return Parameter(name) if alternative_value is None else alternative_value
        return parameter

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """The parameters below a prefix, by the rest of their names."""
        start = prefix + PARAMETER_SEPARATOR_STRING if prefix else ""
        return {name[len(start) :]: each for name, each in self._ros_parameters.items() if name.startswith(start)}

    def get_parameter_type(self, name: str) -> Any:
        """The number of a declared parameter's type (rcl_interfaces/msg/ParameterType)."""
        if name not in self._ros_parameters and self._ros_allow_undeclared:
            return Parameter.Type.NOT_SET
        self._ros_check_declared(name)
        return self._ros_parameters[name].type_.value

    def get_parameter_types(self, names: list[str]) -> list[Any]:
        """The numbers of several parameters' types."""
        if not all(isinstance(name, str) for name in names):
            raise TypeError("All names must be instances of type str")
        return [self.get_parameter_type(name) for name in names]

    def describe_parameter(self, name: str) -> Any:
        """The rcl_interfaces/msg/ParameterDescriptor of a declared parameter."""
        if name not in self._ros_descriptors and self._ros_allow_undeclared:
            from rcl_interfaces.msg import ParameterDescriptor

            return ParameterDescriptor()
        self._ros_check_declared(name)
        return self._ros_descriptors[name]

    def describe_parameters(self, names: list[str]) -> list[Any]:
        """The descriptors of several declared parameters."""
        return [self.describe_parameter(name) for name in names]

    def list_parameters(self, prefixes: list[str], depth: int) -> Any:
        """An rcl_interfaces/msg/ListParametersResult of the names below some prefixes (none: of all).

        `depth` is how many parts a name may have below its prefix; 0 is any number.
        """
        from rcl_interfaces.msg import ListParametersResult

        check_prefixes(prefixes, depth)
        names = [name for name in self._ros_parameters if is_listed(name, prefixes, depth)]
        parts = [name.rpartition(PARAMETER_SEPARATOR_STRING) for name in names]
        parents = dict.fromkeys(parent for parent, separator, _ in parts if separator)
        return ListParametersResult(names=names, prefixes=list(parents))

    def _ros_check_declared(self, name: str) -> None:
        if name not in self._ros_parameters:
            raise self._ros_not_declared(name, name)
