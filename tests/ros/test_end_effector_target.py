"""The tool is led by points on a topic, on the real graph."""

import numpy as np
from in_process import Peer, spin_until
from led_graph import running

from uvms_core import topics
from uvms_core.signals import ToolTarget


class Leader(Peer):
    """Hears where the tool is planned to be, and says where it is to go."""

    def __init__(self):
        super().__init__(
            heard=[topics.REFERENCE, topics.DIAGNOSTICS], spoken=[topics.END_EFFECTOR_TARGET]
        )

    @property
    def tool(self):
        heard = self.heard[topics.REFERENCE.name]
        return heard[-1].end_effector[-1] if heard else None

    def lead(self, target):
        self.say(topics.END_EFFECTOR_TARGET, ToolTarget(0, np.asarray(target)))

    def complaints(self):
        heard = self.heard[topics.DIAGNOSTICS.name]
        return [each.message for each in heard if each.message.startswith("target: ")]


def test_the_tool_goes_to_the_points_that_it_is_given(tmp_path):
    with running(tmp_path, 600.0, None, Leader) as (spinner, conductor, leader):
        spin_until(spinner, lambda: leader.tool is not None)
        begin = leader.tool
        for offset in ([0.1, 0.0, 0.0], [0.1, 0.1, -0.05]):
            target = begin + offset
            leader.lead(target)
            spin_until(spinner, lambda t=target: np.linalg.norm(leader.tool - t) < 1e-6)
        leader.lead(begin - [0.0, 0.0, 10.5])  # out of the water
        spin_until(spinner, leader.complaints)
        assert "no motion to" in leader.complaints()[0]
        assert np.linalg.norm(leader.tool - target) < 1e-6
        assert conductor.goal_handle is None
