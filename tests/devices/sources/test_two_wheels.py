"""Two persons at wheels of their own in one process: SDL has one queue of events for both."""

import pygame

from simconsole.devices.calibration.cockpit_settings import button_bits
from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load


def test_a_click_of_one_person_is_not_lost_to_whoever_looks_first(sdl: None, t500: CockpitProfile) -> None:
    g29 = load("devices", "g29", CockpitProfile)
    cockpits = [VirtualCockpit(profile) for profile in (t500, g29)]
    sources = [SdlSource(profile) for profile in (t500, g29)]
    rest = [source.poll(1) for source in sources]
    for person in (0, 1):
        bit = 1 << min(button_bits((t500, g29)[person], "wheel").values())
        cockpits[person].write(rest[person]._replace(wheel_buttons=float(bit)))
        pygame.event.pump()  # SDL asks its devices
        cockpits[person].write(rest[person])
        seen = [int(source.poll(2).wheel_buttons) for source in sources]
        assert seen[person] == bit, "pressed and released between two looks"
        assert seen[1 - person] == 0
        assert [int(source.poll(3).wheel_buttons) for source in sources] == [0, 0]
    for source, cockpit in zip(sources, cockpits, strict=True):
        source.close()
        cockpit.close()


def test_a_wheel_that_is_pulled_out_is_gone_for_its_person_alone(sdl: None, t500: CockpitProfile) -> None:
    g29 = load("devices", "g29", CockpitProfile)
    cockpits = [VirtualCockpit(profile) for profile in (t500, g29)]
    sources = [SdlSource(profile) for profile in (t500, g29)]
    for gone in (0, 1):
        cockpits[gone].unplug("wheel")
        ages = [source.poll(2).wheel_age_ticks for source in sources]
        assert ages[gone] > 1e6
        assert ages[1 - gone] == 0.0
        cockpits[gone].plug("wheel")
        back = [[source.poll(tick).wheel_age_ticks for source in sources] for tick in (3, 4)]
        assert back[-1] == [0.0, 0.0]
    for source, cockpit in zip(sources, cockpits, strict=True):
        source.close()
        cockpit.close()
