"""The page: a scene with a time line, cameras, switches and plots."""

import time as clock
from collections.abc import Callable
from dataclasses import dataclass

import viser

from uvms_bringup.viewer.cameras import FOLLOWING, FREE, PRESETS, WIDE, view_of
from uvms_bringup.viewer.drawing import Drawing, light
from uvms_bringup.viewer.elements import Places
from uvms_bringup.viewer.front_page import (
    AUTO,
    CHOICE,
    own_server,
    stop_quietly,
    viser_page,
    with_ours,
)
from uvms_bringup.viewer.log_source import LogSource
from uvms_bringup.viewer.moment import Moment, tool_pose
from uvms_bringup.viewer.player import SPEEDS, Player
from uvms_bringup.viewer.scene_model import SceneModel

FRAME_S = 1.0 / 30.0
"""Between two frames of the page."""
TOLD_S = 0.2
"""Between two updates of the panels while the run plays: text that changes faster is not read, and
costs a page more than the scene.
"""
HOST = "127.0.0.1"
"""The page is for this machine alone unless the user says otherwise."""
LAYERS = {
    "true vehicle (ghost)": ("true",),
    "thrusts": ("estimated/thrust_",),
    "disturbance": ("estimated/force_",),
    "travelled path": ("travelled_", "trail"),
    "asked and planned path": ("asked_path", "planned_path", "target"),
    "error of the estimate": ("error_",),
    "sensor beams and views": ("estimated/beam_", "estimated/view_"),
    "water and tether": ("current", "tether"),
}
"""Switches of the page, and what the names of their nodes begin with."""


@dataclass(frozen=True)
class Site:
    """Where a page is served, and the quality that its address asks for."""

    host: str = HOST
    port: int = 8080
    quality: str = AUTO


class Page:
    """A scene on a page in the browser, whoever says what happens in it."""

    def __init__(
        self, model: SceneModel, first: Moment, site: Site, title: str, front: str
    ) -> None:
        self.model, self._quality = model, site.quality
        self.server, self._folder = own_server(front, site.host, site.port, title)
        self.server.gui.configure_theme(show_logo=False, show_share_button=False)
        self.places: Places = model.all_places(first)
        light(self.server.scene)
        self.drawing = Drawing(self.server.scene, model.nodes, model.still, model.line_m)
        self.drawing.show(self.places)
        self._presets: dict[int, str] = {}
        view = view_of(WIDE, model, self.places)
        self.server.initial_camera.position = view.position
        self.server.initial_camera.look_at = view.look_at

    @property
    def address(self) -> str:
        """Where the page is."""
        query = "" if self._quality == AUTO else f"/?quality={self._quality}"
        return f"http://{self.server.get_host()}:{self.server.get_port()}{query}"

    def close(self) -> None:
        """End the server."""
        stop_quietly(self.server)
        self._folder.cleanup()

    def look_from(self, preset: str) -> None:
        """Put the cameras of everybody who looks to a preset."""
        for client in self.server.get_clients().values():
            self._presets[client.client_id] = preset
            self._look(client, preset)

    def add_cameras(self) -> None:
        """Buttons for the presets."""
        with self.server.gui.add_folder("Camera"):
            buttons = self.server.gui.add_button_group("from", PRESETS)

        @buttons.on_click
        def _(event: viser.GuiEvent) -> None:
            if event.client is not None:
                self._presets[event.client.client_id] = buttons.value
                self._look(event.client, buttons.value)

    def add_switches(self) -> None:
        """Check boxes that show and hide parts of the scene."""
        with self.server.gui.add_folder("Show", expand_by_default=False):
            for title, starts in LAYERS.items():
                names = [name for name in self.model.nodes if name.startswith(starts)]
                if "/" not in starts[0]:
                    names = [name for name in names if "/" not in name]
                if names:
                    self._switch(title, names)
            self.server.gui.add_html(CHOICE)

    def _switch(self, title: str, names: list[str]) -> None:
        box = self.server.gui.add_checkbox(title, True)
        box.on_update(lambda _: self.drawing.switch(names, box.value))

    def show(self, moment: Moment) -> None:
        """Draw a moment, and let the cameras that follow go along."""
        self.places |= (moved := self.model.places(moment))
        with self.server.atomic():
            self.drawing.show(moved)
        for client in self.server.get_clients().values():
            preset = self._presets.get(client.client_id, FREE)
            if preset in FOLLOWING:
                self._look(client, preset)

    def _look(self, client: viser.ClientHandle, preset: str) -> None:
        if preset == FREE:
            return
        view = view_of(preset, self.model, self.places)
        with client.atomic():
            client.camera.position = view.position
            client.camera.look_at = view.look_at


