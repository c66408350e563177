from setuptools import find_packages, setup

PACKAGE = "uvms_control"

setup(
    name=PACKAGE,
    version="0.1.0",
    description="S-surface and dynamic controller and thrust allocation of an underwater vehicle-manipulator system.",
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
    extras_require={"test": ["daqp", "hypothesis", "pytest", "quadprog"]},
    zip_safe=False,
    entry_points={
        "console_scripts": [
            "controller = uvms_control.nodes.controller:main",
            "thrust_allocator = uvms_control.nodes.thrust_allocator:main",
        ],
        "uvms.nodes": [
            "controller = uvms_control.nodes.controller:ControllerNode",
            "thrust_allocator = uvms_control.nodes.thrust_allocator:ThrustAllocatorNode",
        ],
        "uvms.controllers": [
            "default = uvms_control.controller:Controller",
            "paper = uvms_control.paper_controller:PaperController",
            "s_surface = uvms_control.paper_controller:PaperController",
        ],
        "uvms.allocators": [
            "weighted_least_squares = uvms_control.allocation:ThrustAllocator",
        ],
        "uvms.kernels": ["uvms_control = uvms_control"],
    },
)
