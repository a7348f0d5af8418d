"""`rosidl_parser`: here only the types of messages' fields (`rosidl_parser.definition`), for programs that look at them."""
