"""The ROS graph of one world: nodes, topics, services, who is matched with whom, and how messages travel."""
