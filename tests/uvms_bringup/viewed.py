"""Short runs to look at, with everything that a scene can show."""

import threading
from contextlib import contextmanager

import numpy as np

from uvms_bringup.cli import main

ROCK = "{name: rock, sphere: {center_m: [4.0, 1.0, 11.0], radius_m: 0.6}}"
PUSH = "{at_s: 3.0, until_s: 4.0, wrench: {force_n: [20.0, 0.0, 0.0], moment_nm: [0.0, 0.0, 0.0],"
PUSH += " frame: world}}"


def short_run(folder, duration=8.0):
    """The folder of a run of `manipulation` with a push, a rock, a seabed, a tether, a current."""
    settings = (
        f"obstacles=[{ROCK}]",
        f"events=[{PUSH}]",
        "plant.current_ned_m_s=[0.1, 0.05, 0.0]",
        "vehicle_overrides={environment.seabed_depth_m: 14.0,"
        " tether: {reference_depth_m: 10.0, weight_per_m_n: -1.0}}",
    )
    sets = [word for setting in settings for word in ("--set", setting)]
    code = main(["simulate", "manipulation", "--duration", str(duration), "--output", str(folder),
                 *sets])  # fmt: skip
    assert code in (0, 1)  # the path takes longer than the run
    return folder


@contextmanager
def served(page):
    """A page at work in a thread, until it is closed."""
    ended = threading.Event()
    thread = threading.Thread(target=page.serve, args=(ended.is_set,))
    thread.start()
    try:
        yield page
    finally:
        ended.set()
        thread.join()
        page.close()


def pixel_of(page, size, point):
    """Where the one browser that shows a page, in a window of a size, has a point (3,) of map_ned.

    Up in map_ned is up in the picture.
    """
    (client,) = page.server.get_clients().values()
    eye, camera = client.camera.position, client.camera
    ahead = camera.look_at - eye
    ahead = ahead / np.linalg.norm(ahead)
    right = np.cross(ahead, [0.0, 0.0, -1.0])
    right = right / np.linalg.norm(right)
    to = np.asarray(point) - eye
    focal = 0.5 * size[1] / np.tan(0.5 * camera.fov)
    x, y = to @ right, to @ np.cross(ahead, right)
    return 0.5 * np.array(size) + focal * np.array([x, y]) / (to @ ahead)
