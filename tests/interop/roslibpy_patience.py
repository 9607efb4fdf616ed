"""A plugin of the pytest that runs roslibpy's own tests: what it waits for may come late on a loaded machine."""

import roslibpy.ros
import roslibpy.ros1.actionlib

PATIENCE_S = 600  # as in roslibpy_suite.py: it ends only what hangs

roslibpy.ros.Ros.run.__defaults__ = (PATIENCE_S,)
roslibpy.ros.Ros.close.__defaults__ = (PATIENCE_S,)
roslibpy.ros.set_rosapi_timeout(PATIENCE_S)
roslibpy.ros1.actionlib.DEFAULT_CONNECTION_TIMEOUT = PATIENCE_S
