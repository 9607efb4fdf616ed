"""The game: a ball, eight cubes, and where the ball shall roll next. Knows neither ROS nor the console."""

import math
import sys
from threading import Thread

CUBES_M = [(1.5 * math.cos(k * math.pi / 4), 1.5 * math.sin(k * math.pi / 4)) for k in range(8)]
SPEED_MPS = 0.8
TOUCH_M = 0.2
STEP_M = 1.0  # how far ahead of the ball an arrow key puts its goal
ARROWS = {"\x1b[A": (0, 1), "\x1b[B": (0, -1), "\x1b[C": (1, 0), "\x1b[D": (-1, 0)}  # up is y of map, right is x


class Game:
    """Takes the ball's place, returns where it shall roll: by the arrow keys, or to the nearest cube."""

    def __init__(self, by_keys: bool = False) -> None:
        self.left, self.poses, self.by_keys, self.goal = list(CUBES_M), 0, by_keys, CUBES_M[0]
        self._way = (0, 0)
        if by_keys:
            Thread(target=self._listen, daemon=True).start()

    def roll(self, x_m: float, y_m: float) -> tuple[float, float]:
        """The ball is at (x, y): collect what it touches, and return its next goal (x, y)."""
        self.poses += 1
        for cube in [cube for cube in self.left if math.dist(cube, (x_m, y_m)) < TOUCH_M]:
            self.left.remove(cube)
            print(
                f"collected {len(CUBES_M) - len(self.left)} of {len(CUBES_M)} cubes at ({x_m:.2f}, {y_m:.2f})",
                flush=True,
            )
        if self.by_keys:
            return x_m + STEP_M * self._way[0], y_m + STEP_M * self._way[1]
        if self.left and self.goal not in self.left:
            self.goal = min(self.left, key=lambda cube: math.dist(cube, (x_m, y_m)))
        return self.goal

    def press(self, key: str) -> None:
        """An arrow key, as a terminal sends it; any other key stops the ball where it is."""
        self._way = ARROWS.get(key, (0, 0))

    def _listen(self) -> None:
        """Read keys from the terminal until it ends."""
        if sys.stdin.isatty():
            import tty

            tty.setcbreak(sys.stdin)
        while key := sys.stdin.read(1):
            self.press(key + sys.stdin.read(2) if key == "\x1b" else key)
