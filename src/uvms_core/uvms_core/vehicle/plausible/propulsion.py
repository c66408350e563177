"""What the thrusters can and cannot do with the vehicle."""

from collections.abc import Iterator

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle.plausible.extents import bare_hull_extent
from uvms_core.vehicle.plausible.finding import Finding, graded
from uvms_core.vehicle.reach import one_way_texts
from uvms_core.vehicle.resistance import axis_resistance
from uvms_core.vehicle.statics import buoyancy, thruster_columns, wrench_reach
from uvms_core.vehicle.vehicle import Vehicle

AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")

FAR_ODD, FAR_IMPOSSIBLE = 2.0, 50.0
"""Distance of a thruster from the body origin over the hull's half diagonal: thin outriggers reach
many sizes of a small hull, and a hundred is centimetres."""

SPAN = 1e-6
"""Part of an axis outside the span of the thrusters that counts, with lengths scaled to the hull's:
directions are printed with six digits."""

FASTEST = 15.0
"""Thrusters do not work beyond, m/s: they cavitate; torpedoes with pump jets reach 30."""

SLOWEST_DRIVE = 10.0
"""Time constant of a thruster and time from rest to its limit, s: propellers take below one."""


WIDEST_DEAD_ZONE = 0.3
"""Share of the command without thrust: drives for propellers have a few hundredths to a tenth."""

GREATEST_LEAST = 0.2
"""Least thrust over the limit: a propeller that turns slowly gives a hundredth."""


def check_propulsion(vehicle: Vehicle) -> Iterator[Finding]:
    """Positions, reach, depth keeping, speed, response and dead zones."""
    yield from _positions(vehicle)
    yield from _reach(vehicle)
    yield from _depth(vehicle)
    yield from _speed(vehicle)
    yield from _response(vehicle)
    yield from _dead_zones(vehicle)


def axes_out_of_reach(vehicle: Vehicle) -> tuple[str, ...]:
    """Axes along which the thrusters cannot push without pushing along another as well."""
    span = _span(vehicle)
    outside = np.linalg.norm(np.eye(6) - span @ span.T, axis=0)
    return tuple(axis for axis, part in zip(AXES, outside, strict=True) if part > SPAN)


def axes_pushed_one_way(vehicle: Vehicle) -> tuple[str, ...]:
    """Axes along which the thrusters cannot push alone in both directions, `heave (only +)`.

    Without a sign: in neither, although thrusters that reversed could. Besides those out of reach.
    """
    lower = np.array([thruster.astern_n for thruster in vehicle.thrusters])
    upper = np.array([thruster.ahead_n for thruster in vehicle.thrusters])
    return tuple(one_way_texts(_columns(vehicle), lower, upper, AXES))


def _columns(vehicle: Vehicle) -> Array:
    """Wrench (6, m) of each thruster, moments over the hull's size: numbers without a unit."""
    size = bare_hull_extent(vehicle.hull).largest_m
    return thruster_columns(vehicle) / np.array([1.0] * 3 + [size] * 3)[:, None]


def _span(vehicle: Vehicle) -> Array:
    """Orthonormal columns (6, rank) that span all wrenches of the thrusters."""
    basis, sizes, _ = np.linalg.svd(_columns(vehicle), full_matrices=False)
    return basis[:, sizes > SPAN * sizes[0]]


def _positions(vehicle: Vehicle) -> Iterator[Finding]:
    size = float(np.linalg.norm(bare_hull_extent(vehicle.hull).half_m))
    for number, thruster in enumerate(vehicle.thrusters):
        distance = float(np.linalg.norm(thruster.position_m))
        yield from graded(
            f"thrusters.{number}.position_m",
            distance / size,
            FAR_ODD,
            FAR_IMPOSSIBLE,
            f"{thruster.name} is {distance:.4g} m from the body origin, more than {{bound}} times"
            f" the hull's {size:.3g} m from centre to corner",
            "a thruster is mounted on the hull",
        )


def _reach(vehicle: Vehicle) -> Iterator[Finding]:
    if missing := axes_out_of_reach(vehicle):
        directions = np.array([thruster.direction for thruster in vehicle.thrusters])
        parallel = bool((np.abs(directions @ directions[0]) > 1.0 - SPAN).all())
        how = ", all along one line," if parallel else ""
        yield Finding(
            "thrusters",
            f"the {vehicle.n_thrusters} of them{how} cannot push along {', '.join(missing)} alone:"
            f" the layout has rank {_span(vehicle).shape[1]}, below 6; only weight, buoyancy and"
            " damping act there",
        )
    if one_way := axes_pushed_one_way(vehicle):
        yield Finding(
            "thrusters",
            f"with thrusters that do not reverse they cannot push both ways along"
            f" {', '.join(one_way)} alone; what is asked for there leaves a residual, or weight,"
            " buoyancy and damping must give it",
        )


