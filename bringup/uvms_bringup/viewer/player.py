"""The clock of a scene that is played: runs at a speed, stops, jumps."""

from dataclasses import dataclass

SPEEDS = (0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0)
"""Times real time that the page offers."""


@dataclass
class Player:
    """Time within a run, all in s."""

    start: float
    end: float
    time: float
    playing: bool = False
    speed: float = 1.0

    def advance(self, elapsed: float) -> None:
        """Let wall time pass; at the end it stops."""
        if self.playing:
            self.jump(self.time + self.speed * elapsed)
            self.playing = self.time < self.end

    def jump(self, time: float) -> None:
        """Go to a time, within the run."""
        self.time = min(max(time, self.start), self.end)

    def toggle(self) -> None:
        """Play, from the start where it stands at the end; or stop."""
        if not self.playing and self.time >= self.end:
            self.time = self.start
        self.playing = not self.playing
