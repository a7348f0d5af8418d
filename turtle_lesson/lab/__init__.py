"""What a page shows and asks: pictures, widgets, predictions, checks of exercises and troubles.

The lab sees the system as any node does, through topics, services, parameters and the graph, so that it also works on a
robot. Every picture has an exact text. Matplotlib is imported with the first picture, rclpy with the first recorder.
"""
