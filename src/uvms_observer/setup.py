from setuptools import find_packages, setup

PACKAGE = "uvms_observer"

setup(
    name=PACKAGE,
    version="0.1.0",
    description="Navigation filter and self-disturbance observer of an underwater vehicle-manipulator system.",
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
        "numpy>=1.26",
        "pydantic>=2.5",
        "scipy>=1.11",
        "uvms_core",
        "uvms_dynamics",
    ],
    extras_require={"test": ["hypothesis", "pytest"]},
    zip_safe=False,
    entry_points={
        "console_scripts": [
            "navigation = uvms_observer.nodes.navigation:main",
            "disturbance_observer = uvms_observer.nodes.disturbance_observer:main",
        ],
        "uvms.nodes": [
            "navigation = uvms_observer.nodes.navigation:NavigationNode",
            "disturbance_observer = uvms_observer.nodes.disturbance_observer:DisturbanceObserverNode",
        ],
        "uvms.observers": [
            "combined = uvms_observer.disturbance:CombinedObserver",
            "momentum = uvms_observer.disturbance:DisturbanceObserver",
            "momentum_residual = uvms_observer.disturbance.observer:FormerObserver",
            "none = uvms_observer.disturbance.none:NoObserver",
            "paper = uvms_observer.disturbance:ModelObserver",
        ],
        "uvms.navigation_filters": ["error_state_ekf = uvms_observer.navigation:NavigationFilter"],
        "uvms.measurements": [
            "imu = uvms_observer.navigation.measurements.imu:Gyrocompass",
            "dvl = uvms_observer.navigation.measurements.dvl:DvlVelocity",
            "pressure = uvms_observer.navigation.measurements.pressure:PressureDepth",
            "gps = uvms_observer.navigation.measurements.gps:GpsPosition",
            "position_fix = uvms_observer.navigation.measurements.position_fix:FixPosition",
            "heading = uvms_observer.navigation.measurements.heading:HeadingAngle",
            "magnetometer = uvms_observer.navigation.measurements.magnetometer:MagneticHeading",
            "depth = uvms_observer.navigation.measurements.depth:DepthGauge",
        ],
        "uvms.kernels": ["uvms_observer = uvms_observer"],
    },
)
