from setuptools import setup

setup(
    name="my_package",
    version="0.1.0",
    description="A control law, a planner method and a controller node for UVMS.",
    packages=["my_package"],
    install_requires=["numpy", "uvms_control", "uvms_core", "uvms_dynamics", "uvms_planner"],
    entry_points={
        "uvms.controllers": ["my_law = my_package.my_law:MyLaw"],
        "uvms.planners": ["my_method = my_package.my_method:MyMethod"],
    },
)
