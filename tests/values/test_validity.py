from simconsole.values.signals import Validity
from simconsole.values.validity import is_trusted


def test_only_armed_and_live_inputs_command() -> None:
    assert [is_trusted(float(validity)) for validity in Validity] == [False, True, True, False, False]
    assert not is_trusted(1.5)
