"""How much of a core the driver's sound takes: everything at once, six other vehicles among it.

Run: python benchmarks/sound_block.py [--seconds 20]
"""

import argparse
import time

from simconsole.hud.audio.player import BLOCK
from simconsole.hud.sound.heard import Heard, OtherHeard, Tone
from simconsole.hud.sound.loops import RATE_HZ
from simconsole.hud.sound.mix import Mixer
from simconsole.profiles.view import SoundProfile

BUSY = Heard(
    engine_radps=400.0,
    load=0.7,
    speed_mps=25.0,
    squeal_front=0.3,
    indicators=True,
    tone=Tone.TAKE_OVER,
    others=tuple(OtherHeard(float(at), 1.0 * at, 8.0 + at, 12.0, 3.0) for at in range(6)),
)


def main() -> None:
    """Print processor time over the time that the sound lasts."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=20.0)
    given = parser.parse_args()
    mixer = Mixer(4, SoundProfile())
    blocks = round(given.seconds * RATE_HZ / BLOCK)
    mixer.block(BUSY, BLOCK)
    began_s = time.process_time()
    for number in range(blocks):
        mixer.block(BUSY._replace(t_s=number * BLOCK / RATE_HZ), BLOCK)
    spent_s = time.process_time() - began_s
    print(f"{100.0 * spent_s * RATE_HZ / (blocks * BLOCK):.1f} % of a core, {1e3 * spent_s / blocks:.2f} ms a block")


if __name__ == "__main__":
    main()
