"""The link to a controller: how late an answer acts, what people are told of it, and what is refused."""

import pytest

from simconsole.profiles.link import LinkProfile, LocalisationProfile, WayProfile, late_ms, link_label
from tests.profiles.refused import refusal


def test_an_answer_is_late_by_both_ways_and_half_of_their_jitter() -> None:
    link = LinkProfile(delay_ms=30.0, jitter_ms=10.0, measurements=WayProfile(delay_ms=20.0, jitter_ms=4.0))
    assert late_ms(link) == pytest.approx(30.0 + 5.0 + 20.0 + 2.0)
    assert late_ms(LinkProfile()) == 0.0


def test_people_are_told_of_what_is_imperfect_and_of_nothing_else() -> None:
    assert link_label(LinkProfile(ground_truth=True)) == "perfect odometry, no delay"
    errors = LocalisationProfile(position_noise_m=0.05, yaw_drift_deg=0.5)
    link = LinkProfile(loss_share=0.01, localisation=errors, measurements=WayProfile(delay_ms=12.5))
    assert link_label(link) == "5 cm noise of position, 0.5 deg drift of yaw, 1 % loss, 12.5 ms delay of measurements"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("delay_ms: 2001", "delay_ms: value 2001: "),
        ("measurements: {loss_share: 1.1}", "measurements.loss_share: value 1.1: "),
        ("localisation: {drift_time_s: 0}", "localisation.drift_time_s: value 0: "),
        ("localization: {}", "localization: value {}: unknown key, did you mean localisation?"),
    ],
)
def test_what_cannot_be_meant_is_refused(text: str, told: str) -> None:
    assert told in refusal(text, LinkProfile)
