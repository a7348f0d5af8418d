from standin_messages import service

NavigateTo = service(
    "robot_controller/srv/NavigateTo",
    {"x": "float", "y": "float", "theta": "float"},
    {"success": "boolean", "time_taken": "float"},
)
