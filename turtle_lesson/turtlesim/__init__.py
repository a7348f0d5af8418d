"""The simulated turtle.

- ``world``: how turtles move, as plain Python that knows no ROS;
- ``canvas``: the trails that their pens draw;
- ``obstacles``: circles and boxes that a page places in the world;
- ``node``: the ROS node ``/turtlesim`` that shows the world to ROS.
"""
