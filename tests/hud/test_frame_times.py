from simconsole.hud.frame_times import KEPT, FrameTimes


def test_times_are_those_of_the_newest_frames_and_change_twice_a_second() -> None:
    times = FrameTimes("llvmpipe \u2122")
    assert times.lines(None) == ()
    for _ in range(KEPT):
        times.add(0.02, 0.005)
    lines = times.lines(0.004)
    assert lines == (
        "50 frames/s",
        "frame 20.0 ms, 99 %: 20.0 ms",
        "drawing 5.0 ms, 99 %: 5.0 ms",
        "data 4 ms old",
        "llvmpipe ?",  # only what can be drawn
    )
    for _ in range(20):
        times.add(0.02, 0.015)
    assert times.lines(0.004) == lines
    for _ in range(20):
        times.add(0.02, 0.015)
    assert times.lines(None)[2:4] == ("drawing 5.0 ms, 99 %: 15.0 ms", "no data")
