"""Gains by rule: margins of every vehicle that comes along, and values that break them."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

import uvms_core.vehicles
from uvms_control import ControlConfig, Controller, ControlSetupError, GainConfig, PaperController
from uvms_control.controlled_axes import AXES
from uvms_control.design.axis import AxisGains
from uvms_control.design.gains import vehicle_gains
from uvms_control.design.margins import loop_margins
from uvms_control.design.vehicle_axes import Timing, vehicle_axes
from uvms_core.errors import ConfigError, UvmsError
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.plausible.stability import postures

PERIOD = 0.05
FOLDER = Path(uvms_core.vehicles.__path__[0])
FILES = sorted(path.stem for path in FOLDER.glob("*.yaml"))


@cache
def vehicle(name):
    return load_vehicle(FOLDER / f"{name}.yaml")


@cache
def by_rule(name):
    return vehicle_gains(vehicle(name), PERIOD, GainConfig())


@pytest.mark.parametrize("name", FILES)
def test_the_gains_keep_their_margins_in_every_posture(name):
    config, gains = GainConfig(), by_rule(name)
    timing = Timing(PERIOD, lag_compensated=config.lag_compensation)
    for posture, q in postures(vehicle(name)):
        for k, axis in enumerate(vehicle_axes(vehicle(name), q, timing)):
            if axis is None:
                assert gains.stiffness[k] == gains.damping[k] == gains.observer[k] == 0.0
                continue
            found = loop_margins(
                axis, AxisGains(gains.stiffness[k], gains.damping[k], gains.observer[k])
            )
            where = (posture, AXES[k], found)
            assert found.stable, where
            assert found.delay_margin >= config.delay_margin_periods * PERIOD * (1 - 1e-6), where
            assert found.gain_margin >= 2.0 * (1 - 1e-6), where
            assert found.phase_margin >= np.radians(30.0) * (1 - 1e-6), where
            assert found.noise_share <= config.noise_share * (1 + 1e-6), where
            assert gains.stiffness[k] > 0.0, where


@pytest.mark.parametrize("name", ["reference_auv_heavy", "reference_auv_light"])
def test_size_does_not_change_the_bandwidth(name):
    """Ten times heavier or lighter: the same accelerations for the same error."""
    own, reference = by_rule(name), by_rule("reference_auv")
    assert np.allclose(np.sqrt(own.stiffness), np.sqrt(reference.stiffness), rtol=0.09)
    assert np.allclose(own.damping, reference.damping, rtol=0.1)


def test_slower_thrusters_or_a_longer_period_allow_less():
    """Where the delay decides, not the noise."""
    own = vehicle("reference_auv")

    def bandwidths(period, **limits):
        return np.sqrt(vehicle_gains(own, period, GainConfig(noise_share=1.0, **limits)).stiffness)

    base = bandwidths(PERIOD)
    assert np.all(bandwidths(2 * PERIOD) < 0.8 * base)
    assert np.all(bandwidths(PERIOD, delay_margin_periods=6.0) < 0.8 * base)


@pytest.mark.parametrize("k", range(6))
def test_a_bandwidth_that_is_not_stable_is_refused_with_its_bound(k):
    wanted = [0.5] * 6
    wanted[k] = 40.0
    controller = Controller(
        vehicle("reference_auv"), ControlConfig(gains=GainConfig(bandwidth_rad_s=tuple(wanted)))
    )
    with pytest.raises(ControlSetupError) as fault:
        controller.prepare(PERIOD)
    text = str(fault.value)
    assert text.startswith(f"control.gains.bandwidth_rad_s of {AXES[k]}: 40 rad/s makes the loop")
    bound = float(text.rsplit("at most ", 1)[1].split()[0])
    assert 1.0 < bound < 40.0
    wanted[k] = 0.98 * bound
    vehicle_gains(vehicle("reference_auv"), PERIOD, GainConfig(bandwidth_rad_s=tuple(wanted)))
    wanted[k] = 1.02 * bound
    with pytest.raises(ControlSetupError, match=AXES[k]):
        vehicle_gains(vehicle("reference_auv"), PERIOD, GainConfig(bandwidth_rad_s=tuple(wanted)))


def test_bandwidth_and_damping_that_are_asked_for_are_taken():
    config = GainConfig(bandwidth_rad_s=(1.0,) * 6, damping_ratio=(0.9,) * 6)
    gains = vehicle_gains(vehicle("reference_auv"), PERIOD, config)
    assert np.allclose(gains.stiffness, 1.0)
    for k in (0, 1, 2, 5):  # no righting moment
        assert gains.damping[k] == pytest.approx(1.8)
    assert np.all(gains.damping[3:5] > 1.8)


class Own(Controller):
    """A law of somebody else's that may read any section."""

    def prepare(self, period: float) -> None:
        pass


@pytest.mark.parametrize(
    ("law", "given", "message"),
    [
        ("default", {"vehicle": {"k_rate": (3.0,) * 6}}, r"ignores vehicle\.k_rate.*law paper"),
        ("paper", {"gains": {"noise_share": 0.1}}, r"ignores gains\.noise_share.*law default"),
        ("s_surface", {"gains": {"authority_share": 1.0}}, r"ignores gains\.authority_share"),
    ],
)
def test_settings_of_another_law_are_refused(law, given, message):
    with pytest.raises(ConfigError, match=message):
        ControlConfig(law=law, **given).resolved()


def test_settings_at_their_defaults_and_those_of_own_laws_are_fine():
    for law in ("default", "paper"):
        config = ControlConfig.model_validate({**ControlConfig().model_dump(), "law": law})
        assert config.resolved().law == law
    own = f"{Own.__module__}:Own"
    ControlConfig(law=own, vehicle={"k_rate": (3.0,) * 6}, gains={"noise_share": 0.1}).resolved()
    assert issubclass(ConfigError, UvmsError)
    assert PaperController.ignores.keys() == {"gains"}
