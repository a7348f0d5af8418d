"""ROS packages on disk: what `package.xml` and `CMakeLists.txt` say, and the index of packages."""