def _depth(vehicle: Vehicle) -> Iterator[Finding]:
    """Net weight against the thrust that can hold it."""
    state, (up, down) = buoyancy(vehicle), wrench_reach(vehicle)
    weight = abs(state.net_weight_n)
    lift = float(up[2] if state.net_weight_n > 0.0 else down[2])
    verb = "sinks" if state.net_weight_n > 0.0 else "rises"
    share = abs(state.mass_kg / state.displaced_kg - 1.0) if state.displaced_kg else 0.0
    text = (
        f"vehicle and arm have {state.mass_kg:.5g} kg and displace {state.displaced_kg:.5g} kg: it"
        f" {verb} with {weight:.4g} N"
    )
    if weight > lift:
        yield Finding(
            "hull.mass_kg",
            f"{text}, more than the {lift:.4g} N that the thrusters can push up or down; it cannot"
            " hold its depth (a crawler, a lander or a buoy does so on purpose)",
        )
    elif weight > HELD_PART * lift:
        yield Finding(
            "hull.mass_kg",
            f"{text}, {weight / lift:.0%} of the {lift:.4g} N of the thrusters, more than"
            f" {HELD_PART:.0%}; little is left for control ({share:.1%} of its displacement)",
        )


HELD_PART = 0.5
"""Part of the vertical thrust that holding the depth may take."""


def _speed(vehicle: Vehicle) -> Iterator[Finding]:
    push = np.maximum(*wrench_reach(vehicle))
    linear, quadratic = axis_resistance(vehicle.hull, vehicle.environment.water_density_kg_m3)
    for k, (d, dd) in enumerate(zip(linear, quadratic, strict=True)):
        if push[k] > 0.0 and d == 0.0 and dd == 0.0:
            yield Finding(
                "hull.quadratic_damping",
                f"neither linear nor quadratic damping in {AXES[k]}, where the thrusters push: no"
                " water brakes it",
            )
    speed = terminal_speed(float(push[0]), linear[0], quadratic[0])
    if np.isfinite(speed) and speed > FASTEST:
        yield Finding(
            "hull.quadratic_damping",
            f"{push[0]:.4g} N drive it at {speed:.3g} m/s, faster than {FASTEST:g}; is the damping"
            " complete?",
        )


def terminal_speed(force: float, linear: float, quadratic: float) -> float:
    """Speed where d v + d' v^2 is the force, m/s or rad/s; infinite without damping."""
    if force <= 0.0:
        return 0.0
    root = linear + float(np.sqrt(linear**2 + 4.0 * quadratic * force))
    return 2.0 * force / root if root > 0.0 else float("inf")


def _response(vehicle: Vehicle) -> Iterator[Finding]:
    for number, thruster in enumerate(vehicle.thrusters):
        for field, time in (
            ("time_constant_s", thruster.time_constant_s),
            ("slew_limit_n_s", thruster.greatest_n / thruster.slew_limit_n_s),
        ):
            if time > SLOWEST_DRIVE:
                yield Finding(
                    f"thrusters.{number}.{field}",
                    f"{thruster.name} takes {time:.3g} s to its thrust, more than"
                    f" {SLOWEST_DRIVE:g}; a propeller takes below one",
                )


def _dead_zones(vehicle: Vehicle) -> Iterator[Finding]:
    for number, thruster in enumerate(vehicle.thrusters):
        path = f"thrusters.{number}"
        if thruster.dead_zone > WIDEST_DEAD_ZONE:
            yield Finding(
                f"{path}.dead_zone",
                f"{thruster.name} has no thrust up to {thruster.dead_zone:.0%} of its command, more"
                f" than {WIDEST_DEAD_ZONE:.0%}; drives have a few per cent",
            )
        least = max(thruster.least_n[1], -thruster.least_n[0])
        if least > GREATEST_LEAST * thruster.greatest_n:
            yield Finding(
                f"{path}.{'dead_zone' if thruster.curve is None else 'curve'}",
                f"{thruster.name} gives none or {least:.3g} N, more than {GREATEST_LEAST:.0%} of"
                f" its {thruster.greatest_n:.4g} N; nothing in between can be held",
            )
