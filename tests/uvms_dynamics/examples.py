"""One signal of every kind, of random numbers, with the names that its message carries."""

from typing import Any

import numpy as np

from uvms_core import signals, topics
from uvms_core.diagnostics import Status
from uvms_core.topics import Action, Topic

JOINTS = ("swing", "shoulder", "elbow", "wrist")
THRUSTERS = ("main", "side_fore", "side_aft", "up1", "up2", "up3", "up4")


def unit(rng: np.random.Generator, count: int | None = None) -> np.ndarray:
    """Random quaternions of unit length."""
    values = rng.normal(size=(count or 1, 4))
    values /= np.linalg.norm(values, axis=1)[:, None]
    return values if count else values[0]


def stamp(rng: np.random.Generator) -> int:
    return int(rng.integers(0, 2**31 * 10**9))


def reference(rng: np.random.Generator, count: int = 11) -> signals.Reference:
    joints = [rng.normal(size=(count, len(JOINTS))) for _ in range(3)]
    return signals.Reference(
        stamp(rng),
        np.arange(count) * 50_000_000 / 1e9,
        rng.normal(size=(count, 3)),
        unit(rng, count),
        rng.normal(size=(count, 6)),
        rng.normal(size=(count, 6)),
        *joints,
        rng.normal(size=(count, 3)),
        signals.PlannedDisturbance(rng.normal(size=(count, 6)), rng.normal(size=(count, 6))),
    )


def example(kind: type, rng: np.random.Generator) -> Any:
    """A random signal of a kind."""

    def n(*shape: int) -> np.ndarray:
        return rng.normal(size=shape)

    t = stamp(rng)
    makers = {
        int: lambda: t,
        Status: lambda: Status(t, "controller", 1, "slow", {"step_ms": "1.25", "note": "a: b"}),
        signals.ImuSample: lambda: signals.ImuSample(
            t, unit(rng), n(3), n(3), n(3, 3), n(3, 3), n(3, 3)
        ),
        signals.DvlSample: lambda: signals.DvlSample(t, n(3), n(3, 3)),
        signals.PressureSample: lambda: signals.PressureSample(t, float(n(1)[0]), 2.5),
        signals.GpsSample: lambda: signals.GpsSample(t, True, 54.1, -7.3, float(n(1)[0]), n(3, 3)),
        signals.JointStates: lambda: signals.JointStates(t, n(4), n(4), n(4)),
        signals.Odometry: lambda: signals.Odometry(t, n(3), unit(rng), n(6), n(6, 6), n(6, 6)),
        signals.Wrench: lambda: signals.Wrench(t, n(6)),
        signals.DisturbanceBudget: lambda: signals.DisturbanceBudget(
            t,
            n(6),
            n(6),
            n(6),
            n(6),
            signals.Payload(True, 1.5, 0.1, float(n(1)[0]), 0.2, n(3), n(3)),
            signals.ThrusterHealth(n(7), n(7)),
        ),
        signals.Stability: lambda: signals.Stability(t, *n(4).tolist()),
        signals.Reference: lambda: reference(rng),
        signals.JointCommand: lambda: signals.JointCommand(t, n(4)),
        signals.ThrusterCommand: lambda: signals.ThrusterCommand(t, n(7)),
        signals.Allocation: lambda: signals.Allocation(t, n(7), n(6), n(6), n(7) > 0.0, n(7)),
        signals.AppliedThrust: lambda: signals.AppliedThrust(
            t, n(7), n(7), stamp(rng), stamp(rng), True, False
        ),
        signals.BatteryState: lambda: signals.BatteryState(
            t,
            *n(5).astype(np.float32).tolist(),  # its message has 32-bit numbers
        ),
        signals.PathGoal: lambda: signals.PathGoal(
            np.array([0.0, 0.5, 2.0]), n(3, 3), unit(rng, 3)
        ),
        signals.PoseGoal: lambda: signals.PoseGoal(n(3), unit(rng), 2.5, 1.0, 0.25),
        signals.JointGoal: lambda: signals.JointGoal(np.array([1.0, 2.5]), n(2, 4)),
    }
    return makers[kind]()


def names_of(topic: Topic | Action) -> tuple[str, ...]:
    """Names that the topic's values come under."""
    kind = topic.signal if isinstance(topic, Topic) else None
    return THRUSTERS if kind in signals.BY_THRUSTER else JOINTS


def carrying() -> list[Topic]:
    """Topics whose messages turn back into signals."""
    return [topic for topic in topics.ALL if topic.signal is not None and topic is not topics.TF]
