"""What a signal of this vehicle can be: bounds of every field, and of jumps between samples.

`bounds` derives them from the vehicle file, `watch` holds a stream of samples against them. Free of
ROS: the nodes and the in-process loop use the same.
"""

from uvms_core.plausibility.bounds import bounds_of
from uvms_core.plausibility.plausibility import Plausibility
from uvms_core.plausibility.rule import Bound, Rule
from uvms_core.plausibility.watch import AGREEING, Watch

__all__ = ["AGREEING", "Bound", "Plausibility", "Rule", "Watch", "bounds_of"]
