"""The page of a running graph: follows it, plans goals by hand and sends them, leads the tool."""

import time as clock
from collections.abc import Callable
from typing import Protocol

import numpy as np

from uvms_bringup.viewer.drawing import Drawing
from uvms_bringup.viewer.elements import Look, Node, Place
from uvms_bringup.viewer.front_page import viser_page, with_ours
from uvms_bringup.viewer.moment import Moment, tool_pose
from uvms_bringup.viewer.page import FRAME_S, Page, Site
from uvms_bringup.viewer.preview import Preview, preview, straight_goal, tool_now
from uvms_bringup.viewer.scene_model import LINE, SceneModel, Setting
from uvms_bringup.viewer.vehicle_body import VehicleBody
from uvms_core.errors import UvmsError
from uvms_core.rotations import matrix_to_quat, quat_to_matrix
from uvms_core.signals import Array, JointStates, Odometry, PathGoal
from uvms_core.vehicle.frames import Pose
from uvms_core.vehicle.vehicle import Vehicle
from uvms_planner.config import PlannerConfig

GIZMO = 0.25
"""Length of the arrows at the tool, as a part of the hull's length."""
MEAN_MM_S = 20.0
"""Speed of the tool towards a goal unless the user says otherwise."""
LEAD_S = 0.2
"""Between two targets while the tool is led by hand."""
PLANNED, LINE_NAME = "preview", "preview_path"
GREEN = (0.15, 0.75, 0.35)


class Graph(Protocol):
    """What the page needs of a graph; `uvms_bringup.ros.live_source` has it."""

    vehicle: Vehicle
    planner: PlannerConfig
    goal_state: str
    complaint: str

    def moment(self) -> Moment:
        """What is known now."""

    def state(self) -> tuple[Odometry, JointStates] | None:
        """The newest odometry and joint states."""

    def send(self, goal: PathGoal) -> None:
        """Ask the planner for a path."""

    def cancel(self) -> None:
        """Give up the goal that was sent last."""

    def lead(self, target: Array) -> None:
        """Lead the tool to a target (3,) m in map_ned."""


