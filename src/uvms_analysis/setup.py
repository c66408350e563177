from setuptools import find_packages, setup

PACKAGE = "uvms_analysis"

setup(
    name=PACKAGE,
    version="0.1.0",
    description="Logs, summaries and reports of runs, and trials of real vehicles.",
    maintainer="UVMS maintainers",
    license="Apache-2.0",
    python_requires=">=3.10",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    package_data={PACKAGE: ["py.typed", "**/*.html", "**/*.css", "**/*.js", "**/LICENSE"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
    ],
    install_requires=[
        "matplotlib>=3.8",
        "mcap>=1.2",
        "numpy>=1.26",
        "PyYAML>=6",
        "scipy>=1.11",
        "uvms_core",
        "uvms_dynamics",
        "zstandard",
    ],
    extras_require={"test": ["mcap-ros2-support", "pytest", "rosbags"]},
    zip_safe=False,
    entry_points={
        "uvms.commands": [
            "check = uvms_analysis.commands.check:COMMAND",
            "compare = uvms_analysis.commands.compare:COMMAND",
            "identify = uvms_analysis.commands.identify:COMMAND",
            "info = uvms_analysis.commands.info:COMMAND",
            "recover = uvms_analysis.commands.recover:COMMAND",
            "topics = uvms_analysis.commands.topics:COMMAND",
            "validate = uvms_analysis.commands.validate:COMMAND",
        ],
    },
)
