"""The 3-D page of a running graph, in a browser: follows, plans by hand, sends, cancels, leads."""

import os
import subprocess
import sys
import time
from dataclasses import dataclass

import numpy as np
import pytest
from browser import Tab, browser_tab
from live import one_domain, running
from viewed import pixel_of, served

from uvms_bringup.ros.live_source import LiveSource
from uvms_bringup.viewer.elements import is_shown, world_pose
from uvms_bringup.viewer.live_page import GIZMO, LivePage
from uvms_bringup.viewer.page import Site

pytestmark = pytest.mark.slow
SIZE = (900, 600)
"""Of the browser's window: a small one is drawn fast without a graphics card."""
ROCK = "{name: rock, sphere: {center_m: [4.0, 1.0, 11.0], radius_m: 0.6}}"
VIEW = 1.4, 1.2, -0.6
"""From the tool to the camera, m."""


@dataclass
class Stage:
    """A graph, the page that follows it, and the browser that shows that."""

    graph: LiveSource
    page: LivePage
    tab: Tab
    environment: dict[str, str]

    @property
    def tool(self):
        """Where the page has the true tool, (3,) m."""
        return world_pose("true/tool", self.page.places)[0]

    def pixel(self, point):
        """Where the browser shows a point (3,) of map_ned."""
        return pixel_of(self.page, SIZE, point)

    def drag_arrow(self, axis, by):
        """Drag one of the three arrows at the tool by so many m along it, with the mouse."""
        middle, along = self.page.gizmo[0], np.eye(3)[axis]
        self.look_at(middle)
        grip = middle + 0.75 * GIZMO * self.page.model.size * along
        self.tab.drag(self.pixel(grip), self.pixel(grip + by * along))
        there = lambda: abs(self.page.gizmo[0] - middle)[axis] > 0.5 * abs(by)  # noqa: E731
        self.tab.wait(there, "the arrows to be dragged")
        moved = self.page.gizmo[0] - middle
        assert moved[axis] == pytest.approx(by, rel=0.15)
        assert np.abs(np.delete(moved, axis)).max() < 2e-3

    def look_at(self, point):
        """Put the browser's camera beside a point, and wait until it is there."""
        (client,) = self.page.server.get_clients().values()
        before = client.camera.update_timestamp
        with client.atomic():
            client.camera.position = point + np.array(VIEW)
            client.camera.look_at = point
        self.wait(lambda: client.camera.update_timestamp != before, "the camera to be there")
        for _ in range(3):
            self.tab.frame()

    def arrows_to_tool(self):
        """Bring the arrows back to the tool by the button; again while it still settles."""
        self.page.place_gizmo((self.tool + [0.0, 0.0, 0.5], np.eye(3)))

        def near():
            if np.linalg.norm(self.page.gizmo[0] - self.tool) < 0.05:
                return True
            self.tab.press("Arrows to the tool")
            time.sleep(1.0)  # the browser's way to the page and back
            return False

        self.wait(near, "the arrows at the tool")

    def wait(self, condition, what):
        return self.tab.wait(condition, what)


@pytest.fixture(scope="module")
def stage(tmp_path_factory):
    folder, domain = tmp_path_factory.mktemp("live"), one_domain()
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    arguments = ("run", "hover", "--pace", "realtime", "--composed", "--duration", "3000")
    sets = ("--set", f"obstacles=[{ROCK}]", "--set", "planner.limits.roll_max_deg=9.0")
    with running(folder / "run", *arguments, *sets, **domain) as run:
        run.await_ticks()
        graph = LiveSource(domain=int(domain["ROS_DOMAIN_ID"]))
        try:
            graph.wait()
            with (
                served(LivePage(graph, Site(port=0))) as page,
                browser_tab(folder / "profile", SIZE) as tab,
            ):
                tab.open(page.address)
                tab.wait_for_text("UVMS: live")
                yield Stage(graph, page, tab, os.environ | domain)
                assert tab.complaints == []
        finally:
            graph.close()


