"""What the display remembers from one picture to the next, whatever draws it."""

from simconsole.hud.view import HudMemory, HudSettings, HudView, view
from simconsole.values.state_vector import Snapshot
from simconsole.world.rules.speed_advice import NO_ADVICE, Advice


class Freshness:
    """Says how long ago the tick last changed, by the display's own clock: a frozen ring is stale data."""

    def __init__(self) -> None:
        self._tick = -1
        self._changed_s = 0.0

    def age_s(self, tick: int, now_s: float) -> float:
        """Return the age of `tick` in s, seen at `now_s` of any steady clock."""
        if tick != self._tick:
            self._tick, self._changed_s = tick, now_s
        return now_s - self._changed_s


class DisplayMemory:
    """Turns the newest tick into what is shown of it."""

    def __init__(self, settings: HudSettings) -> None:
        self._settings = settings
        self._memory = HudMemory()
        self._freshness = Freshness()

    def content(
        self,
        snapshot: Snapshot | None,
        now_s: float,
        can_up: bool | None,
        link: str | None,
        advice: Advice = NO_ADVICE,
    ) -> HudView:
        """Return what to show at `now_s` of a steady clock; `can_up`, `link`: None without CAN bus or bridge."""
        if snapshot is None:
            return HudView(stale=True)
        age_s = self._freshness.age_s(snapshot.tick, now_s)
        shown, self._memory = view(snapshot, age_s, self._memory, self._settings, can_up, link, advice)
        return shown
