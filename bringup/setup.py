from glob import glob

from setuptools import find_packages, setup

PACKAGE = "uvms_bringup"

setup(
    name=PACKAGE,
    version="0.1.0",
    description="Scenarios, bringup, in-process simulation, recording, replay and reports.",
    maintainer="UVMS maintainers",
    license="Apache-2.0",
    python_requires=">=3.10",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        (f"share/{PACKAGE}/config/campaigns", sorted(glob("config/campaigns/*.yaml"))),
        (
            f"share/{PACKAGE}/config/campaigns/trial_field",
            sorted(glob("config/campaigns/trial_field/*.*")),
        ),
        (f"share/{PACKAGE}/config/scenarios", sorted(glob("config/scenarios/*.yaml"))),
        (f"share/{PACKAGE}/launch", sorted(glob("launch/*.*"))),
    ],
    install_requires=[
        "annotated-types>=0.5",
        "dask>=2025.7",
        "distributed>=2025.7",
        "imageio-ffmpeg>=0.5",
        "matplotlib>=3.8",
        "numpy>=1.26",
        "pillow>=10.1",
        "pyarrow>=15",
        "pydantic>=2.5",
        "rich>=13",
        "rosbags>=0.10",
        "uvms_analysis",
        "uvms_control",
        "uvms_core",
        "uvms_dynamics",
        "uvms_observer",
        "uvms_planner",
        "viser>=1.1",
    ],
    extras_require={
        "panels": ["uvms_dynamics[panels]"],
        "test": ["pytest", "uvms_bringup[panels]", "websockets"],
    },
    zip_safe=False,
    entry_points={
        "console_scripts": [
            "uvms = uvms_bringup.entry:main",
            "state_publisher = uvms_bringup.ros.state_publisher:main",
        ],
        "uvms.commands": [
            "added-mass = uvms_bringup.commands.added_mass:COMMAND",
            "campaign = uvms_bringup.commands.campaign:COMMAND",
            "fields = uvms_bringup.commands.fields:COMMAND",
            "navigate = uvms_bringup.commands.navigate:COMMAND",
            "replay = uvms_bringup.commands.replay:COMMAND",
            "report = uvms_bringup.commands.report:COMMAND",
            "run = uvms_bringup.commands.run:COMMAND",
            "simulate = uvms_bringup.commands.simulate:COMMAND",
            "tune = uvms_bringup.commands.tune:COMMAND",
            "vehicle = uvms_bringup.commands.vehicle:COMMAND",
            "view = uvms_bringup.commands.view:COMMAND",
        ],
    },
)
