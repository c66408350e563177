"""What the plant publishes at a tick, in its order: the same on the graph and in the process."""

from collections.abc import Iterator

from uvms_core import topics
from uvms_core.part import Output
from uvms_dynamics.simulation.plant import PlantTruth, SensorFrame


def plant_outputs(stamp: int, sensors: SensorFrame, truth: PlantTruth) -> Iterator[Output]:
    """Topic and signal of everything at the plant's present stamp, ns.

    The clock comes first. The IMU comes last, because its sample sets the tick going through the
    graph: what belongs to the tick is under way by then.
    """
    yield topics.CLOCK, stamp
    yield topics.TRUE_ODOMETRY, truth.odometry
    yield topics.TRUE_JOINT_STATES, truth.joints
    yield topics.TRUE_DISTURBANCE, truth.disturbance
    yield topics.JOINT_STATES, sensors.joints
    for topic, samples in (
        (topics.DVL, sensors.dvl),
        (topics.PRESSURE, sensors.pressure),
        (topics.GPS, sensors.gps),
        (topics.IMU, sensors.imu),
    ):
        for sample in samples:
            yield topic, sample
