"""What all parts of the system agree on: vehicle file, signals, topics, messages, doors.

Free of physics; importing it loads neither numba nor scipy nor ROS.
"""
