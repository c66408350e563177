"""Message definitions and CDR, the format of messages on the wire and in logs, without ROS.

Own code beside mcap_ros2's and rclpy's because a log is written without ROS and arrays stay arrays:
to encode takes 0.05 to 0.16 of mcap_ros2's time and 0.2 to 0.5 of rclpy's, to decode 0.09 to 0.15
and 0.06 to 0.07 (odometry and a reference; `make bench ARGS=cdr`).
"""

from uvms_core.cdr.codec import Codec, codec
from uvms_core.cdr.definitions import schema_text, type_hash
from uvms_core.cdr.stamp import stamp_in
from uvms_core.errors import CdrError, DefinitionError

__all__ = ["CdrError", "Codec", "DefinitionError", "codec", "schema_text", "stamp_in", "type_hash"]
