"""The vehicle for viewers, without ROS: a URDF and the transforms of its frames."""

from uvms_core.description.frames import StateFrames, description_message, static_message
from uvms_core.description.tree import Branch, tree
from uvms_core.description.urdf import urdf_text

__all__ = [
    "Branch",
    "StateFrames",
    "description_message",
    "static_message",
    "tree",
    "urdf_text",
]
