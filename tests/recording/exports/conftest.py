import pytest

from tests.recording.made import MadeRecording, made_vectors


@pytest.fixture
def recording() -> MadeRecording:
    return MadeRecording(made_vectors())