class LivePage(Page):
    """A graph on a page."""

    def __init__(self, graph: Graph, site: Site) -> None:
        first = graph.moment()
        model = SceneModel(_setting(graph, first))
        super().__init__(model, first, site, "UVMS: live", with_ours(viser_page()))
        self.graph = graph
        self._ghost = VehicleBody(graph.vehicle, PLANNED, 0.3, details=False)
        width = np.full(3, 2.0 * LINE * model.size)
        line = Node(LINE_NAME, Look("line", GREEN), Place(size=width, visible=False))
        self._width = width
        nodes = {node.name: node for node in (*self._ghost.nodes, line)}
        self._plan = Drawing(self.server.scene, nodes, self._ghost.still, model.line_m)
        self._plan.show({PLANNED: Place(visible=False)})
        self.preview: Preview | None = None
        self._goal: PathGoal | None = None
        self._led = 0.0
        self._add_controls(first)
        self.add_cameras()
        self.add_switches()

    def serve(self, stopped: Callable[[], bool] = lambda: False) -> None:
        """Follow the graph until stopped."""
        while not stopped():
            clock.sleep(FRAME_S)
            self.step()

    def step(self) -> None:
        """Draw what the graph says now, and lead the tool where that is switched on."""
        moment = self.graph.moment()
        self.show(moment)
        self._say(moment.time)
        if self._leads.value and clock.monotonic() - self._led > LEAD_S:
            self._led = clock.monotonic()
            self.graph.lead(self.gizmo[0])

    def plan(self) -> None:
        """Plan a line from the tool to the gizmo and show it; nothing is sent."""
        if (state := self.graph.state()) is None:
            return
        vehicle, speed = self.graph.vehicle, 1e-3 * self._speed.value
        goal = straight_goal(tool_now(vehicle, *state), self.gizmo, speed, self._turns.value)
        self.preview = preview(vehicle, self.graph.planner, *state, goal)
        self._goal = None if self.preview.refusal else goal
        self._answer.content = _text(self.preview)
        self._send.disabled = bool(self.preview.refusal)
        self._show_preview(self.preview)

    def send(self) -> None:
        """Send the goal that was planned last."""
        if (goal := self._goal) is not None:
            self._try(lambda: self.graph.send(goal))
            self._send.disabled = True

    @property
    def gizmo(self) -> Pose:
        """Where the arrows are that the mouse drags, in map_ned."""
        return np.array(self._gizmo.position), quat_to_matrix(np.roll(self._gizmo.wxyz, -1))

    def place_gizmo(self, pose: Pose) -> None:
        """Put the arrows to a place; they have a rotation while the goal has one."""
        R = pose[1] if self._turns.value else np.eye(3)
        self._gizmo.position = pose[0]
        self._gizmo.wxyz = np.roll(matrix_to_quat(R), 1)

    @property
    def is_preview_shown(self) -> bool:
        """Whether the page shows a planned way."""
        return self._plan.is_visible(LINE_NAME)

    def _say(self, time: float) -> None:
        """What the time is, and how the goal stands."""
        lines = [f"**{time:.2f} s**", f"goal: {self.graph.goal_state}"]
        if self.graph.complaint:
            lines.append(f"planner: {self.graph.complaint}")
        if (text := "\n\n".join(lines)) != self._status.content:
            self._status.content = text

    def _show_preview(self, found: Preview) -> None:
        shown = not found.refusal
        points = found.tool if shown else None
        self._plan.show({LINE_NAME: Place(size=self._width, visible=shown, points=points)})
        self._plan.show(self._ghost.places(found.end))

    def _add_controls(self, first: Moment) -> None:
        gui, shown = self.server.gui, first.estimated or first.true
        start = np.zeros(3) if shown is None else tool_pose(self.graph.vehicle, shown)[0]
        self._gizmo = self.server.scene.add_transform_controls(
            "/goal", position=start, disable_rotations=True, scale=GIZMO * self.model.size
        )
        self._status = gui.add_markdown("")
        with gui.add_folder("Goal of the tool"):
            gui.add_markdown("Drag the arrows at the tool, plan, look, send.")
            self._turns = gui.add_checkbox("with the arrows' orientation", False)
            self._speed = gui.add_number("speed [mm/s]", MEAN_MM_S, min=1.0, max=1000.0)
            plan = gui.add_button("Plan")
            self._answer = gui.add_markdown("")
            self._send = gui.add_button("Send", disabled=True)
            cancel = gui.add_button("Cancel")
            back = gui.add_button("Arrows to the tool")
            self._leads = gui.add_checkbox("lead the tool along with the arrows", False)
        plan.on_click(lambda _: self._try(self.plan))
        self._send.on_click(lambda _: self.send())
        cancel.on_click(lambda _: self._try(self.graph.cancel))
        self._turns.on_update(lambda _: self._turn())
        back.on_click(lambda _: self._to_tool())

    def _turn(self) -> None:
        """The arrows get the tool's axes and rings to turn them; or lose both."""
        self._gizmo.disable_rotations = not self._turns.value
        state = self.graph.state()
        R = np.eye(3) if state is None else tool_now(self.graph.vehicle, *state)[1]
        self.place_gizmo((self.gizmo[0], R))

    def _to_tool(self) -> None:
        if (state := self.graph.state()) is not None:
            self.place_gizmo(tool_now(self.graph.vehicle, *state))

    def _try(self, work: Callable[[], None]) -> None:
        """Faults of the project's own are shown on the page."""
        try:
            work()
        except UvmsError as fault:
            self._answer.content = f"**{fault}**"


def _setting(graph: Graph, first: Moment) -> Setting:
    """The vehicle, and around it what its planner knows of."""
    shown = first.estimated or first.true
    middle = np.zeros(3) if shown is None else shown.position
    return Setting(graph.vehicle, graph.planner.obstacles, middle=middle)


def _text(found: Preview) -> str:
    if found.refusal:
        return f"**refused**: {found.refusal}"
    return f"planned: {found.seconds:.1f} s; the green ghost is where it ends"
