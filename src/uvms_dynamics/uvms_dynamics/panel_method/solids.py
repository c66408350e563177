"""Built-in bodies: closed surfaces of any resolution, centred at the origin, length along x."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from typing import ClassVar

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.panel_method.errors import PanelMethodError
from uvms_dynamics.panel_method.panels import Panels
from uvms_dynamics.panel_method.theory import ellipsoid_added_mass, slender_cylinder_added_mass


@dataclass(frozen=True)
class Solid(ABC):
    """A body of given sizes, m, all of them > 0."""

    theory: ClassVar[str] = ""
    """Source of the closed form; empty without one."""

    open_axis: ClassVar[bool] = False
    """Whether the closed form does not cover motion along the x axis."""

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not (math.isfinite(value) and value > 0.0):
                raise PanelMethodError(f"{field.name} {value:g}: must be a length in m, > 0")

    @abstractmethod
    def panels(self, count: int, halvings: int = 0) -> Panels:
        """Surface of about `count` panels, each then halved in both directions, on the surface."""

    def closed_form(self, density: float) -> Array | None:
        """Added mass (6, 6) about the centre from theory, None where there is none."""
        return None


@dataclass(frozen=True)
class Ellipsoid(Solid):
    """An ellipsoid by its full lengths along x, y and z."""

    length_x: float
    length_y: float
    length_z: float
    theory = "Lamb (1932), exact"

    def panels(self, count: int, halvings: int = 0) -> Panels:
        """A sphere's grid around the x axis, stretched; the panels stay flat."""
        x, across = self.length_x, math.sqrt(self.length_y * self.length_z)
        meridian = math.pi / 2.0 * math.hypot(x, across) / math.sqrt(2.0)
        along, around = _counts(count, 0.7 * math.sqrt(meridian / (math.pi * across)))
        angle = np.linspace(0.0, math.pi, along * 2**halvings + 1)
        sphere = revolved(np.stack([np.cos(angle), np.sin(angle)], axis=1), around * 2**halvings)
        half = np.array([self.length_x, self.length_y, self.length_z]) / 2.0
        return Panels(sphere.vertices * half, sphere.faces)

    def closed_form(self, density: float) -> Array:
        """Lamb's ellipsoid."""
        half = np.array([self.length_x, self.length_y, self.length_z]) / 2.0
        return ellipsoid_added_mass(half, density)


@dataclass(frozen=True)
class Cylinder(Solid):
    """A circular cylinder with flat ends, its axis along x."""

    radius: float
    length: float
    theory = "strip theory, an upper bound across the axis"
    open_axis = True

    def panels(self, count: int, halvings: int = 0) -> Panels:
        """Rings that are finer towards the edges, where the flow is fastest."""
        r, half = self.radius, self.length / 2.0
        profile = 2.0 * r + self.length
        along, around = _counts(count, 0.7 * math.sqrt(profile / (2.0 * math.pi * r)))
        end = max(2, round(along * math.sqrt(r) / (2 * math.sqrt(r) + math.sqrt(self.length))))
        side = max(4, along - 2 * end) * 2**halvings
        rim = np.sin(np.linspace(0.0, math.pi / 2.0, end * 2**halvings + 1))
        ends = np.stack([np.full_like(rim, half), r * rim], axis=1)
        middle = np.stack([half * _to_both_ends(side)[::-1], np.full(side + 1, r)], axis=1)
        other = (ends * [-1.0, 1.0])[::-1]
        return revolved(np.concatenate([ends, middle[1:-1], other]), around * 2**halvings)

    def closed_form(self, density: float) -> Array:
        """Strip theory."""
        return slender_cylinder_added_mass(self.radius, self.length, density)


@dataclass(frozen=True)
class Box(Solid):
    """A cuboid by its lengths along x, y and z."""

    length_x: float
    length_y: float
    length_z: float

    def panels(self, count: int, halvings: int = 0) -> Panels:
        """A grid on each side, finer towards the edges."""
        lengths = np.array([self.length_x, self.length_y, self.length_z])
        share = np.sqrt(lengths / lengths.min())
        sides = 2.0 * (share[0] * share[1] + share[1] * share[2] + share[2] * share[0])
        cells = np.maximum(2, np.round(share * math.sqrt(count / sides))).astype(int) * 2**halvings
        return _box([_to_both_ends(n) * size / 2.0 for n, size in zip(cells, lengths, strict=True)])


