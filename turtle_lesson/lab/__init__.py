"""What a page shows and asks: pictures, widgets, predictions, checks of exercises and troubles.

The lab sees the system as any node does, through topics, services, parameters and the graph, so that it also works on a
robot. Every picture has an exact text. Its modules are imported when they are first asked for, Matplotlib with the first
picture, rclpy with the first recorder.
"""
