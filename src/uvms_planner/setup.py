from setuptools import find_packages, setup

PACKAGE = "uvms_planner"

setup(
    name=PACKAGE,
    version="0.1.0",
    description="Motion planner that moves vehicle and arm together with the least self-disturbance.",
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
    extras_require={"test": ["hypothesis", "pytest", "quadprog"]},
    zip_safe=False,
    entry_points={
        "console_scripts": [
            "motion_planner = uvms_planner.nodes.motion_planner:main",
        ],
        "uvms.nodes": [
            "motion_planner = uvms_planner.nodes.motion_planner:MotionPlannerNode",
        ],
        "uvms.planners": [
            "genetic = uvms_planner.methods.genetic:Genetic",
            "genetic_steps = uvms_planner.methods.genetic:GeneticSteps",
            "paper = uvms_planner.methods.paper:Paper",
            "sqp = uvms_planner.methods.sqp:Sqp",
            "least_norm = uvms_planner.methods.least_norm:LeastNorm",
            "arm_only = uvms_planner.methods.arm_only:ArmOnly",
            "vehicle_only = uvms_planner.methods.vehicle_only:VehicleOnly",
        ],
        "uvms.kernels": ["uvms_planner = uvms_planner"],
    },
)
