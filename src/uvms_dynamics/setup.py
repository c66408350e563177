from setuptools import find_packages, setup

PACKAGE = "uvms_dynamics"

setup(
    name=PACKAGE,
    version="0.1.0",
    description="Dynamics with full hydrodynamics and the simulated plant of an underwater vehicle-manipulator system.",
    maintainer="UVMS maintainers",
    license="Apache-2.0",
    python_requires=">=3.10",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
    ],
    install_requires=[
        "llvmlite",  # the one that numba pins
        "numba>=0.61,<0.69",
        "numpy>=1.26",
        "pydantic>=2.5",
        "uvms_core",
    ],
    extras_require={
        "panels": ["capytaine>=3.0", "scipy>=1.11", "trimesh>=4.0"],
        "test": ["coal", "hypothesis", "packaging", "pin", "pytest", "uvms_dynamics[panels]"],
    },
    zip_safe=False,
    entry_points={
        "console_scripts": [
            "plant = uvms_dynamics.nodes.plant:main",
        ],
        "uvms.nodes": ["plant = uvms_dynamics.nodes.plant:PlantNode"],
        "uvms.sensors": [
            "imu = uvms_dynamics.simulation.sensors.imu:ImuSensor",
            "dvl = uvms_dynamics.simulation.sensors.dvl:DvlSensor",
            "pressure = uvms_dynamics.simulation.sensors.pressure:PressureSensor",
            "gps = uvms_dynamics.simulation.sensors.gps:GpsSensor",
            "position_fix = uvms_dynamics.simulation.sensors.position_fix:PositionFixSensor",
            "heading = uvms_dynamics.simulation.sensors.heading:HeadingSensor",
            "magnetometer = uvms_dynamics.simulation.sensors.magnetometer:MagnetometerSensor",
            "depth = uvms_dynamics.simulation.sensors.depth:DepthSensor",
        ],
        "uvms.kernels": ["uvms_dynamics = uvms_dynamics.kernels"],
    },
)