WORDS = {
    "sphere": "RADIUS",
    "spheroid": "LENGTH,DIAMETER",
    "ellipsoid": "LENGTH_X,LENGTH_Y,LENGTH_Z",
    "cylinder": "RADIUS,LENGTH",
    "box": "LENGTH_X,LENGTH_Y,LENGTH_Z",
}


def parse_solid(text: str) -> Solid:
    """Solid of a text such as `sphere:0.25` or `cylinder:0.05,0.46`, m, axis along x."""
    word, _, numbers = text.partition(":")
    choices = ", ".join(f"{name}:{sizes}" for name, sizes in WORDS.items())
    if word not in WORDS:
        raise PanelMethodError(f"shape {word!r} is unknown; choose one of {choices} (m)")
    try:
        sizes = [float(number) for number in numbers.split(",")]
    except ValueError:
        raise PanelMethodError(f"{text}: must be {word}:{WORDS[word]} with numbers in m") from None
    if len(sizes) != WORDS[word].count(",") + 1:
        raise PanelMethodError(f"{text}: has {len(sizes)} numbers; must be {word}:{WORDS[word]}")
    for name, size in zip(WORDS[word].lower().split(","), sizes, strict=True):
        if not (math.isfinite(size) and size > 0.0):
            raise PanelMethodError(f"{text}: {name} {size:g}: must be a length in m, > 0")
    if word == "sphere":
        return Ellipsoid(*[2.0 * sizes[0]] * 3)
    if word == "spheroid":
        return Ellipsoid(sizes[0], sizes[1], sizes[1])
    return {"ellipsoid": Ellipsoid, "cylinder": Cylinder, "box": Box}[word](*sizes)


def revolved(profile: Array, around: int) -> Panels:
    """Surface of a profile (n, 2) of x and radius that starts and ends on the axis, x decreasing.

    The first and the last point lie on the axis; `around` panels on the circumference.
    """
    angle = np.linspace(0.0, 2.0 * math.pi, around, endpoint=False)
    x, r = profile[1:-1].T
    rings = np.stack(
        [
            np.repeat(x[:, None], around, axis=1),
            r[:, None] * np.cos(angle),
            r[:, None] * np.sin(angle),
        ],
        axis=-1,
    )
    poles = [[profile[0, 0], 0.0, 0.0], [profile[-1, 0], 0.0, 0.0]]
    vertices = np.concatenate([rings.reshape(-1, 3), poles])
    number = np.arange(len(x) * around).reshape(len(x), around)
    beside = np.roll(number, -1, axis=1)
    first, last = np.full(around, number.size), np.full(around, number.size + 1)
    strips = np.stack([number[:-1], number[1:], beside[1:], beside[:-1]], axis=-1)
    front = np.stack([first, number[0], beside[0], beside[0]], axis=-1)
    back = np.stack([last, beside[-1], number[-1], number[-1]], axis=-1)
    return Panels(vertices, np.concatenate([front, strips.reshape(-1, 4), back]))


def _counts(count: int, ratio: float) -> tuple[int, int]:
    """Panels along and around; the latter a multiple of four, so that y and z are equivalent."""
    around = max(8, 4 * round(math.sqrt(count / ratio) / 4.0))
    return max(4, round(count / around)), around


def _to_both_ends(cells: int) -> Array:
    """Points from -1 to 1, closer together towards both ends."""
    return np.sin(np.linspace(-math.pi / 2.0, math.pi / 2.0, cells + 1))


def _box(points: list[Array]) -> Panels:
    corners = []
    for axis in range(3):
        second, third = (axis + 1) % 3, (axis + 2) % 3
        u, v = np.meshgrid(points[second], points[third], indexing="ij")
        for end in (0, -1):
            side = np.empty((*u.shape, 3))
            side[..., axis], side[..., second], side[..., third] = points[axis][end], u, v
            cells = [side[:-1, :-1], side[1:, :-1], side[1:, 1:], side[:-1, 1:]]
            order = cells if end == -1 else cells[::-1]
            corners.append(np.stack(order, axis=2).reshape(-1, 4, 3))
    vertices, number = np.unique(
        np.concatenate(corners).reshape(-1, 3), axis=0, return_inverse=True
    )
    return Panels(vertices, number.reshape(-1, 4))
