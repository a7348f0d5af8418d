from standin_messages import service

import rcl_interfaces.msg  # noqa: F401

ListParameters = service(
    "rcl_interfaces/srv/ListParameters",
    {"prefixes": "sequence<string>", "depth": "uint64"},
    {"result": "rcl_interfaces/ListParametersResult"},
)
DescribeParameters = service(
    "rcl_interfaces/srv/DescribeParameters",
    {"names": "sequence<string>"},
    {"descriptors": "sequence<rcl_interfaces/ParameterDescriptor>"},
)
GetParameters = service(
    "rcl_interfaces/srv/GetParameters",
    {"names": "sequence<string>"},
    {"values": "sequence<rcl_interfaces/ParameterValue>"},
)
SetParameters = service(
    "rcl_interfaces/srv/SetParameters",
    {"parameters": "sequence<rcl_interfaces/Parameter>"},
    {"results": "sequence<rcl_interfaces/SetParametersResult>"},
)
