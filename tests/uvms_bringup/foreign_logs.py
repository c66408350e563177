"""Logs as other systems record them: messages made from the simulation's truth and raw samples.

Nothing of the project's own conversions is used: axes, frames and the ellipsoid are written out.
"""

from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from scipy.spatial.transform import Rotation

from uvms_bringup.scenario import load_scenario
from uvms_bringup.simulate import simulate
from uvms_core.cdr import Codec

EPOCH = 1_795_000_000_123_456_789
"""A time in 2026, ns, that is no multiple of anything."""
ENU = Rotation.from_matrix([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
FLU = Rotation.from_euler("x", 180.0, degrees=True)
STORES = {"mcap": StoragePlugin.MCAP, "sqlite": StoragePlugin.SQLITE3}
IMU, TWIST = "sensor_msgs/msg/Imu", "geometry_msgs/msg/TwistWithCovarianceStamped"
PRESSURE, FIX = "sensor_msgs/msg/FluidPressure", "sensor_msgs/msg/NavSatFix"
POSE, ODOMETRY = "geometry_msgs/msg/PoseWithCovarianceStamped", "nav_msgs/msg/Odometry"
FIELD, MARINE = "sensor_msgs/msg/MagneticField", "marine_acoustic_msgs/msg/Dvl"
DEFINITION = Path(__file__).parents[1] / "ros/marine_acoustic_msgs/msg/Dvl.msg"
"""Of a message that is not installed here."""


@dataclass(frozen=True)
class Voyage:
    """A run of the simulation: truth at each tick and the samples of the built-in sensors."""

    truth: list[Any]
    samples: dict[str, list[Any]]

    def at(self, times_s):
        """Stamps, positions (k, 3) and attitudes at the ticks next to these times."""
        stamps = np.array([each.stamp for each in self.truth])
        chosen = [self.truth[int(np.abs(stamps - 1e9 * t).argmin())] for t in times_s]
        places = np.array([each.position for each in chosen])
        turns = Rotation.from_quat([each.quaternion for each in chosen])
        return [each.stamp for each in chosen], places, turns


def voyage(seconds=16.0):
    """From the surface to 1.5 m and away, turning, over 16 s."""
    words = [
        "plant.initial_position_m=[5.0, -3.0, 0.1]",
        "navigation.initial_position_m=[5.0, -3.0, 0.1]",
        "goal={pose: {position_m: [2.5, 1.5, 1.4], yaw_deg: 50.0}}",
    ]
    scenario = load_scenario("hover", words, duration_s=seconds, seed=5)
    vehicle = scenario.load_vehicle()
    scenario = scenario.for_vehicle(vehicle)
    truth, samples = [], defaultdict(list)

    def see(tick):
        truth.append(tick.truth.odometry)
        for topic, signal in tick.outputs:
            if topic.name.startswith("sensors/"):
                samples[topic.name.removeprefix("sensors/")].append(signal)

    simulate(scenario, vehicle, scenario.build_goals(vehicle), observe=see)
    return Voyage(truth, dict(samples))


def types():
    """Types as a robot with marine_acoustic_msgs has them."""
    store = get_typestore(Stores.ROS2_JAZZY)
    store.register(get_types_from_msg(DEFINITION.read_text(encoding="utf-8"), MARINE))
    return store


def written(folder, storage, messages):
    """A bag of (topic, type, stamp, plain message), recorded 3 ms late; returns its folder."""
    store, codecs, known = types(), {}, {}
    with Writer(folder, version=9, storage_plugin=STORES[storage]) as bag:
        for topic, kind, stamp, message in sorted(messages, key=lambda each: each[2]):
            if topic not in known:
                known[topic] = bag.add_connection(topic, kind, typestore=store)
                text = store.generate_msgdef(kind, ros_version=2)[0]
                codecs[topic] = Codec(kind, text)
            bag.write(known[topic], EPOCH + stamp + 3_000_000, codecs[topic].encode(message))
    return folder


def set_back(messages, after_s, by_s):
    """The same with stamps that go back at a time; they were recorded as before."""
    by, out = round(1e9 * by_s), []
    for topic, kind, stamp, message in messages:
        if stamp > 1e9 * after_s:
            new = header(stamp - by, message["header"]["frame_id"])
            message = message | {"header": new}
        out.append((topic, kind, stamp, message))
    return out


def header(stamp, frame):
    sec, nanosec = divmod(EPOCH + stamp, 10**9)
    return {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": frame}


def xyz(values):
    return dict(zip("xyz", map(float, values), strict=True))


def xyzw(rotation):
    return dict(zip("xyzw", map(float, rotation.as_quat()), strict=True))


def pose(place, turn, covariance=None):
    both = {"position": xyz(place), "orientation": xyzw(turn)}
    return {"pose": both, "covariance": np.zeros(36) if covariance is None else covariance}


def imu(run, topic, axes="frd", attitude=True):
    """Raw samples of the inertial unit: as our own axes have them, or as REP-103 has them."""
    out, unknown = [], np.array([-1.0, *[0.0] * 8])
    for each in run.samples["imu"]:
        turn = Rotation.from_quat(each.quaternion)
        vectors = each.angular_velocity, each.linear_acceleration
        if axes == "flu":
            turn, vectors = ENU * turn * FLU, [FLU.apply(vector) for vector in vectors]
        message = {
            "header": header(each.stamp, "imu"),
            "orientation": xyzw(turn if attitude else Rotation.identity()),
            "orientation_covariance": np.zeros(9) if attitude else unknown,
            "angular_velocity": xyz(vectors[0]),
            "angular_velocity_covariance": np.zeros(9),
            "linear_acceleration": xyz(vectors[1]),
            "linear_acceleration_covariance": np.zeros(9),
        }
        out.append((topic, IMU, each.stamp, message))
    return out


def dvl(run, topic, axes="frd"):
    out = []
    for each in run.samples["dvl"]:
        velocity = FLU.apply(each.velocity) if axes == "flu" else each.velocity
        twist = {"linear": xyz(velocity), "angular": xyz(np.zeros(3))}
        message = {"twist": twist, "covariance": np.zeros(36)}
        whole = {"header": header(each.stamp, "dvl"), "twist": message}
        out.append((topic, TWIST, each.stamp, whole))
    return out


def marine_dvl(run, topic):
    """x ahead and z the way that it points: forward, right, down; no covariance."""
    out, none = [], [xyz(np.zeros(3))] * 4
    for each in run.samples["dvl"]:
        message = {
            "header": header(each.stamp, "dvl"),
            "velocity_mode": 1,
            "dvl_type": 0,
            "velocity": xyz(each.velocity),
            "velocity_covar": np.full(9, -1.0),
            **dict.fromkeys(("altitude", "course_gnd", "speed_gnd"), 0.0),
            "num_good_beams": 4,
            "sound_speed": 1500.0,
            "beam_ranges_valid": False,
            "beam_velocities_valid": False,
            "beam_unit_vec": none,
        }
        for name in ("range", "range_covar", "beam_quality", "beam_velocity"):
            message[name] = np.zeros(4)
        message["beam_velocity_covar"] = np.full(4, -1.0)
        out.append((topic, MARINE, each.stamp, message))
    return out


def pressure(run, topic):
    return [
        (
            topic,
            PRESSURE,
            each.stamp,
            {
                "header": header(each.stamp, "bar30"),
                "fluid_pressure": float(each.pressure),
                "variance": 0.0,
            },
        )
        for each in run.samples["pressure"]
    ]


def satellites(run, topic, vehicle, noise_m):
    """NavSatFix once a second by the radii of curvature of WGS 84; no fix under water."""
    sea, rng, out = vehicle.environment, np.random.default_rng(2), []
    latitude, longitude = np.radians([sea.datum_latitude_deg, sea.datum_longitude_deg])
    e2 = 6.69437999014e-3
    w2 = 1.0 - e2 * np.sin(latitude) ** 2
    meridian, normal = 6378137.0 * (1.0 - e2) / w2**1.5, 6378137.0 / np.sqrt(w2)
    stamps, places, turns = run.at(np.arange(0.0, 16.0))
    antennas = places + turns.apply(vehicle.sensors.gps.position_m)
    for stamp, place in zip(stamps, antennas, strict=True):
        north, east, down = place + noise_m * rng.standard_normal(3)
        fix = place[2] < 0.0
        found = (
            np.degrees(latitude + north / meridian),
            np.degrees(longitude + east / (normal * np.cos(latitude))),
            -down,
        )
        found = found if fix else (np.nan,) * 3
        message = {
            "header": header(stamp, "gps"),
            "status": {"status": 0 if fix else -1, "service": 1},
            **dict(zip(("latitude", "longitude", "altitude"), map(float, found), strict=True)),
            "position_covariance": np.zeros(9),
            "position_covariance_type": 0,
        }
        out.append((topic, FIX, stamp, message))
    return out


def fixes(run, topic, vehicle, frame):
    """Position fixes twice a second in `map` (east, north, up) or `map_ned`, with a covariance."""
    section, rng = vehicle.sensors.mounted["position_fix"], np.random.default_rng(3)
    std, out = np.array([0.05, 0.1, 0.2]), []  # north, east, down
    stamps, places, turns = run.at(np.arange(0.2, 16.0, 0.5))
    for stamp, place in zip(stamps, places + turns.apply(section.position_m), strict=True):
        found, order = place + std * rng.standard_normal(3), [0, 1, 2]
        if frame == "map":
            found, order = ENU.apply(found), [1, 0, 2]
        covariance = np.zeros((6, 6))
        covariance[range(3), range(3)] = np.square(std[order])
        covariance[range(3, 6), range(3, 6)] = -1.0
        content = pose(found, Rotation.identity(), covariance.ravel())
        out.append((topic, POSE, stamp, {"header": header(stamp, frame), "pose": content}))
    return out


def depths(run, topic, vehicle):
    """Poses of which z alone says something, up."""
    section, rng, out = vehicle.sensors.mounted["depth"], np.random.default_rng(4), []
    stamps, places, turns = run.at(np.arange(0.1, 16.0, 0.2))
    for stamp, place in zip(stamps, places + turns.apply(section.position_m), strict=True):
        z = -(place[2] + section.noise_m * rng.standard_normal())
        content = pose([0.0, 0.0, z], Rotation.identity())
        out.append((topic, POSE, stamp, {"header": header(stamp, "map"), "pose": content}))
    return out


def headings(run, topic, noise_deg):
    """An attitude sensor after REP-103 that is wrong in roll and pitch, which nobody should use."""
    rng, out = np.random.default_rng(5), []
    stamps, _, turns = run.at(np.arange(0.0, 16.0, 0.2))
    unknown = np.array([-1.0, *[0.0] * 8])
    for stamp, turn in zip(stamps, turns, strict=True):
        yaw = turn.as_euler("ZYX", degrees=True)[0] + noise_deg * rng.standard_normal()
        seen = ENU * Rotation.from_euler("ZYX", [yaw, 4.0, -3.0], degrees=True) * FLU
        message = {
            "header": header(stamp, "compass"),
            "orientation": xyzw(seen),
            "orientation_covariance": np.zeros(9),
            "angular_velocity": xyz(np.zeros(3)),
            "angular_velocity_covariance": unknown,
            "linear_acceleration": xyz(np.zeros(3)),
            "linear_acceleration_covariance": unknown,
        }
        out.append((topic, IMU, stamp, message))
    return out


def fields(run, topic, vehicle):
    """The Earth's field along forward, left, up, in tesla."""
    section, rng, out = vehicle.sensors.mounted["magnetometer"], np.random.default_rng(6), []
    earth = np.array(vehicle.environment.magnetic_field_ut)
    stamps, _, turns = run.at(np.arange(0.0, 16.0, 0.2))
    for stamp, turn in zip(stamps, turns, strict=True):
        felt = turn.inv().apply(earth) + section.noise_ut * rng.standard_normal(3)
        message = {
            "header": header(stamp, "mag"),
            "magnetic_field": xyz(1e-6 * FLU.apply(felt)),
            "magnetic_field_covariance": np.zeros(9),
        }
        out.append((topic, FIELD, stamp, message))
    return out


def reference(run, topic):
    """The true motion as Odometry in `odom`, after REP-103, five times a second."""
    out = []
    for each in run.truth[::4]:
        turn = ENU * Rotation.from_quat(each.quaternion) * FLU
        twist = {"linear": xyz(FLU.apply(each.nu[:3])), "angular": xyz(FLU.apply(each.nu[3:]))}
        message = {
            "header": header(each.stamp, "odom"),
            "child_frame_id": "base_link",
            "pose": pose(ENU.apply(each.position), turn),
            "twist": {"twist": twist, "covariance": np.zeros(36)},
        }
        out.append((topic, ODOMETRY, each.stamp, message))
    return out
