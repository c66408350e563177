"""What the plant publishes at a tick, in its order: the same on the graph and in the process."""

from collections.abc import Iterator, Sequence

from uvms_core import topics
from uvms_core.part import Output
from uvms_core.topic import Topic
from uvms_dynamics.simulation.plant import PlantTruth, SensorFrame


def plant_outputs(
    stamp: int,
    sensors: SensorFrame,
    truth: PlantTruth,
    sensor_topics: Sequence[tuple[str, Topic]],
) -> Iterator[Output]:
    """Topic and signal of everything at the plant's present stamp, ns.

    The clock comes first. `sensor_topics` is `in_order_of_publication(vehicle)`: the IMU comes
    last, because its sample starts the tick in the graph.
    """
    yield topics.CLOCK, stamp
    yield topics.APPLIED_THRUST, truth.applied
    if truth.battery is not None:
        yield topics.BATTERY_STATE, truth.battery
    yield topics.TRUE_ODOMETRY, truth.odometry
    yield topics.TRUE_JOINT_STATES, truth.joints
    yield topics.TRUE_DISTURBANCE, truth.disturbance
    for joints in sensors.joint_samples:
        yield topics.JOINT_STATES, joints
    if sensors.gaps is not None:
        yield topics.SENSOR_GAPS, sensors.gaps
    for name, topic in sensor_topics:
        for sample in sensors.samples[name]:
            yield topic, sample
