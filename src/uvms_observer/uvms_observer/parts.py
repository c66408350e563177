"""Navigation filter and disturbance observer as parts of the loop."""

from collections.abc import Iterator, Sequence

import numpy as np

from uvms_core import topics
from uvms_core.diagnostics import ERROR, WARN, Trouble
from uvms_core.errors import UvmsError
from uvms_core.part import Output, Part
from uvms_core.plugin import create, prepared
from uvms_core.sensors import inertial
from uvms_core.signals import NOTHING_YET, DisturbanceBudget, Odometry, SensorGaps, Wrench
from uvms_core.tick_gate import KEEP, CompanionBefore, Delayed, Previous, Same, Tick
from uvms_core.topics import Topic
from uvms_core.vehicle import Vehicle
from uvms_observer.arrivals import navigation_inputs, used_sensors
from uvms_observer.disturbance import ObserverConfig
from uvms_observer.interfaces import NavigationEstimator, ObserverLaw
from uvms_observer.navigation import NavigationConfig
from uvms_observer.navigation.begin.resume import carried, doubted, fits, is_in_the_middle, lost
from uvms_observer.navigation.trust.sensor_health import Health
from uvms_observer.truth import TruthPart

CERTAIN = 10.0
"""The position is known again within this many std of a GPS fix, and as many metres."""
LOST = Trouble(
    ERROR,
    "started in the middle of a run without an estimate: the position is not known before one is"
    " measured",
)
RESET = Trouble(
    ERROR,
    "reset on request: position and velocity are not known before a position is measured",
)
REMEMBERED = 4
"""Estimates from before that are kept: of the node's start, and of the last jumps of time."""


class NavigationPart(Part):
    """Samples of all sensors and the thrusts in, odometry out, once a control tick.

    Args:
        vehicle: its sensors.
        config: of the filter.
        period: of the control loop, ns.
    """

    outputs = topics.NODES[topics.NAVIGATION].outputs

    def __init__(self, vehicle: Vehicle, config: NavigationConfig, period: int) -> None:
        self._vehicle, self._config = vehicle, config
        self.filter: NavigationEstimator = create(config, vehicle)
        self.every = period
        self.trigger = inertial(vehicle).topic
        self._sensors = {sensor.name: sensor.topic.name for sensor in used_sensors(vehicle)}
        self.inputs = navigation_inputs(vehicle, period)
        self._faults: Sequence[UvmsError] = ()
        self._begun = False
        self._known, self._waits_for = True, ""
        self._unknown = LOST
        self._doubted: Odometry | None = None
        self._certain = CERTAIN * _fix_noise(vehicle) + CERTAIN
        self._remembered: list[Odometry] = []
        self._good: Odometry | None = None
        self.estimate: Odometry | None = None
        """The last one; `restart` drops it, since it may have been invalid."""

    def remember(self, estimate: Odometry) -> None:
        """An estimate from before, to go on from if it fits the time at which the filter begins."""
        self._remembered = [*self._remembered[-REMEMBERED:], estimate]

    def step(self, tick: Tick) -> Iterator[Output]:
        """One step of the filter; samples that it refuses are left out."""
        samples = {name: tick[topic] for name, topic in self._sensors.items()}
        self._good = self.estimate or self._good  # it was valid, or there was a restart
        if not self._begun:
            self._begin(tick.stamp)
        if inform := getattr(self.filter, "inform", None):
            inform(tick[topics.ALLOCATION.name])
        odometry, self._faults = self.filter.step_screened(tick.stamp, samples)
        self._begun = True
        waits_for = getattr(self.filter, "waits_for", None)
        self._waits_for = waits_for() if waits_for is not None else ""
        if self._waits_for:
            names = (topics.ODOMETRY.name,)
            yield topics.ODOMETRY_GAPS, SensorGaps(tick.stamp, names, (NOTHING_YET,))
            return
        self.estimate = odometry
        yield topics.ODOMETRY, odometry
        if not self._known:
            variance = odometry.pose_covariance[0, 0] + odometry.pose_covariance[1, 1]
            self._known = float(np.sqrt(variance)) < self._certain

    def _begin(self, stamp: int) -> None:
        """Start the filter where it was, if that is known, or say that it is not."""
        resume = getattr(self.filter, "resume", None)
        if self._doubted is not None:
            self._known, self._unknown = False, RESET
            if resume is not None:
                resume(doubted(self._doubted, stamp))
            self._doubted = None
        elif estimates := [each for each in self._remembered if fits(each, stamp)]:
            newest = max(estimates, key=lambda each: each.stamp)
            self._known = resume is not None
            if resume is not None:
                resume(carried(newest, stamp))
        elif is_in_the_middle(stamp):
            self._known, self._unknown = False, LOST
            if resume is not None:
                resume(lost(stamp, np.array(self._config.initial_position_m)))

    def restart(self, reason: str) -> None:
        """A filter that goes on from the last good estimate, if that fits its time."""
        if self._good is not None:
            self.remember(self._good)
        self.filter = create(self._config, self._vehicle)
        self._begun, self._known, self._good, self.estimate = False, True, None, None
        self._waits_for = ""

    def withheld(self) -> Sequence[Topic]:
        """The odometry, as long as it would mean nothing."""
        return (topics.ODOMETRY,) if self._waits_for else ()

    def reset(self) -> str:
        """Start the filter anew, as somebody asks who knows that it is wrong; says what follows.

        It begins at the next tick where it was, with nothing known of position and velocity, so
        that the first fix decides. Biases and what it thought of its sensors are forgotten.
        """
        last = self.last
        if last is None:
            return "the filter has not begun yet: there is nothing to reset"
        self.restart(RESET.text)
        self._remembered, self._doubted = [], last
        return RESET.text

    @property
    def last(self) -> Odometry | None:
        """The newest estimate, or that which a reset began from; None before the first."""
        return self.estimate or self._good or self._doubted

    def trouble(self) -> Trouble | None:
        """Where the filter does not know the position, or does without a sensor."""
        if self._waits_for:
            return Trouble(WARN, self._waits_for)
        if not self._known:
            return self._unknown
        found = getattr(self.filter, "trouble", None)
        return found() if found is not None and self._begun else None

    def safe(self, tick: Tick) -> Iterator[Output]:
        """The last good estimate, straight ahead, and less certain; nothing where it is too old."""
        known = [*self._remembered, self._good, self.estimate]
        recent = [
            each for each in known if each is not None and 0 <= tick.stamp - each.stamp <= KEEP
        ]
        if recent:
            newest = max(recent, key=lambda each: each.stamp)
            yield topics.ODOMETRY, carried(newest, tick.stamp)

    def take_faults(self) -> Sequence[UvmsError]:
        """Samples that the last step left out."""
        faults, self._faults = self._faults, ()
        return faults

    def status(self) -> dict[str, int | float | str]:
        """Counters and uncertainty of the filter."""
        status = {**self.filter.status(), **self._out_of_reach()}
        return {_STATUS.get(name, name): value for name, value in status.items()}

    def _out_of_reach(self) -> dict[str, str]:
        """Sensors that cannot give samples where the vehicle is, which is no trouble."""
        health = getattr(self.filter, "health", None)
        silent = {} if health is None or not self._begun else health()
        names = [name for name, each in silent.items() if each is Health.OUT_OF_REACH]
        return {Health.OUT_OF_REACH.name.lower(): ", ".join(names)} if names else {}


