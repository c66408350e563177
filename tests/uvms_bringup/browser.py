"""A headless Chromium for the tests of pages, spoken to by its DevTools protocol.

`UVMS_BROWSER` names one; else it is the system's, else the one that `make test` set up.
"""

import base64
import io
import itertools
import json
import os
import shutil
import subprocess
import sys
import time
import urllib.request
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from PIL import Image
from websockets.sync.client import connect

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
OWN = Path(sys.prefix) / "browser" / "chromium"
"""Where the set-up of the tests puts one."""
SOFTWARE = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
ARGUMENTS = (
    "--headless=new",
    "--no-sandbox",
    "--hide-scrollbars",
    "--mute-audio",
    "--lang=en-US",
    *SOFTWARE,
)
HOW = (
    "the tests of the page need a Chromium: install one (`sudo apt install chromium`), name one in"
    " UVMS_BROWSER, or install npm and run `make setup`, which fetches one from the npm registry"
)
WITHIN_S = 150.0
"""Patience on a machine that has other things to do: a picture takes seconds there."""


def find():
    """The browser's program."""
    named = os.environ.get("UVMS_BROWSER")
    found = [named] if named else [*map(shutil.which, NAMES), str(OWN)]
    for program in filter(None, found):
        if Path(program).is_file():
            return program
    raise FileNotFoundError(HOW)


class Tab:
    """One page that is open."""

    def __init__(self, address):
        self._socket = connect(address, max_size=None)
        self._numbers = itertools.count(1)
        self.complaints = []
        self.requests = []
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method, **parameters):
        """The answer of the browser; what it reports meanwhile is kept."""
        number = next(self._numbers)
        self._socket.send(json.dumps({"id": number, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self._socket.recv(timeout=WITHIN_S))
            if answer.get("id") == number:
                assert "error" not in answer, answer
                return answer["result"]
            self._note(answer)

    def _note(self, report):
        what = report.get("method")
        if what == "Network.requestWillBeSent":
            self.requests.append(report["params"]["request"]["url"])
        if what == "Runtime.exceptionThrown":
            self.complaints.append(report["params"]["exceptionDetails"].get("exception"))
        elif what == "Log.entryAdded" and report["params"]["entry"]["level"] == "error":
            self.complaints.append(report["params"]["entry"])
        elif what == "Runtime.consoleAPICalled" and report["params"]["type"] in ("error", "assert"):
            self.complaints.append(report["params"]["args"])

    def open(self, address):
        """Go to an address and wait until its documents are there."""
        assert "errorText" not in (went := self.call("Page.navigate", url=address)), went
        there = "location.href != 'about:blank' && document.readyState == 'complete'"
        self.wait(lambda: self.evaluate(there), address)

    def offline(self):
        """Cut the page off from any network."""
        self.call("Network.emulateNetworkConditions", offline=True, latency=0,
                  downloadThroughput=-1, uploadThroughput=-1)  # fmt: skip

    def evaluate(self, script):
        """Value of an expression in the page."""
        result = self.call("Runtime.evaluate", expression=script, returnByValue=True)
        assert "exceptionDetails" not in result, result
        return result["result"].get("value")

    def wait(self, condition, what):
        """Until a function says something true, which is returned."""
        until = time.monotonic() + WITHIN_S
        while not (found := condition()):
            assert time.monotonic() < until, f"not within {WITHIN_S:g} s: {what}"
            time.sleep(0.2)
        return found

    def wait_for_text(self, text):
        """Until the page shows a text."""
        self.wait(lambda: text in (self.evaluate("document.body?.innerText") or ""), text)

    def picture(self, file=None):
        """What the page looks like, (h, w, 3) bytes."""
        data = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        if file is not None:
            Path(file).write_bytes(data)
        return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))

    def key(self, name, code=0, text="", modifiers=0):
        """A key of the keyboard, pressed and released; `code` as browsers number them."""
        common = {"key": name, "windowsVirtualKeyCode": code, "modifiers": modifiers}
        self.call("Input.dispatchKeyEvent", type="keyDown", text=text, **common)
        self.call("Input.dispatchKeyEvent", type="keyUp", **common)

    def width(self, pixels, height=1000):
        """Give the page a size."""
        self.call("Emulation.setDeviceMetricsOverride", width=pixels, height=height,
                  deviceScaleFactor=1, mobile=False)  # fmt: skip

    def colours(self, scheme):
        """What the user prefers: `light` or `dark`."""
        wanted = [{"name": "prefers-color-scheme", "value": scheme}]
        self.call("Emulation.setEmulatedMedia", features=wanted)

    def click(self, x, y):
        """A click of the left button, pixels."""
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def drag(self, start, end, steps=5):
        """Drag with the left button from one place to another, pixels."""
        self._mouse("mouseMoved", start)
        self._mouse("mousePressed", start, button="left", clickCount=1)
        for place in np.linspace(start, end, steps + 1)[1:]:
            self._mouse("mouseMoved", place, button="left", buttons=1)
            self.frame()  # the page acts on what it has drawn
        self._mouse("mouseReleased", end, button="left", clickCount=1)

    def _mouse(self, kind, place, **more):
        x, y = map(float, place)
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def frame(self):
        """Wait for two frames of the page."""
        twice = "new Promise(r => requestAnimationFrame(() => requestAnimationFrame(r)))"
        self.call("Runtime.evaluate", expression=twice, awaitPromise=True)

    def press(self, text):
        """Click on the button with this text."""
        place = self.evaluate(
            f"(() => {{const b = [...document.querySelectorAll('button, label')].find("
            f"e => e.innerText.trim() === {json.dumps(text)}); if (!b) return null;"
            "const r = b.getBoundingClientRect(); return [r.x + r.width/2, r.y + r.height/2]})()"
        )
        assert place, f"no button {text!r}"
        self.click(*place)


@contextmanager
def browser_tab(folder, size=(1280, 720)):
    """A tab of a browser of its own; `folder` is for its profile."""
    port = Path(folder) / "DevToolsActivePort"
    command = [find(), *ARGUMENTS, f"--window-size={size[0]},{size[1]}",
               f"--user-data-dir={folder}", "--remote-debugging-port=0", "about:blank"]  # fmt: skip
    variables = {**os.environ, "LANG": "en_US.UTF-8", "LC_ALL": "", "LANGUAGE": "en_US"}
    if command[0] == str(OWN):
        variables["LD_LIBRARY_PATH"] = str(OWN.parent / "lib")
    with subprocess.Popen(
        command, env=variables, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as process:
        try:
            until = time.monotonic() + WITHIN_S
            while not (port.is_file() and port.read_text().count("\n")):
                assert process.poll() is None, f"{command[0]} ended with {process.returncode}"
                assert time.monotonic() < until, f"{command[0]} does not start"
                time.sleep(0.1)
            number = port.read_text().split()[0]
            with urllib.request.urlopen(f"http://127.0.0.1:{number}/json") as answer:
                pages = [each for each in json.load(answer) if each["type"] == "page"]
            yield Tab(pages[0]["webSocketDebuggerUrl"])
        finally:
            process.terminate()
