"""Payload: whether the gripper holds one, how heavy it is and where."""

from uvms_observer.payload.estimator import PayloadEstimator

__all__ = ["PayloadEstimator"]
