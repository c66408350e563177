"""The plant: vehicle, arm, water, thrusters and sensors, advanced one control period at a time."""

import numpy as np

from uvms_core import checks
from uvms_core.errors import ConfigError
from uvms_core.signals import (
    AppliedThrust,
    Array,
    JointCommand,
    ThrusterCommand,
    to_nanoseconds,
    to_seconds,
)
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels.layout import EFFORT
from uvms_dynamics.simulation.battery import Energy
from uvms_dynamics.simulation.drives import ThrusterDrives
from uvms_dynamics.simulation.events import Event, Events, Happened, Schedule, check_events
from uvms_dynamics.simulation.events.kinds import check_payloads
from uvms_dynamics.simulation.events.sensor import SensorEvent
from uvms_dynamics.simulation.integrator import (
    JOINTS,
    System,
    advance,
    make_scratch,
    make_system,
)
from uvms_dynamics.simulation.plant.as_built import as_built
from uvms_dynamics.simulation.plant.brakes import Brakes
from uvms_dynamics.simulation.plant.config import (
    PlantConfig,
    check_waves,
    initial_state,
    steps_in,
)
from uvms_dynamics.simulation.plant.divergence import check_finite
from uvms_dynamics.simulation.plant.effects import EventEffects
from uvms_dynamics.simulation.plant.stability import check_plant
from uvms_dynamics.simulation.plant.supply import Supply
from uvms_dynamics.simulation.plant.truth import (
    PlantTruth,
    pushed,
    true_disturbance,
    true_joints,
    true_odometry,
)
from uvms_dynamics.simulation.sensors import SensorFrame, SensorSuite
from uvms_dynamics.simulation.sensors.mounting import Trajectory
from uvms_dynamics.simulation.thrusters import SHARE
from uvms_dynamics.simulation.water.surroundings import frame_velocity, surroundings


