from setuptools import find_packages, setup

PACKAGE = "uvms_core"

setup(
    name=PACKAGE,
    version="0.1.0",
    description="Common ground of the UVMS packages: vehicle file, signals, topics, messages, node shell and plug-in registry.",
    maintainer="UVMS maintainers",
    license="Apache-2.0",
    python_requires=">=3.10",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    package_data={PACKAGE: ["py.typed", "vehicles/*.yaml"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
    ],
    install_requires=[
        "annotated-types>=0.5",
        "numpy>=1.26",
        "pydantic>=2.5",
        "PyYAML>=6",
        "ruamel.yaml>=0.18",
        "scipy>=1.11",
    ],
    extras_require={"test": ["hypothesis", "mcap-ros2-support", "pin", "pytest", "rosbags"]},
    zip_safe=False,
    entry_points={"uvms.kernels": ["uvms_core = uvms_core"]},
)
