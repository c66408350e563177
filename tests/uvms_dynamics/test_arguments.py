"""Arguments that do not fit: kernels read without bounds, so each array is looked at first."""

import numpy as np
import pytest
from numba.core.errors import NumbaError

import uvms_dynamics as kernels
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model

VEHICLE = load_vehicle()
MODEL, N = build_model(VEHICLE), VEHICLE.n_joints
LEVEL, SIX, JOINTS = np.array([0.0, 0.0, 0.0, 1.0]), np.zeros(6), np.zeros(N)
FITTING = {
    "forward_dynamics": (LEVEL, SIX, JOINTS, JOINTS, np.zeros(6 + N)),
    "inverse_dynamics": (LEVEL, SIX, SIX, JOINTS, JOINTS, JOINTS),
    "coupling_wrench": (SIX, SIX, JOINTS, JOINTS, JOINTS),
    "hull_bias_wrench": (SIX,),
    "joint_passive_torque": (JOINTS, JOINTS),
    "mass_matrix": (JOINTS,),
    "restoring_wrench": (LEVEL, JOINTS),
    "end_effector_jacobian": (LEVEL, JOINTS),
}
PLACES = [(name, k) for name, arrays in FITTING.items() for k in range(len(arrays))]


@pytest.mark.parametrize(("name", "place"), PLACES)
@pytest.mark.parametrize("change", [-1, 1])
def test_an_array_that_is_too_short_or_too_long_is_refused(name, place, change):
    function, arrays = getattr(kernels, name), list(FITTING[name])
    assert function(MODEL, *arrays) is not None
    arrays[place] = np.zeros(len(arrays[place]) + change)
    with pytest.raises(ValueError, match="need"):
        function(MODEL, *arrays)


@pytest.mark.parametrize("model", [np.asfortranarray(MODEL), MODEL.astype(np.float32)])
def test_a_model_that_is_no_contiguous_table_of_float64_is_refused(model):
    with pytest.raises(NumbaError):
        kernels.forward_dynamics(model, *FITTING["forward_dynamics"])
