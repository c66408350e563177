"""Added mass of a surface in unbounded fluid by capytaine's boundary element method."""

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.panel_method.checks import without_slivers
from uvms_dynamics.panel_method.errors import PanelMethodError
from uvms_dynamics.panel_method.optional import optional
from uvms_dynamics.panel_method.panels import Panels

BYTES_PER_PAIR = 64
"""Peak memory per pair of panels: two complex matrices, their real parts and a decomposition."""

Progress = Callable[[int, int], None]
"""Called with the number of motions solved, and their total."""


def memory_needed(count: int) -> float:
    """Peak memory of a solution with `count` panels, bytes."""
    return float(BYTES_PER_PAIR * count**2)


def memory_available() -> float:
    """Memory that may be used now, bytes; infinite where the system does not report it."""
    try:
        with open("/proc/meminfo", encoding="ascii") as file:
            lines = dict(line.split(":", 1) for line in file)
        return 1024.0 * float(lines["MemAvailable"].split()[0])
    except (OSError, KeyError, ValueError):
        return float("inf")


def solve(panels: Panels, density: float, progress: Progress | None = None) -> Array:
    """Added mass (6, 6) as computed from the panels, neither symmetrised nor extrapolated.

    Column j is the fluid's force and moment per unit acceleration j, order X Y Z K M N, in the
    panels' frame about its origin, SI, written positive. Potential flow without free surface and
    bottom (`free_surface=inf`, `water_depth=inf`: only the Rankine source 1/r, so that
    nothing depends on frequency and no panel lies above the water), potential formulation.
    """
    capytaine = optional("capytaine")
    _check_memory(panels.count)
    length = panels.volume() ** (1.0 / 3.0)
    body = _unit_body(capytaine, without_slivers(panels), length)
    matrix = np.empty((6, 6))
    with _quiet():
        solver = _solver(capytaine)
        for column, motion in enumerate(body.dofs):
            if progress is not None:
                progress(column, 6)
            matrix[:, column] = _column(capytaine, solver, body, motion)
    units = np.array([1.0, 1.0, 1.0, length, length, length])
    return density * length**3 * np.outer(units, units) * matrix


def _unit_body(capytaine: Any, panels: Panels, length: float) -> Any:
    """The body at volume 1 m^3: capytaine's tolerances are meant for bodies of that size."""
    faces = [[*row[:3]] if row[2] == row[3] else [*row] for row in panels.faces.tolist()]
    mesh = capytaine.Mesh(panels.vertices / length, faces, auto_clean=False, auto_check=False)
    dofs = capytaine.rigid_body_dofs(rotation_center=(0.0, 0.0, 0.0))
    return capytaine.FloatingBody(mesh=mesh, dofs=dofs, name="body")


def _solver(capytaine: Any) -> Any:
    """Solver with the smallest table of wave integrals, which unbounded fluid does not use."""
    table = {"tabulation_nr": 2, "tabulation_nz": 2, "tabulation_nb_integration_points": 3}
    rankine = capytaine.Delhommeau(**table, tabulation_cache_dir=None)
    engine = capytaine.DefaultMatrixEngine(green_function=rankine)
    return capytaine.BEMSolver(engine=engine, method="direct")


def _column(capytaine: Any, solver: Any, body: Any, motion: str) -> list[float]:
    problem = capytaine.RadiationProblem(
        body=body, radiating_dof=motion, free_surface=np.inf, water_depth=np.inf, rho=1.0
    )
    try:
        force = solver.solve(problem, keep_details=False).added_mass
    except Exception as fault:  # capytaine and LAPACK raise errors of many kinds
        raise PanelMethodError(
            f"capytaine finds no solution for {motion.lower()}: {fault}. Do panels overlap?"
        ) from fault
    return [force[name] for name in body.dofs]


def _check_memory(count: int) -> None:
    needed, available = memory_needed(count), memory_available()
    if needed > available:
        fits = int((available / BYTES_PER_PAIR) ** 0.5)
        raise PanelMethodError(
            f"{count} panels need about {needed / 1e9:.1f} GB, {available / 1e9:.1f} GB are free:"
            f" at most {fits} panels fit. Use a coarser mesh (decimate it with MeshLab or Blender)"
            " or a smaller --panels"
        )


@contextmanager
def _quiet() -> Iterator[None]:
    """Without capytaine's remarks on the table of wave integrals, which is not used here."""
    logger = logging.getLogger("capytaine")
    level = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(level)
