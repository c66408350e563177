"""The work of `uvms added-mass`: solve for the added mass of a body, and report on it."""

import argparse
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from uvms_core.signals import Array
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.locate import vehicle_path
from uvms_dynamics.panel_method import (
    AddedMassEstimate,
    Body,
    PanelMethodError,
    added_mass_yaml,
    estimate,
    mesh_body,
    pose_of,
    shape_body,
    vehicle_body,
)
from uvms_dynamics.panel_method.bodies import FILE_ROW, SEA_WATER
from uvms_dynamics.panel_method.panels import LONG, longest_edge, mean_edge
from uvms_dynamics.panel_method.solids import WORDS
from uvms_dynamics.panel_method.solver import memory_needed

TERMS = ("X", "Y", "Z", "K", "M", "N")


def added_mass(options: argparse.Namespace) -> int:
    """Solve and print; the options are those of `commands/added_mass.py`."""
    body = _body(options)
    with _progress(body) as progress:
        found = estimate(body.levels, body.density, progress)
    print("\n".join(f"# {line}".rstrip() for line in _report(body, found)))
    print(added_mass_yaml(found.matrix))
    return 0


def _body(options: argparse.Namespace) -> Body:
    name, is_shape = options.body, options.body.partition(":")[0] in WORDS
    of_files = {"--scale": options.scale is not None, "--flip": options.flip}
    of_frames = {"--about": options.about is not None, "--rpy": options.rpy is not None}
    if options.vehicle is not None:
        own = {**of_files, **of_frames, "--density": options.density is not None}
        _refuse(own, f"part {name} of a vehicle file, which defines these itself")
        return vehicle_body(load_vehicle(vehicle_path(options.vehicle)), name, options.panels)
    density = SEA_WATER if options.density is None else options.density
    zero = np.zeros(3)
    pose = pose_of(
        zero if options.about is None else options.about,
        zero if options.rpy is None else options.rpy,
    )
    if is_shape or ":" in name:
        _refuse(of_files, f"shape {name}")
        return shape_body(name, pose, density, options.panels)
    if not Path(name).suffix and not Path(name).exists():
        raise PanelMethodError(
            f"{name!r}: no such mesh file or shape; for a part of a vehicle file, name the file"
            " with --vehicle FILE"
        )
    return mesh_body(name, pose, density, options.panels, options.scale, options.flip)


def _refuse(given: dict[str, bool], what: str) -> None:
    if idle := [option for option, is_given in given.items() if is_given]:
        raise PanelMethodError(f"{' and '.join(idle)}: not for {what}")


def _report(body: Body, found: AddedMassEstimate) -> list[str]:
    """Comment lines about the numbers and their accuracy."""
    finest = body.levels[-1]
    middle = ", ".join(f"{value:.4g}" for value in _clean(finest.centroid(), finest.size))
    lines = [
        f"Added mass of {body.name}, potential flow in unbounded water of {body.density:g} kg/m^3",
        "order X Y Z K M N about the frame's origin, written positive: kg, kg m, kg m^2",
        f"volume {found.volume:.6g} m^3 ({body.density * found.volume:.5g} kg of water),"
        f" its centre {middle} m, length {finest.size:.4g} m",
        "",
        f"{'':>20}" + "".join(f"{term:>11}" for term in TERMS),
    ]
    lines += [_row(f"{count} panels", np.diag(matrix)) for count, matrix in found.solved]
    if found.change is not None:
        lines += [_row("extrapolated", np.diag(found.matrix))]
        lines += [_row("  change, %", 100.0 * found.change)]
    for name, matrix in body.rows.items():
        short, _, kind = name.partition(",")
        lines += [_row(short, np.diag(matrix)) + kind]
    return [*lines, "", *_remarks(found), *_frame(body), *_roll(body, found), *_long_edges(body)]


def _frame(body: Body) -> list[str]:
    """A warning if a mesh may not be given in the body frame."""
    points = body.levels[-1].vertices
    if not body.is_mesh or ((points.min(axis=0) <= 0.0) & (points.max(axis=0) >= 0.0)).all():
        return []
    return ["the frame's origin lies outside the body: --about X,Y,Z?"]


def _roll(body: Body, found: AddedMassEstimate) -> list[str]:
    """A note if the file has a roll term that the bare shape lacks."""
    now = body.rows.get(FILE_ROW, np.zeros((6, 6)))[3, 3]
    if found.matrix[3, 3] > 1e-3 * now or now == 0.0:
        return []
    return [
        f"K of the bare shape is 0: the file's {now:.5g} kg m^2 (fins and the like) would be lost;",
        "to keep it, write it into the fourth row",
    ]


def _long_edges(body: Body) -> list[str]:
    triangles = body.levels[0].triangles()
    longest, mean = longest_edge(triangles), mean_edge(triangles)
    if not body.is_mesh or longest < 2.0 * LONG * mean:
        return []
    return [
        f"some panels are long and thin: an edge of {longest:.2g} m where {mean:.2g} m is typical;",
        "a mesh of compact triangles, or a larger --panels, is more accurate",
    ]


def _remarks(found: AddedMassEstimate) -> list[str]:
    lines = [f"asymmetry before it was made symmetric: {found.asymmetry:.1e} of the largest entry"]
    if found.change is None:
        count = 4 * found.solved[-1][0]
        lines += [
            f"convergence: not estimated; --panels {count} would estimate it"
            f" ({_gigabytes(count)}), or a coarser mesh"
        ]
    else:
        worst = int(found.change.argmax())
        lines += [
            f"convergence: extrapolation changes {TERMS[worst]} most, by"
            f" {100.0 * found.change[worst]:.2g} %;",
            "the error left is smaller for a smooth body, up to twice as large with sharp edges",
        ]
    if found.clipped > 1e-6:
        lines += [f"a negative eigenvalue, {found.clipped:.1e} of the largest, was set to zero"]
    return lines


def _gigabytes(count: int) -> str:
    return f"{memory_needed(count) / 1e9:.1g} GB of memory"


def _row(name: str, values: Array) -> str:
    size = float(np.nanmax(np.abs(values)))
    texts = ["-" if np.isnan(value) else f"{value:.5g}" for value in _clean(values, size)]
    return f"{name:>20}" + "".join(f"{text:>11}" for text in texts)


def _clean(values: Array, size: float) -> Array:
    """Values with rounding noise set to zero."""
    return np.where(np.abs(values) < 1e-8 * size, 0.0, values)


@contextmanager
def _progress(body: Body) -> Iterator[Any]:
    """What is being solved, on stderr: a line on a terminal, a line per surface elsewhere."""
    counts = iter([panels.count for panels in body.levels])
    text = ""
    with Progress(
        SpinnerColumn(),
        TextColumn("{task.description}"),
        TimeElapsedColumn(),
        console=Console(stderr=True),
        transient=True,
        disable=not sys.stderr.isatty(),
    ) as bar:
        task = bar.add_task("")

        def show(done: int, total: int) -> None:
            nonlocal text
            if done == 0:
                count = next(counts)
                text = f"{count} panels, up to {_gigabytes(count)}"
                if not sys.stderr.isatty():
                    print(text, file=sys.stderr, flush=True)
            bar.update(task, description=f"{text}: motion {done + 1} of {total}")

        yield show
