"""Runs the commands of the set-up: a clean environment, a log, a live line on a terminal."""

import os
import re
import shutil
import subprocess
import sys
import threading
import time
from collections import deque

from machine import SetupError

# Set by a sourced ROS workspace or another environment; they would mix two installations. Container
# images often forbid bytecode: then each process of a run compiles 1,400 files again.
FOREIGN = (
    "AMENT_PREFIX_PATH CMAKE_PREFIX_PATH COLCON_PREFIX_PATH LD_LIBRARY_PATH PYTHONHOME PYTHONPATH "
    "PIP_PREFIX PIP_TARGET PIP_USER PIP_REQUIREMENT PIP_CONSTRAINT _ROS_WHEELS_BOOTSTRAP_COMPLETE "
    "PYTHONDONTWRITEBYTECODE"
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


def execute(command, env, log, show, cwd=None, started=lambda process: None):
    """Run the command to its end, each line of output to `show` and the log.

    Raises SetupError with the end of its output if it fails.
    """
    command = [str(part) for part in command]
    last: deque = deque(maxlen=400)
    with open(str(log), "a") as file:
        file.write("\n$ %s\n" % " ".join(command))
        with subprocess.Popen(
            command, env=env, cwd=cwd and str(cwd), stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
            errors="replace",
        ) as process:  # fmt: skip
            started(process)
            for line in process.stdout or ():
                file.write(line)
                last.append(line.rstrip())
                show(line.strip())
    if process.returncode != 0:
        raise SetupError(_explain(command, process.returncode, list(last), log))


def _explain(command, code, last, log):
    tail = "\n".join("    " + line for line in last[-15:])
    text = "`%s ...` ended with code %d:\n%s" % (" ".join(command[:4]), code, tail)
    if any(NO_NETWORK.search(line) for line in last):
        text += "\n" + NETWORK_HELP
    return "%s\nAll of its output is in %s." % (text, log)


class Background:
    """A command beside the stages; `lines` is what it has printed."""

    def __init__(self, command, env, log):
        self.lines, self.fault = [], None
        self._process = None
        self._arguments = (command, env, log, self._show)
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    @property
    def line(self):
        """The last line, or nothing yet."""
        return self.lines[-1] if self.lines else ""

    @property
    def running(self):
        """Whether it has not ended yet."""
        return self._thread.is_alive()

    def wait(self, seconds=None):
        """Wait for its end, for at most so long; then `fault` is None or says how it failed."""
        self._thread.join(seconds)

    def stop(self):
        """End it before its time."""
        if self._process is not None:
            self._process.terminate()
        self._thread.join()

    def _run(self):
        try:
            execute(*self._arguments, started=self._started)
        except SetupError as fault:
            self.fault = fault

    def _started(self, process):
        self._process = process

    def _show(self, line):
        self.lines.append(line)


class Stage:
    """One stage on the screen: `with Stage("...", log) as stage: stage.run(...)`.

    On a terminal it is one line that shows what goes on, with the seconds, and after it the last
    line of a `Background`; elsewhere a line at the beginning and one at the end, with the same.
    """

    def __init__(self, title, log, beside=None):
        self._title, self._log, self._beside = title, log, beside
        self._live = sys.stdout.isatty()
        self._line = ""
        self._ended = threading.Event()
        self._ticker = threading.Thread(target=self._tick, daemon=True)

    def __enter__(self):
        self._begun = time.monotonic()
        self._print("[set-up] %s ..." % self._title, end="" if self._live else "\n")
        self._ticker.start()
        return self

    def __exit__(self, kind, *_):
        self._ended.set()
        self._ticker.join()
        if kind is None:
            text = "[set-up] %s: %.0f s" % (self._title, time.monotonic() - self._begun)
            if not self._live and self._beside is not None and self._beside.running:
                text += "; beside it: " + self._beside.line
            self._print(("\r\x1b[K" if self._live else "") + text)
        elif self._live:
            self._print("")

    def run(self, command, env, cwd=None):
        """Run the command to its end; if it fails, raise SetupError with the end of its output."""
        execute(command, env, self._log, self._show, cwd)

    def watch(self, background):
        """Show what it prints until it ends; every line where there is no terminal."""
        shown = len(background.lines)
        while background.running or shown < len(background.lines):
            background.wait(0.2)
            for line in background.lines[shown:] if not self._live else ():
                self._print("[set-up] %s" % line)
            shown, self._line = len(background.lines), background.line

    def _show(self, line):
        self._line = line

    def _tick(self):
        """Renew the line on a terminal, once the stage has lasted for a moment."""
        while self._live and not self._ended.wait(0.25):
            seconds = time.monotonic() - self._begun
            text = "[set-up] %s: %.0f s: %s" % (self._title, seconds, self._line)
            width = shutil.get_terminal_size().columns - 1
            if self._beside is not None and self._beside.running and self._beside.line:
                also = " | " + self._beside.line
                text = text[: max(width - len(also), width // 2)] + also
            self._print("\r\x1b[K" + text[:width], end="")

    @staticmethod
    def _print(text, end="\n"):
        print(text, end=end, flush=True)
