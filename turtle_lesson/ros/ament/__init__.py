"""ROS packages on disk: `package.xml`, `CMakeLists.txt` and `setup.py` are read, built as `colcon` does, and found."""
