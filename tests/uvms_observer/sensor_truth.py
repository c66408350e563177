"""A vehicle on a smooth path given by formulas, and what its sensors read on it.

Independent of the plant: the motion is analytic, and the readings follow from its derivatives at
the places where the sensors sit.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.signal import lfilter
from scipy.spatial.transform import Rotation

from uvms_core.geodesy import ned_to_geodetic
from uvms_core.signals import DvlSample, GpsSample, ImuSample, PressureSample, to_nanoseconds

NONE = np.zeros((3, 3))


@dataclass(frozen=True)
class Waves:
    """offset + speed t + sum of sines; one row of amplitudes per component."""

    offset: tuple[float, ...] = (0.0, 0.0, 0.0)
    speed: tuple[float, ...] = (0.0, 0.0, 0.0)
    amplitude: tuple[float, ...] = (0.0, 0.0, 0.0)
    period_s: tuple[float, ...] = (20.0, 27.0, 33.0)

    def __call__(self, t):
        w = 2.0 * np.pi / np.array(self.period_s)
        t = np.asarray(t, dtype=float)[..., None]
        return self.offset + np.array(self.speed) * t + self.amplitude * np.sin(w * t)


def slope(f, t, h=1e-3):
    """First derivative, fourth order."""
    return (8.0 * (f(t + h) - f(t - h)) - f(t + 2 * h) + f(t - 2 * h)) / (12.0 * h)


def curvature(f, t, h=2e-3):
    """Second derivative, fourth order."""
    near, far = f(t + h) + f(t - h), f(t + 2 * h) + f(t - 2 * h)
    return (16.0 * near - far - 30.0 * f(t)) / (12.0 * h**2)


@dataclass(frozen=True)
class Motion:
    """Position of the body origin and roll, pitch, yaw (rad) as functions of time."""

    position: Waves = Waves(offset=(0.0, 0.0, 10.0))
    rpy: Waves = Waves()

    def rotation(self, t):
        return Rotation.from_euler("ZYX", self.rpy(t)[..., ::-1])

    def place(self, t, lever):
        """Where a point of the body is, map_ned."""
        return self.position(t) + self.rotation(t).apply(lever)

    def omega(self, t):
        """Body rates from the Euler angle rates."""
        (roll, pitch, _), rates = (
            np.moveaxis(self.rpy(t), -1, 0),
            np.moveaxis(slope(self.rpy, t), -1, 0),
        )
        p = rates[0] - np.sin(pitch) * rates[2]
        q = np.cos(roll) * rates[1] + np.sin(roll) * np.cos(pitch) * rates[2]
        r = -np.sin(roll) * rates[1] + np.cos(roll) * np.cos(pitch) * rates[2]
        return np.stack((p, q, r), axis=-1)

    def velocity(self, t, lever):
        """Velocity of a point of the body, in body axes."""
        return self.rotation(t).inv().apply(slope(lambda s: self.place(s, lever), t))

    def force(self, t, lever, gravity):
        """Specific force at a point of the body, in body axes."""
        acceleration = curvature(lambda s: self.place(s, lever), t)
        return self.rotation(t).inv().apply(acceleration - np.array([0.0, 0.0, gravity]))


@dataclass
class Rig:
    """Sensors of a vehicle file on a motion; `noise` scales their white noise, `bias` the rest."""

    vehicle: object
    motion: Motion
    seed: int = 0
    noise: float = 1.0
    bias: float = 1.0
    surface: bool = False
    misalignment_deg: float = 0.0  # std of the DVL's mounting about each axis
    rng: np.random.Generator = field(init=False)
    sigmas: np.ndarray = field(init=False)  # of the biases that wander
    biases: np.ndarray = field(init=False)  # gyro, accelerometer, compass; DVL scale, pressure

    def __post_init__(self):
        sensors = self.vehicle.sensors
        imu = sensors.imu
        self.rng = np.random.default_rng(self.seed)
        tilt, heading = np.radians([imu.roll_pitch_bias_deg, imu.heading_bias_deg])
        sigmas = [np.radians(imu.gyro_bias_deg_s)] * 3 + [imu.accelerometer_bias_m_s2] * 3
        sigmas += [tilt, tilt, heading, sensors.dvl.scale_error, sensors.pressure.bias_pa]
        turn = np.random.default_rng([self.seed, 7]).standard_normal(3)
        self.mount = Rotation.from_rotvec(np.radians(self.misalignment_deg) * turn)
        self.biases = self.bias * np.array(sigmas) * self.rng.standard_normal(11)
        self.sigmas = self.bias * np.array(sigmas[:9])

    def white(self, sigma, *shape):
        return self.noise * sigma * self.rng.standard_normal(shape)

    def imu(self, t):
        """Samples at these times, evenly spaced."""
        imu, n = self.vehicle.sensors.imu, len(t)
        gyro, force, compass = np.split(self.wandering(t), 3, axis=1)
        lever = imu.position_m
        tilt, heading = np.radians([imu.roll_pitch_noise_deg, imu.heading_noise_deg])
        turns = compass + self.white(np.array([tilt, tilt, heading]), n, 3)
        quaternions = (self.motion.rotation(t) * Rotation.from_rotvec(turns)).as_quat()
        rates = self.motion.omega(t) + gyro + self.white(np.radians(imu.gyro_noise_deg_s), n, 3)
        forces = self.motion.force(t, lever, self.vehicle.environment.gravity_m_s2)
        forces = forces + force + self.white(imu.accelerometer_noise_m_s2, n, 3)
        rows = zip(t, quaternions, rates, forces, strict=True)
        return [ImuSample(to_nanoseconds(s), q, w, f, NONE, NONE, NONE) for s, q, w, f in rows]

    def wandering(self, t):
        """The inertial unit's biases (len(t), 9): first-order Gauss-Markov; `biases` is the last.

        By the exact step of the process: x' = phi x + sqrt(1 - phi^2) sigma n.
        """
        if len(t) < 2:
            return np.tile(self.biases[:9], (len(t), 1))
        phi = np.exp(-(t[1] - t[0]) / self.vehicle.sensors.imu.bias_time_constant_s)
        steps = np.random.default_rng([self.seed, 9]).standard_normal((len(t), 9))
        steps *= np.sqrt(1.0 - phi**2) * self.sigmas
        steps[0] = self.biases[:9]
        path = lfilter([1.0], [1.0, -phi], steps, axis=0)
        self.biases[:9] = path[-1]
        return path

    def dvl(self, t):
        dvl = self.vehicle.sensors.dvl
        read = (1.0 + self.biases[9]) * self.mount.inv().apply(
            self.motion.velocity(t, dvl.position_m)
        )
        read = read + self.white(dvl.noise_m_s, len(t), 3)
        return [DvlSample(to_nanoseconds(s), v, NONE) for s, v in zip(t, read, strict=True)]

    def pressure(self, t):
        sensor, sea = self.vehicle.sensors.pressure, self.vehicle.environment
        depth = self.motion.place(t, sensor.position_m)[:, 2]
        read = sea.atmospheric_pressure_pa + sea.water_density_kg_m3 * sea.gravity_m_s2 * depth
        read = read + self.biases[10] + self.white(sensor.noise_pa, len(t))
        return [
            PressureSample(to_nanoseconds(s), float(p), 0.0) for s, p in zip(t, read, strict=True)
        ]

    def gps(self, t):
        gps, sea = self.vehicle.sensors.gps, self.vehicle.environment
        sigma = np.array([gps.horizontal_noise_m] * 2 + [gps.vertical_noise_m])
        places = self.motion.place(t, gps.position_m) + self.white(sigma, len(t), 3)
        datum = (sea.datum_latitude_deg, sea.datum_longitude_deg)
        samples = []
        for s, place in zip(t, places, strict=True):
            fix = ned_to_geodetic(place, *datum) if self.surface else (np.nan,) * 3
            samples.append(GpsSample(to_nanoseconds(s), self.surface, *map(float, fix), NONE))
        return samples

    def frames(self, duration, tick=0.05, silent=()):
        """(stamp, imu, dvl, pressure, gps) of every tick; sensors in `silent` give nothing."""
        series = {}
        for name in ("imu", "dvl", "pressure", "gps"):
            rate = getattr(self.vehicle.sensors, name).rate_hz
            t = np.arange(round(duration * rate) + 1) / rate
            series[name] = [] if name in silent else getattr(self, name)(t)
        for k in range(round(duration / tick) + 1):
            stamp = to_nanoseconds(k * tick)
            yield stamp, *(_until(samples, stamp) for samples in series.values())


def _until(samples, stamp):
    """Take the samples up to the stamp off the list."""
    count = sum(1 for sample in samples[:64] if sample.stamp <= stamp)
    taken = samples[:count]
    del samples[:count]
    return taken
