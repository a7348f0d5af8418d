import builtin_interfaces.msg  # noqa: F401
from standin_messages import message

Log = message(
    "rcl_interfaces/msg/Log",
    stamp="builtin_interfaces/Time",
    level="uint8",
    name="string",
    msg="string",
    file="string",
    function="string",
    line="uint32",
)
IntegerRange = message("rcl_interfaces/msg/IntegerRange", from_value="int64", to_value="int64", step="uint64")
FloatingPointRange = message(
    "rcl_interfaces/msg/FloatingPointRange", from_value="double", to_value="double", step="double"
)
ParameterValue = message(
    "rcl_interfaces/msg/ParameterValue",
    type="uint8",
    bool_value="boolean",
    integer_value="int64",
    double_value="double",
    string_value="string",
    byte_array_value="sequence<octet>",
    bool_array_value="sequence<boolean>",
    integer_array_value="sequence<int64>",
    double_array_value="sequence<double>",
    string_array_value="sequence<string>",
)
Parameter = message("rcl_interfaces/msg/Parameter", name="string", value="rcl_interfaces/ParameterValue")
ParameterDescriptor = message(
    "rcl_interfaces/msg/ParameterDescriptor",
    name="string",
    type="uint8",
    description="string",
    additional_constraints="string",
    read_only="boolean",
    dynamic_typing="boolean",
    floating_point_range="sequence<rcl_interfaces/FloatingPointRange, 1>",
    integer_range="sequence<rcl_interfaces/IntegerRange, 1>",
)
ParameterEvent = message(
    "rcl_interfaces/msg/ParameterEvent",
    stamp="builtin_interfaces/Time",
    node="string",
    new_parameters="sequence<rcl_interfaces/Parameter>",
    changed_parameters="sequence<rcl_interfaces/Parameter>",
    deleted_parameters="sequence<rcl_interfaces/Parameter>",
)
SetParametersResult = message("rcl_interfaces/msg/SetParametersResult", successful="boolean", reason="string")
ListParametersResult = message(
    "rcl_interfaces/msg/ListParametersResult", names="sequence<string>", prefixes="sequence<string>"
)