class LogPage(Page):
    """A log on a page, with its time line and plots."""

    def __init__(self, source: LogSource, site: Site) -> None:
        first, over = source.moment(source.start_s), source.overview
        front = with_ours(viser_page(), over.times, over.plots())
        super().__init__(SceneModel(source.setting), first, site, f"UVMS: {source.name}", front)
        self.source = source
        self.player = Player(source.start_s, source.end_s, source.start_s)
        self._drawn, self._told = (source.start_s, False), 0.0
        self._add_time_line()
        self.add_cameras()
        self.add_switches()

    def serve(self, stopped: Callable[[], bool] = lambda: False) -> None:
        """Play until stopped."""
        before = clock.monotonic()
        while not stopped():
            clock.sleep(FRAME_S)
            now = clock.monotonic()
            self.step(now - before)
            before = now

    def step(self, elapsed: float) -> None:
        """Let wall time pass, s, and draw what has changed."""
        self.player.advance(elapsed)
        if (state := (self.player.time, self.player.playing)) == self._drawn:
            return
        self._drawn = state
        moment = self.source.moment(self.player.time)
        self.show(moment)
        now = clock.monotonic()
        if now - self._told > TOLD_S or not self.player.playing:
            self._told = now
            self._tell(moment)

    def _tell(self, moment: Moment) -> None:
        """Bring the panels up to a moment."""
        self._slider.value = moment.time  # type: ignore[misc]  # viser assigns by __setattr__
        self._play.label = "Pause" if self.player.playing else "Play"
        self._status.content = status_text(self.source, moment)

    def _add_time_line(self) -> None:
        gui, player = self.server.gui, self.player
        with gui.add_folder("Time"):
            self._play = gui.add_button("Play")
            self._slider = gui.add_slider(
                "time [s]", player.start, player.end, 0.05, player.start, marks=self._marks()
            )
            speed = gui.add_dropdown(
                "speed", [f"{each:g} x" for each in SPEEDS], initial_value="1 x"
            )
            if self.source.events:
                jump = gui.add_button_group("event", ("previous", "next"))
                jump.on_click(lambda _: self._jump(jump.value == "next"))
            self._status = gui.add_markdown(status_text(self.source, self.source.moment(0.0)))
        self._play.on_click(lambda _: player.toggle())
        speed.on_update(lambda _: setattr(player, "speed", float(speed.value.split()[0])))

        @self._slider.on_update
        def _(event: viser.GuiEvent) -> None:
            if event.client is not None:  # a person, not the player
                player.jump(self._slider.value)

    def _marks(self) -> tuple[tuple[float, str], ...]:
        return tuple((at, "▲") for at, _ in self.source.events)

    def _jump(self, forward: bool) -> None:
        times = sorted(at for at, _ in self.source.events)
        later = [at for at in times if at > self.player.time]
        earlier = [at for at in times if at < self.player.time]
        if forward and later:
            self.player.jump(later[0])
        elif not forward and earlier:
            self.player.jump(earlier[-1])


def status_text(source: LogSource, moment: Moment) -> str:
    """A few lines about a moment: time, tool off its target, last event."""
    lines = [f"**{moment.time:.2f} s** of {source.end_s:.10g} s"]
    shown = moment.true or moment.estimated
    if shown is not None and moment.target is not None:
        off = 1e3 * (tool_pose(source.vehicle, shown)[0] - moment.target)
        lines.append(f"tool off its target: {float((off @ off) ** 0.5):.1f} mm")
    past = [(at, text) for at, text in source.events if at <= moment.time]
    if past:
        lines.append(f"{past[-1][0]:.1f} s: {past[-1][1]}")
    return "\n\n".join(lines)
