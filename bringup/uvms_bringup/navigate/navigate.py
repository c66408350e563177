"""`uvms navigate`: what the command does, from the log to the summary."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.writer import LogWriter
from uvms_bringup.errors import BringupError, ScenarioError
from uvms_bringup.navigate.against_reference import Track, errors, read_track
from uvms_bringup.navigate.bag import Bag, open_bag
from uvms_bringup.navigate.estimate import Estimation
from uvms_bringup.navigate.feed import LOG, Feed, Stamps
from uvms_bringup.navigate.topic_map import TopicMap, topic_map
from uvms_bringup.scenario import Scenario
from uvms_core import topics
from uvms_core.config import validated
from uvms_core.errors import ConfigError
from uvms_core.sensors import INERTIAL
from uvms_core.signals import Odometry, to_nanoseconds, to_seconds
from uvms_core.vehicle import Vehicle, dump_vehicle, load_vehicle
from uvms_core.vehicle.loader import vehicle_from_data
from uvms_dynamics.simulation import PlantConfig
from uvms_observer import NavigationConfig, NavigationFilter
from uvms_observer.arrivals import used_sensors
from uvms_observer.navigation.begin.resume import LOST_DEPTH_M, LOST_SPEED_M_S, lost

ABSOLUTE = ("gps", "position_fix")
"""Kinds of sensors that say where the vehicle is."""
NAME = "odometry.mcap"


class NavigateError(BringupError):
    """A log cannot be navigated."""


@dataclass(frozen=True)
class Setup:
    """With what a log is navigated."""

    vehicle: Vehicle
    config: NavigationConfig
    period: int  # ns


def setup_of(bag: Bag, vehicle: str | None) -> Setup:
    """Of the run, if the log is one of ours; otherwise the named vehicle and the defaults.

    Raises:
        NavigateError: the log does not say which vehicle it is of, and nobody else does.
    """
    navigation, plant = NavigationConfig(), PlantConfig()
    if bag.is_ours and bag.run is not None:
        what = f"log {bag.path}: config.yaml"
        scenario = validated(Scenario, bag.run.configuration(), what, ScenarioError)
        navigation, plant = scenario.navigation, scenario.plant
        found = bag.run.vehicle if vehicle is None else load_vehicle(vehicle)
    elif vehicle is None:
        raise NavigateError(
            f"log {bag.path}: is not of a run of this system, so that it does not say which vehicle"
            " it is of: name its file by --vehicle"
        )
    else:
        found = load_vehicle(vehicle)
    config = navigation.model_copy(update={"source": "sensors"})
    return Setup(found, config, to_nanoseconds(plant.control_period_s))


def navigate(
    log: str | Path,
    vehicle: str | None,
    given: Mapping[str, str],
    output: str | Path | None,
    stamps: Stamps = "header",
) -> dict[str, Any]:
    """Run the filter over a log, write odometry and summary, and return the summary.

    Args:
        log: file or folder.
        vehicle: name or file; None: that of the log.
        given: topics by key.
        output: folder; None: beside the log.
        stamps: which time of a message is that of its measurement.

    Raises:
        UvmsError: the log, the vehicle or the topics do not fit; says what would.
    """
    bag = open_bag(log)
    setup = setup_of(bag, vehicle)
    wanted = topic_map(bag, setup.vehicle, given)
    if not bag.is_ours:
        setup = replace(setup, vehicle=_as_recorded(setup.vehicle, wanted))
    feed = Feed(bag, wanted, setup.vehicle, setup.period, stamps)
    track = None if wanted.reference is None else read_track(bag, wanted.reference, stamps == LOG)
    start = None if bag.is_ours else _start(feed, wanted, setup, track)
    estimation = _estimation(bag, wanted, setup, start)
    folder = Path(output) if output is not None else _beside(bag.path)
    estimates = _record(folder, bag, setup, feed, estimation)
    if not estimates:
        raise NavigateError(_nothing(bag, wanted, feed))
    summary = _summary(bag, setup, wanted, feed, estimation, estimates, track)
    text = json.dumps(summary, indent=2)
    (folder / "summary.json").write_text(text + "\n", encoding="utf-8")
    return summary | {"output": str(folder)}


def _as_recorded(vehicle: Vehicle, wanted: TopicMap) -> Vehicle:
    """The vehicle without the sensors of which the log has nothing: nobody waits for those.

    Raises:
        VehicleFileError, ConfigError: it cannot be navigated without.
    """
    missing = [each.name for each in used_sensors(vehicle) if each.name not in wanted.sensors]
    if not missing:
        return vehicle
    without = {f"sensors.{name}": None for name in missing}
    return vehicle_from_data(vehicle.model_dump(warnings=False), vehicle.name, without)


def _beside(path: Path) -> Path:
    return path.parent / f"{path.stem}-navigation"


def _start(feed: Feed, wanted: TopicMap, setup: Setup, track: Track | None) -> Odometry:
    """Nowhere in particular; where nothing measures the position, where the reference begins."""
    first, _ = feed.span
    stamp = -(-first // setup.period) * setup.period
    position = np.array(setup.config.initial_position_m)
    used = [each for each in used_sensors(setup.vehicle) if each.name in wanted.sensors]
    if any(sensor.type.name in ABSOLUTE for sensor in used):
        return lost(stamp, position)
    begin = position * [1.0, 1.0, 0.0] if track is None else track.position[0]
    known = setup.config.initial_position_std_m
    pose = np.diag([known, known, LOST_DEPTH_M, np.pi, np.pi, np.pi]) ** 2
    if track is not None:
        pose[2, 2] = known**2
    twist = np.diag([LOST_SPEED_M_S] * 3 + [1.0] * 3) ** 2
    level = np.array([0.0, 0.0, 0.0, 1.0])
    return Odometry(stamp, begin, level, np.zeros(6), pose, twist)


def _estimation(bag: Bag, wanted: TopicMap, setup: Setup, start: Odometry | None) -> Estimation:
    """The filter, or NavigateError with what it lacks."""
    try:
        return Estimation(setup.vehicle, setup.config, setup.period, start)
    except ConfigError as fault:
        raise NavigateError(
            "; ".join([f"log {bag.path}: {fault}", *wanted.left_out.values()])
        ) from fault


def _record(
    folder: Path, bag: Bag, setup: Setup, feed: Feed, estimation: Estimation
) -> list[Odometry]:
    """Write all outputs to the folder's log; returns the estimates."""
    estimates = []
    with LogWriter(folder / NAME, overwrite=True) as log:
        log.attach("vehicle.yaml", dump_vehicle(setup.vehicle), "application/yaml")
        log.metadata("uvms_navigate", {"log": str(bag.path), "filter": setup.config.filter})
        names = setup.vehicle.joint_names, setup.vehicle.thruster_names
        writer = SignalWriter(log, *names)
        for topic, signal in estimation.outputs(feed):
            writer.write(topic, signal)
            if topic is topics.ODOMETRY:
                estimates.append(signal)
    return estimates