def _fix_noise(vehicle: Vehicle) -> float:
    """Std of a GPS fix north and east, m; without a receiver none."""
    return 0.0 if vehicle.sensors.gps is None else vehicle.sensors.gps.horizontal_noise_m


_STATUS = {"refused": "samples_refused", "late": "samples_late"}
"""What the filter counts, apart from what its node does."""


def navigation_part(
    vehicle: Vehicle, config: NavigationConfig, period: int
) -> NavigationPart | TruthPart:
    """The navigation of a scenario: a filter on the sensors, or the truth as a baseline."""
    if config.source == "truth":
        return TruthPart(vehicle, period)
    return NavigationPart(vehicle, config, period)


class ObserverPart(Part):
    """Estimated state and achieved wrench in; disturbance and its budget out, eq. (21)."""

    trigger = topics.ODOMETRY
    outputs = topics.NODES[topics.DISTURBANCE_OBSERVER].outputs

    def __init__(self, vehicle: Vehicle, config: ObserverConfig, period: int) -> None:
        self._vehicle, self._config, self._period = vehicle, config, period
        self._good: Wrench | None = None
        self._last: Wrench | None = None
        self.law = self._make_law()
        self.inputs = {
            topics.ODOMETRY: Same(),
            topics.JOINT_STATES: Delayed(),
            topics.WRENCH_ACHIEVED: Previous(period),
            topics.ALLOCATION: CompanionBefore(period),
        }

    def step(self, tick: Tick) -> Iterator[Output]:
        """One step of the observer."""
        if inform := getattr(self.law, "inform", None):
            inform(tick[topics.ALLOCATION.name])
        budget, total = self.law.step(
            tick[topics.ODOMETRY.name],
            tick[topics.JOINT_STATES.name],
            tick[topics.WRENCH_ACHIEVED.name],
        )
        self._good, self._last = self._last or self._good, total
        yield topics.DISTURBANCE, total
        yield topics.DISTURBANCE_BUDGET, budget

    def restart(self, reason: str) -> None:
        """The observer restarts, with no external wrench."""
        self._last = None  # it may be invalid
        self.law = self._make_law()

    def _make_law(self) -> ObserverLaw:
        law: ObserverLaw = prepared(create(self._config, self._vehicle), self._period)
        return law

    def safe(self, tick: Tick) -> Iterator[Output]:
        """The last good disturbance for a while, then none: a step would jerk the vehicle."""
        last, none = self._last or self._good, np.zeros(6)
        is_recent = last is not None and 0 <= tick.stamp - last.stamp <= KEEP
        total = last.wrench if last is not None and is_recent else none
        yield topics.DISTURBANCE, Wrench(tick.stamp, total)
        yield topics.DISTURBANCE_BUDGET, DisturbanceBudget(tick.stamp, none, none, none)
