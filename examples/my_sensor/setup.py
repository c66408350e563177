from setuptools import setup

setup(
    name="my_sensor",
    version="0.1.0",
    description="An acoustic positioning system for UVMS, brought from outside.",
    packages=["my_sensor"],
    install_requires=["numpy", "uvms_core", "uvms_dynamics", "uvms_observer"],
    entry_points={
        "uvms.sensors": ["usbl = my_sensor.model:UsblSensor"],
        "uvms.measurements": ["usbl = my_sensor.measurement:UsblPosition"],
    },
)