class Plant:
    """One augmented system of 6 + n degrees of freedom, its thrusters and its sensors.

    `sense()` and `truth()` are for the present stamp, `step(...)` advances by one control period.

    Args:
        nominal: the vehicle of the file. The plant's own (`built`) may differ, by the config.
        config: integration, start, water and mismatch.
        seed: of the run.
        events: what happens to it; each at the first control tick at or after its time, a push at
            the nearest plant step.

    Raises:
        ConfigError: periods are not multiples of the step, the step is unstable with the vehicle or
            with a payload, or an event does not fit the vehicle.
    """

    def __init__(
        self, nominal: Vehicle, config: PlantConfig, seed: int, events: Events = ()
    ) -> None:
        self.built = as_built(nominal, config, seed)
        vehicle = self.built.vehicle
        self._vehicle, self._config = vehicle, config
        self._tethered = vehicle.tether is not None
        self._period = to_nanoseconds(config.control_period_s)
        self._step = to_nanoseconds(config.step_s)
        check_events(events, vehicle, self._step, self._period)
        check_waves(vehicle, config)
        check_plant(vehicle, config, events)
        steps = steps_in(self._period, config, "control_period_s")
        self._sensors = SensorSuite(vehicle, seed, lambda p, name: steps_in(p, config, name))
        system = make_system(vehicle, config.flow)
        system.thrusters[:, SHARE] = self.built.thrust_factors
        self._drives = ThrusterDrives(nominal, vehicle)
        self._scratch = make_scratch(system)
        self._brakes = Brakes(vehicle, system, self._scratch)
        self._state = initial_state(vehicle, config)
        self._effects = EventEffects(
            vehicle, self._drift, system, self._state, self._brakes, self._step
        )
        self._supply = Supply(vehicle, config.battery_charge, self._step)
        self._schedule = Schedule(self._step, self._period)
        self._happened: list[Happened] = []
        self._states = np.empty((steps + 1, self._state.shape[0]))
        self._rates = np.empty_like(self._states)
        self._effort = np.zeros(vehicle.n_joints)
        self._stamp = 0
        for event in events:
            self._plan(event)
        self._start()

    @property
    def stamp(self) -> int:
        """Present simulation time, ns."""
        return self._stamp

    def sense(self) -> SensorFrame:
        """All samples of the control period that ends now; at the start, those of t = 0."""
        return self._frame

    def truth(self) -> PlantTruth:
        """True odometry, joints, disturbance and thrust at the present stamp.

        Accelerations are those just before the stamp, under the commands of the past period.
        """
        stamp, state, system = self._stamp, self._state, self._system
        moving = surroundings(system, state, to_seconds(stamp))
        drift = system.current if moving is None else moving.velocity
        disturbance = true_disturbance(
            stamp, system.model, state, self._rate, drift, self._tethered, moving
        )
        return PlantTruth(
            checks.trust(true_odometry(stamp, state, drift)),  # of a state that is finite
            checks.trust(true_joints(stamp, state, self._effort)),
            checks.trust(pushed(disturbance, state, self._effects.push_wrench)),
            checks.trust(self._applied()),
            self._battery,
            drift.copy() if moving is None else drift + moving.orbital[:3],
        )

    @property
    def energy(self) -> Energy | None:
        """Electrical energy that was taken so far; None where the vehicle file does not say."""
        return self._supply.energy

    @property
    def battery_share(self) -> float | None:
        """Share of the battery's charge that is left, 0 to 1; None where there is none."""
        return self._supply.share

    def apply(self, event: Event) -> str:
        """Take an event while the run is on; returns what will happen, in words.

        One whose time has come happens at the present stamp. Raises ConfigError where it does not
        fit the vehicle or the plant as it is, or where its time is past; nothing happens then.
        """
        event.check(self._vehicle)
        event.check_times(self._step, self._period)
        check_payloads((*self._schedule.pending, event), self._effects.holds)
        if to_nanoseconds(event.at_s) < self._stamp:
            raise ConfigError(
                f"at_s {event.at_s:g}: the plant is at {to_seconds(self._stamp):g} s already"
            )
        check_plant(self._vehicle, self._config, (event,))
        self._plan(event)
        self._let_happen()
        return f"at {event.at_s:g} s: {event.text()}"

    def take_happened(self) -> list[Happened]:
        """The events that began or ended since this was last asked, each once."""
        happened, self._happened = self._happened, []
        return happened

    def _plan(self, event: Event) -> None:
        if isinstance(event, SensorEvent):
            self._sensors.add_fault(event)
        self._schedule.add(event)

    def _let_happen(self) -> None:
        self._happened += self._schedule.run(self._stamp, self._effects)

    def _advance(self, thrust: Array, began: int) -> None:
        """The control period that ends at the stamp, in pieces between which pushes change.

        Accelerations at such a step are those just before, as at a control tick.
        """
        first = 0
        for stamp in self._schedule.within(began, self._stamp):
            last = (stamp - began) // self._step
            self._piece(thrust, first, last, stamp)
            self._happened += self._schedule.run(stamp, self._effects)
            first = last
        self._piece(thrust, first, len(self._states) - 1, self._stamp)

    def _piece(self, thrust: Array, first: int, last: int, ends: int) -> None:
        rows = slice(first, last + 1)
        before = self._rates[first].copy() if first else None
        self._integrate(thrust, self._states[rows], self._rates[rows], ends)
        if before is not None:
            self._rates[first] = before

    def _drift(self) -> Array:
        """Velocity (3,) of the water's frame over ground at the present stamp, in the world."""
        return frame_velocity(self._system, to_seconds(self._stamp))

    @property
    def _system(self) -> System:
        return self._effects.system

    def step(self, thruster: ThrusterCommand | None, joints: JointCommand | None) -> None:
        """Advance by one control period under constant commands, cut at the drives' limits.

        None is the safe state, where there is no command to use: no thrust; no torque of the
        drives, and those joints braked that have a brake. It is the same with an empty battery,
        whatever is commanded.

        Raises SignalError for a command of wrong size or that is not finite (the plant then does
        not move), PlantDiverged where the state is no longer finite.
        """
        self._safe = thruster is None, joints is None
        thruster = thruster or ThrusterCommand(self._stamp, np.zeros(self._vehicle.n_thrusters))
        joints = joints or JointCommand(self._stamp, np.zeros(self._vehicle.n_joints))
        checks.check("thruster_command", thruster, m=self._vehicle.thruster_names)
        checks.check("joint_command", joints, n=self._vehicle.joint_names)
        self._commands = thruster, joints
        limit = self._system.model[1 : 1 + self._vehicle.n_joints, EFFORT]
        self._effort = np.clip(joints.effort, -limit, limit)
        self._braked = self._safe[1] or self._supply.is_empty
        if self._supply.is_empty:
            self._effort = np.zeros_like(self._effort)
        began, self._stamp = self._stamp, self._stamp + self._period
        realised = self._drives.realised(thruster.thrust)
        self._advance(np.ascontiguousarray(realised), began)
        stamps = tuple(range(began + self._step, self._stamp + 1, self._step))
        self._frame = self._sample(stamps, self._states[1:], self._rates[1:])
        self._supply.take(self._states, self._effort)
        self._let_happen()
        self._look_at_battery()

    def _applied(self) -> AppliedThrust:
        thruster, joints = self._commands
        return AppliedThrust(
            self._stamp,
            self._state[JOINTS + 2 * self._vehicle.n_joints :].copy(),
            thruster.thrust,
            thruster.stamp,
            joints.stamp,
            *self._safe,
        )

    def _start(self) -> None:
        """Derivative and sensor readings of t = 0, without commands.

        Brakes are released: the drives have taken over before a run begins.
        """
        idle = np.zeros(self._vehicle.n_thrusters)
        self._commands = ThrusterCommand(0, idle), JointCommand(0, self._effort)
        self._safe, self._braked = (True, True), False
        self._integrate(idle, self._states[:1], self._rates[:1], 0)
        self._frame = self._sample((0,), self._states[:1], self._rates[:1])
        self._let_happen()
        self._look_at_battery()

    def _look_at_battery(self) -> None:
        """Its sample, where one is due, and what became of it: without power nothing moves."""
        sample = self._supply.sample(self._stamp)
        self._battery = None if sample is None else checks.trust(sample)
        at_s = to_seconds(self._stamp)
        self._happened += [Happened(self._stamp, at_s, text) for text in self._supply.news()]
        if self._supply.is_empty:
            self._effects.cut_power()

    def _integrate(self, thrust: Array, states: Array, rates: Array, ends: int) -> None:
        """As many steps as the tables have rows after the first; the last is at `ends`, ns."""
        step = to_seconds(self._step)
        began = to_seconds(ends - (len(states) - 1) * self._step)
        if self._braked and self._brakes.exist and len(states) > 1:
            self._brakes.advance(self._state, thrust, step, states, rates, began)
        else:
            system, rows = tuple(self._effects.moving), (tuple(self._scratch), states, rates)
            advance(system, self._state, thrust, self._effort, step, *rows, began)
        self._rate = rates[-1].copy()
        check_finite(self._vehicle, self._config.step_s, ends, states, rates)

    def _sample(self, stamps: tuple[int, ...], states: Array, rates: Array) -> SensorFrame:
        system = self._system
        trajectory = Trajectory(stamps, states, rates, system.current, system.water)
        joints = true_joints(self._stamp, self._state, self._effort)
        return self._sensors.sample(trajectory, joints.position, joints.velocity, joints.effort)
