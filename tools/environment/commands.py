"""Runs the commands of the set-up: a clean environment, a log, a live line on a terminal."""

import os
import re
import shutil
import subprocess
import sys
import time
from collections import deque

from machine import SetupError

# Set by a sourced ROS workspace or another environment; they would mix two installations.
FOREIGN = (
    "AMENT_PREFIX_PATH CMAKE_PREFIX_PATH COLCON_PREFIX_PATH LD_LIBRARY_PATH PYTHONHOME PYTHONPATH "
    "PIP_PREFIX PIP_TARGET PIP_USER PIP_REQUIREMENT PIP_CONSTRAINT _ROS_WHEELS_BOOTSTRAP_COMPLETE"
).split()

NO_NETWORK = re.compile(
    r"NewConnectionError|NameResolutionError|name resolution|ConnectTimeout|ReadTimeout|ProxyError"
    r"|SSLError|Max retries exceeded|Network is unreachable|Connection (refused|reset|broken)"
    r"|from versions: none",
    re.IGNORECASE,
)
NETWORK_HELP = (
    "pip could not reach the package index. Check the network, a proxy (HTTPS_PROXY) or a mirror "
    "(PIP_INDEX_URL) and call again; what was downloaded is in pip's cache."
)


def environment(prefix):
    """The variables that commands of the set-up see, with the environment's programs first."""
    clean = {name: value for name, value in os.environ.items() if name not in FOREIGN}
    clean["PATH"] = os.pathsep.join([str(prefix / "bin"), clean.get("PATH", os.defpath)])
    clean["VIRTUAL_ENV"] = clean["AMENT_PREFIX_PATH"] = clean["CMAKE_PREFIX_PATH"] = str(prefix)
    return clean


class Stage:
    """One stage on the screen: `with Stage("...", log) as stage: stage.run(...)`."""

    def __init__(self, title, log):
        self._title, self._log = title, log
        self._live = sys.stdout.isatty()

    def __enter__(self):
        self._begun = time.monotonic()
        self._say("[set-up] %s ..." % self._title, end="" if self._live else "\n")
        return self

    def __exit__(self, kind, *_):
        if kind is None:
            text = "[set-up] %s: %.0f s" % (self._title, time.monotonic() - self._begun)
            self._say(("\r\x1b[K" if self._live else "") + text)
        elif self._live:
            self._say("")

    def run(self, command, env, cwd=None):
        """Run the command to its end; if it fails, raise SetupError with the end of its output."""
        command = [str(part) for part in command]
        last: deque = deque(maxlen=400)
        with open(str(self._log), "a") as log:
            log.write("\n$ %s\n" % " ".join(command))
            with subprocess.Popen(
                command, env=env, cwd=cwd and str(cwd), stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                errors="replace",
            ) as process:  # fmt: skip
                for line in process.stdout or ():
                    log.write(line)
                    last.append(line.rstrip())
                    self._show(line)
        if process.returncode != 0:
            raise SetupError(self._explain(command, process.returncode, list(last)))

    def _show(self, line):
        if self._live:
            width = shutil.get_terminal_size().columns - 1
            text = "[set-up] %s: %s" % (self._title, line.strip())
            self._say("\r\x1b[K" + text[:width], end="")

    def _explain(self, command, code, last):
        tail = "\n".join("    " + line for line in last[-15:])
        text = "`%s ...` ended with code %d:\n%s" % (" ".join(command[:4]), code, tail)
        if any(NO_NETWORK.search(line) for line in last):
            text += "\n" + NETWORK_HELP
        return "%s\nAll of its output is in %s." % (text, self._log)

    @staticmethod
    def _say(text, end="\n"):
        print(text, end=end, flush=True)
