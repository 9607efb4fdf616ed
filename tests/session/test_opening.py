import pytest

from simconsole.profiles.session import SessionProfile
from simconsole.session.opening import check_commander
from simconsole.session.resolution import load_session, override
from simconsole.values.errors import ProfileError


@pytest.fixture
def session() -> SessionProfile:
    return load_session("can")


def test_shipped_session_can_be_driven(session: SessionProfile) -> None:
    assert session.features.commander == "can"
    check_commander(session)  # it raises where the commander has no way in
    check_commander(load_session("demo"))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"outputs": {"can": None}}, r"features\.commander: value can: needs outputs\.can"),
        ({"mode": {"pacing": "lockstep"}}, r"mode\.pacing: value lockstep"),
    ],
)
def test_commander_with_no_way_in_is_refused(
    session: SessionProfile, changes: dict[str, dict[str, object]], words: str
) -> None:
    with pytest.raises(ProfileError, match=words):
        check_commander(override(session, **changes))
