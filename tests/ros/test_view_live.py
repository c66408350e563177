"""The 3-D page of a running graph: it follows, plans by hand, sends the goal, leads the tool."""

import threading

import numpy as np
from in_process import spin_until
from led_graph import running

from uvms_bringup.ros.live_source import LiveSource
from uvms_bringup.viewer.elements import world_pose
from uvms_bringup.viewer.live_page import LivePage
from uvms_bringup.viewer.preview import tool_now
from uvms_planner.config import PlannerConfig


def beside(spinner, work):
    """What `work` returns, done in a thread while the graph goes on."""
    found = []
    thread = threading.Thread(target=lambda: found.append(work()))
    thread.start()
    spin_until(spinner, lambda: not thread.is_alive())
    return found[0]


def connected(domain):
    source = LiveSource(domain=domain)
    source.wait()
    return source


def test_a_goal_is_planned_by_hand_shown_sent_and_followed(tmp_path):
    with running(tmp_path, 600.0, None) as (spinner, conductor):
        domain = conductor.context.get_domain_id()
        graph = beside(spinner, lambda: connected(domain))
        page = LivePage(graph, PlannerConfig(), port=0)
        try:
            vehicle = graph.vehicle
            assert vehicle.name == "reference_auv"
            start = tool_now(vehicle, *graph.state())
            shown = world_pose("estimated/tool", page.places)[0]
            assert np.linalg.norm(shown - start) < 0.01

            page.place_gizmo(start - [0.0, 0.0, 20.0])  # out of the water
            page.plan()
            assert page.preview.refusal
            page.send()
            assert graph.goal_state == "no goal sent"

            end = start + [0.05, 0.03, 0.02]
            page.place_gizmo(end)
            page.plan()
            assert page.preview.refusal == ""
            assert np.linalg.norm(page.preview.tool[-1] - end) < 1e-3
            assert graph.goal_state == "no goal sent"  # it is shown before it is sent
            page.send()
            spin_until(spinner, lambda: graph.goal_state == "under way")
            spin_until(spinner, lambda: page.step() or graph.goal_state.startswith("done"))
            page.step()
            moment = graph.moment()
            true = world_pose("true/tool", page.model.all_places(moment))[0]
            assert np.linalg.norm(true - end) < 0.05
            assert len(moment.trail) > 2

            graph.lead(start)
            spin_until(spinner, lambda: _near(graph.moment().plan, start))
            assert conductor.goal_handle is None  # the run itself had none
        finally:
            graph.close()
            page.close()


def _near(plan, place):
    return plan is not None and np.linalg.norm(plan[-1] - place) < 1e-6
