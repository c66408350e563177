"""What users imported before the packages were divided still works, and says where it is now."""

import importlib
import warnings

import pytest

import uvms_core.signals
import uvms_dynamics
import uvms_planner
from uvms_core.end_effector_path import EndEffectorPath, PathSample

# uvms_dynamics.__all__ of version 0.1, and the modules that it imported.
DYNAMICS = """
Model Plant PlantConfig PlantTruth SensorFrame System Vehicle advance_batch build_model
build_thrusters compile_cache configuration_matrix coupling_wrench diagnostics dump_vehicle
end_effector end_effector_jacobian forward_dynamics generator hull_bias_wrench inverse_dynamics
joint_passive_torque load_vehicle make_state make_system mass_matrix matrix_to_quat quat_conjugate
quat_multiply quat_normalize quat_to_matrix quat_to_rotation_vector quat_to_rpy restoring_wrench
rotation_vector_to_quat rpy_to_quat signals simulate skew thruster_matrix topics
""".split()
SIGNALS = """
Allocation Array DisturbanceBudget DvlSample GpsSample ImuSample JointCommand JointGoal JointStates
NANOSECONDS Odometry PathGoal PressureSample Reference ThrusterCommand Wrench to_nanoseconds
to_seconds
""".split()


@pytest.mark.parametrize("name", DYNAMICS)
def test_a_name_of_uvms_dynamics_is_there_or_says_where_it_went(name):
    if name in uvms_dynamics.__all__:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            assert getattr(uvms_dynamics, name) is not None
        return
    home = uvms_dynamics._MOVED[name]
    with pytest.warns(DeprecationWarning, match=f"{name} has moved: import it from {home}"):
        found = uvms_dynamics.__getattr__(name)
    assert found is getattr(importlib.import_module(home), name)


@pytest.mark.parametrize("cls", [EndEffectorPath, PathSample])
def test_paths_were_part_of_the_planner(cls):
    with pytest.warns(DeprecationWarning, match="import it from uvms_core.end_effector_path"):
        assert getattr(uvms_planner, cls.__name__) is cls


def test_signals_were_part_of_dynamics():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        old = importlib.import_module("uvms_dynamics.signals")
    with pytest.warns(DeprecationWarning, match="import uvms_core.signals"):
        importlib.reload(old)
    for name in SIGNALS:
        assert getattr(old, name) is getattr(uvms_core.signals, name)


@pytest.mark.parametrize("package", [uvms_dynamics, uvms_planner])
def test_a_name_that_never_was_is_an_attribute_error(package):
    with pytest.raises(AttributeError, match="has no attribute 'nonsense'"):
        package.nonsense  # noqa: B018
