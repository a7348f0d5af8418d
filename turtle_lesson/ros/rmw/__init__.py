"""The ROS graph of one world: nodes, endpoints and their matching, transport, QoS events, network and trace."""