def _nothing(bag: Bag, wanted: TopicMap, feed: Feed) -> str:
    topic = wanted.sensors[INERTIAL.name]
    why = feed.first_fault.get(topic, "there is no message")
    return f"log {bag.path}: no message of {topic} can be used, so that there is no estimate: {why}"


def _summary(
    bag: Bag,
    setup: Setup,
    wanted: TopicMap,
    feed: Feed,
    estimation: Estimation,
    estimates: list[Odometry],
    track: Track | None,
) -> dict[str, Any]:
    part = estimation.part
    trouble, own = part.trouble(), part.filter
    health: dict[str, Any] = own.health() if isinstance(own, NavigationFilter) else {}
    nis: dict[str, float] = own.mean_nis() if isinstance(own, NavigationFilter) else {}
    summary: dict[str, Any] = {
        "log": str(bag.path),
        "log_fault": bag.fault,
        "vehicle": setup.vehicle.name,
        "notes": [*wanted.notes, *_axes_note(wanted, track)],
        "topics": wanted.sensors,
        "messages": {name: bag.counts[topic] for name, topic in wanted.sensors.items()},
        "unreadable": dict(feed.unreadable),
        "first_unreadable": feed.first_fault,
        "duration_s": to_seconds(estimates[-1].stamp - estimates[0].stamp),
        "estimates": len(estimates),
        "restarts": estimation.restarts,
        "health": {name: str(getattr(one, "value", one)) for name, one in health.items()},
        "trouble": "" if trouble is None else trouble.text,
        "normalized_innovation_squared": nis,
        "counts": estimation.status(),
        "reference": wanted.reference,
    }
    found = None if track is None else errors(estimates, track)
    if wanted.reference is not None and found is None:
        summary["notes"] += [
            f"reference: {wanted.reference} has no pose at the time of an estimate"
        ]
    return summary | (found or {})


def _axes_note(wanted: TopicMap, track: Track | None) -> list[str]:
    if track is None or not track.is_enu:
        return []
    return [
        f"reference: {wanted.reference} in {track.frame!r}, taken for east-north-up and a body"
        " forward-left-up (REP-103)"
    ]