def test_the_page_shows_what_the_graph_does_and_what_its_planner_knows(stage):
    page = stage.page
    assert stage.graph.planner.limits.roll_max_deg == 9.0
    rock = page.model.nodes["obstacle_rock"].place
    assert (rock.position.tolist(), rock.size.tolist()) == ([4.0, 1.0, 11.0], [0.6] * 3)
    before, time = page.drawing.position_of("estimated"), stage.graph.moment().time
    assert np.linalg.norm(before - [0.0, 0.0, 10.0]) < 0.2
    moved = lambda: not np.array_equal(page.drawing.position_of("estimated"), before)  # noqa: E731
    stage.wait(moved, "the vehicle to move")
    later = stage.wait(lambda: max(stage.graph.moment().time - time - 0.5, 0.0), "time to go on")
    stage.tab.wait_for_text(f"{int(time + 0.5 + later)}.")
    assert is_shown("estimated", page.places)
    assert is_shown("true", page.places)
    assert stage.graph.moment().current == pytest.approx([-0.08, 0.06, 0.0])
    assert is_shown("current", page.places)
    assert stage.tab.complaints == []


def test_a_goal_is_dragged_planned_shown_sent_and_reached(stage):
    page, tab, graph = stage.page, stage.tab, stage.graph
    start = stage.tool
    stage.arrows_to_tool()
    stage.drag_arrow(0, 0.05)
    stage.drag_arrow(2, 0.04)
    end = page.gizmo[0]
    tab.press("Plan")
    tab.wait_for_text("planned: ")
    assert np.linalg.norm(page.preview.tool[-1] - end) < 1e-3
    assert page.is_preview_shown
    assert graph.goal_state == "no goal sent"  # it is shown before it is sent
    tab.press("Send")
    tab.wait_for_text("goal: under way")
    stage.wait(lambda: page.places["planned_path"].visible, "the way ahead")
    tab.wait_for_text("goal: done: the end of the goal is reached")
    assert np.linalg.norm(stage.tool - end) < 0.05  # off the truth by the drift of navigation
    estimated = world_pose("estimated/tool", page.places)[0]
    assert np.linalg.norm(estimated - end) < 0.01
    trail = page.places["trail"].points
    assert np.linalg.norm(trail[-1] - estimated) < 0.01
    way = np.linalg.norm(np.diff(trail, axis=0), axis=1).sum()
    assert way > 0.8 * np.linalg.norm(end - start)  # the vehicle may still have settled at first


def test_what_the_planner_refuses_is_said_and_not_sent(stage):
    page, tab, graph = stage.page, stage.tab, stage.graph
    state = graph.goal_state
    page.place_gizmo((stage.tool - [0.0, 0.0, 20.0], np.eye(3)))  # out of the water
    tab.press("Plan")
    tab.wait_for_text("refused: ")
    assert not page.is_preview_shown
    tab.press("Send")  # the button is grey
    tab.frame()
    assert graph.goal_state == state


def test_a_goal_is_cancelled(stage):
    page, tab, graph = stage.page, stage.tab, stage.graph
    tab.press("Cancel")
    tab.wait_for_text("there is no goal to cancel")
    start = stage.tool
    page.place_gizmo((start + [0.0, 0.4, 0.0], np.eye(3)))  # 20 s away
    tab.press("Plan")
    tab.wait_for_text("planned: 2")
    tab.press("Send")
    tab.wait_for_text("goal: under way")
    tab.press("Cancel")
    stage.wait(lambda: graph.goal_state.startswith("not done"), "the goal to be given up")
    assert "cancel" in graph.goal_state
    assert np.linalg.norm(stage.tool - start) < 0.3


def test_the_tool_follows_the_arrows_while_it_is_led(stage):
    page, tab = stage.page, stage.tab
    stage.arrows_to_tool()
    tab.press("lead the tool along with the arrows")
    before = stage.tool
    stage.drag_arrow(2, -0.06)
    target = page.gizmo[0]
    estimated = lambda: world_pose("estimated/tool", page.places)[0]  # noqa: E731
    stage.wait(lambda: np.linalg.norm(estimated() - target) < 0.01, "the tool to follow")
    assert stage.tool[2] < before[2] - 0.03
    ahead = lambda: np.linalg.norm(page.places["planned_path"].points[-1] - target)  # noqa: E731
    stage.wait(lambda: ahead() < 1e-3, "a way ahead that ends at the arrows")
    assert stage.graph.moment().time < 3000.0  # the run's time, not the wall's
    page.place_gizmo((target - [0.0, 0.0, 30.0], np.eye(3)))
    tab.wait_for_text("planner: target: ")
    tab.press("lead the tool along with the arrows")


def test_the_command_serves_the_page_of_a_graph(stage):
    command = [sys.executable, "-m", "uvms_bringup.cli", "view", "--live", "--no-browser"]
    with subprocess.Popen(
        command, env=stage.environment, stdout=subprocess.PIPE, text=True
    ) as process:
        try:
            assert process.stdout.readline().startswith("live: http://127.0.0.1:")
        finally:
            process.terminate()
