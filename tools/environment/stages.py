"""The stages of the set-up, in order; each knows its inputs and how to carry itself out."""

import os
import shutil
import sys

import stamps
import workspace
from chromium import Browser
from commands import environment
from machine import SetupError

INTERFACES = {"uvms_msgs": "src/uvms_msgs", "tf2_msgs": "tools/tf2_msgs"}
PACKAGING = ("setup.py", "setup.cfg", "package.xml")


class Context:
    """Where things are: the project, its environment, the log."""

    def __init__(self, root):
        self.root = root
        self.prefix = root / ".venv"
        self.python = self.prefix / "bin" / "python"
        self.log = self.prefix / "setup.log"
        self.env = environment(self.prefix)

    def stamps(self):
        """What has been done so far."""
        return stamps.Stamps(self.prefix / "setup.json")

    def packages(self):
        """Python packages of the project: name -> folder that holds its setup.py."""
        folders = [*sorted((self.root / "src").iterdir()), self.root / "bringup"]
        found = [folder for folder in folders if (folder / "setup.py").is_file()]
        return {next((folder / "resource").iterdir()).name: folder for folder in found}


class PythonEnvironment:
    """An empty virtual environment in .venv."""

    name, title = "environment", "virtual environment in .venv"

    def key(self, context, explicit):
        """An environment of any supported Python will do, unless the user names a Python."""
        python = os.path.realpath(sys.executable) if explicit else _interpreter(context)
        return stamps.digest(context.root, [], context.root, python)

    def run(self, stage, context):
        """Make it afresh, but never out of something that is not ours."""
        if context.prefix.exists() and not context.stamps().present:
            raise SetupError("%s was not made by this set-up: move it away." % context.prefix)
        shutil.rmtree(str(context.prefix), ignore_errors=True)
        context.stamps().begin(self.name)
        stage.run([sys.executable, "-m", "venv", context.prefix], context.env)


def _interpreter(context):
    """The program behind the environment's Python, or what would make a new one."""
    there = context.python.exists()  # False for a link whose target has gone
    return os.path.realpath(str(context.python) if there else sys.executable)


class Requirements:
    """Pinned packages from the index."""

    def __init__(self, name, title, *lists):
        self.name, self.title = name, title
        self._lists = ["requirements/%s.txt" % item for item in lists]

    def key(self, context, explicit):
        """The lists and the constraints."""
        return stamps.digest(context.root, [*self._lists, "requirements/constraints.txt"])

    def run(self, stage, context):
        """Install the lists within the constraints."""
        command = [context.python, "-m", "pip", "install", "--no-input", "--progress-bar=off"]
        command += ["--disable-pip-version-check", "--prefer-binary"]
        command += ["--no-compile"]  # Python compiles what is imported, a small part of it all
        for item in self._lists:
            command += ["-r", context.root / item]
        command += ["-c", context.root / "requirements/constraints.txt"]
        stage.run(command, context.env)


class Interfaces:
    """The ROS interface packages, generated and compiled into the environment."""

    name, title = "interfaces", "ROS messages and actions"

    def key(self, context, explicit):
        """The interface packages, and the ROS that they are built against."""
        inputs = [*INTERFACES.values(), "requirements/ros.txt"]
        return stamps.digest(context.root, inputs)

    def run(self, stage, context):
        """Build each package in its turn."""
        for name, source in INTERFACES.items():
            self._build(stage, context, name, context.root / source)

    def _build(self, stage, context, name, source):
        build = context.prefix / "build" / name
        _uninstall(build / "install_manifest.txt")
        shutil.rmtree(str(build), ignore_errors=True)
        configure = ["cmake", "-S", source, "-B", build, "-G", "Ninja", "-DBUILD_TESTING=OFF"]
        configure += ["-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_INSTALL_PREFIX=%s" % context.prefix]
        for language in ("C", "CXX"):  # compiles in a fifth less time, and the code only copies
            configure.append("-DCMAKE_%s_FLAGS_RELEASE=-O1 -DNDEBUG" % language)
        configure += ["-DPython3_EXECUTABLE=%s" % context.python]
        for command in (configure, ["cmake", "--build", build], ["cmake", "--install", build]):
            stage.run(command, context.env)


def _uninstall(manifest):
    """Remove what an earlier build installed, so that no message of old remains."""
    if manifest.is_file():
        for name in manifest.read_text().splitlines():
            if os.path.lexists(name):
                os.remove(name)


class EditablePackages:
    """The project's own packages: changed sources count at the next run."""

    name, title = "packages", "the project's packages (editable)"

    def key(self, context, explicit):
        """What describes the packages; their code may change freely."""
        packages = context.packages().values()
        inputs = [str((one / file).relative_to(context.root)) for one in packages
                  for file in PACKAGING]  # fmt: skip
        inputs.append("tools/environment/workspace.py")
        there = [(one / part).exists() for one in packages for part in workspace.SHARED]
        return stamps.digest(context.root, inputs, *there)

    def run(self, stage, context):
        """Install them in place, then add what makes the environment an ament prefix."""
        packages = context.packages()
        command = [context.python, "-m", "pip", "install", "--no-deps", "--no-index"]
        command += ["--no-build-isolation", "--use-pep517", "--disable-pip-version-check"]
        command += ["--config-settings", "editable_mode=compat"]  # a plain path, which mypy follows
        for folder in packages.values():
            command += ["-e", folder]
        stage.run(command, context.env)
        workspace.complete(context.prefix, packages)


ENVIRONMENT = PythonEnvironment()
RUNTIME = Requirements("runtime", "libraries (pip)", "build", "runtime")
PACKAGES = EditablePackages()
ROS = Requirements("ros", "ROS 2 (pip)", "ros")
DEVELOPMENT = Requirements("development", "test and development tools (pip)", "development")


FOR_KERNELS = (ENVIRONMENT, RUNTIME, PACKAGES)
"""Once these are done, the numba kernels can be compiled."""


def plan(development):
    """The stages to carry out, in order."""
    extra = [DEVELOPMENT, Browser()] if development else []
    return [*FOR_KERNELS, ROS, *extra, Interfaces()]
