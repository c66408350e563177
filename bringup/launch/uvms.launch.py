"""The six nodes and the state publisher: `ros2 launch uvms_bringup uvms.launch.py`.

The plant starts by itself as soon as all nodes are there. `uvms run` is the way to record a run;
this file is for graphs with nodes of one's own beside. ROS's wheels lack the package `launch`, so
tests/ros/test_launch.py loads this file with a small stand-in for its classes and starts the nodes
as launch_ros would; with the real package it has not been run.
"""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from uvms_bringup.pace import Pace

NODES = (
    ("uvms_dynamics", "plant"),
    ("uvms_observer", "navigation"),
    ("uvms_observer", "disturbance_observer"),
    ("uvms_planner", "motion_planner"),
    ("uvms_control", "controller"),
    ("uvms_control", "thrust_allocator"),
    ("uvms_bringup", "state_publisher"),
)
ARGUMENTS = {
    "vehicle_file": ("", "vehicle file or name; empty: as in `parameters`, or the reference"),
    "parameters": ("", "ROS parameter file, or a folder of NODE.yaml such as RUN/parameters"),
    "namespace": ("", "of all nodes, such as auv1"),
    "pace": ("lockstep", "lockstep, realtime or realtime:FACTOR, for all nodes alike"),
}


def generate_launch_description():
    """The arguments, and the nodes that follow from them."""
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, (default, text) in ARGUMENTS.items()
    ]
    return LaunchDescription([*arguments, OpaqueFunction(function=nodes)])


def nodes(context):
    """One action a node."""
    given = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    return [
        Node(
            package=package,
            executable=node,
            name=node,
            namespace=given["namespace"],
            parameters=[*parameter_files(node, given["parameters"]), own_values(node, given)],
            output="screen",
        )
        for package, node in NODES
    ]


def parameter_files(node, place):
    """The files with a node's parameters, if any."""
    files = [Path(place) / f"{node}.yaml"] if Path(place).is_dir() else [Path(place)]
    return [str(file) for file in files if place and file.exists()]


def own_values(node, given):
    """What the arguments say, which counts more than the files."""
    pace = Pace.parse(given["pace"])
    values = {"pace": pace.name}
    if given["vehicle_file"]:
        values["vehicle_file"] = given["vehicle_file"]
    if node == "plant":  # the files of a recorded run let it wait for the recorder
        values |= {"realtime_factor": pace.factor, "auto_start": True, "start_paused": False}
    return values
