from standin_messages import message

Time = message("builtin_interfaces/msg/Time", sec="int32", nanosec="uint32")
