"""Draw the mode table: `python -m simconsole.control.modes.document > docs/modes.md`. A test holds the two equal."""

from simconsole.control.modes.mode_table import MEANING, REACTIONS, REASONS, Trigger
from simconsole.values.signals import Mode

_INTRODUCTION = """# Who drives: the modes

Generated from `simconsole/control/modes/mode_table.py` by
`python -m simconsole.control.modes.document > docs/modes.md`.

A mode changes by this table and by nothing else. Triggers stand in the order of their strength.

Those from `EMERGENCY` to `NO_REACTION` take authority from automation, or from a person who lost the controls. Of one
tick they all take effect, strongest first, each on the mode that the one before it left; none is lost. So a lost wheel
and a lost controller in one tick are a safe stop in that tick, and a take-over request beside a lost wheel stays a
request when the wheel is back.

The others (`STANDSTILL` to `PERSON_READY`, and `MANUAL_ASKED` in a car that stands parked or stopped) are steps towards
driving or towards rest. One of these takes effect, and only in a tick in which none of the first kind did: the
strongest whose mode would withstand all of the first kind that are present. What was asked for and not granted is
refused with its reason in the same tick and never kept (`REFUSED_OVERRULED` where only something stronger stood against
it); `PERSON_READY` and `STANDSTILL` are no asks: they are looked at again in the next tick.

`STOPPED` and `EMERGENCY_STOP` latch: only an act of a person or an operator leaves them. Autonomy is only ever entered
by such an act, and only if every engage condition of `simconsole/control/modes/engage.py` holds.
"""

_AUTHORITY = """## When triggers count

Whatever has to last does so for at least its time, rounded up to whole ticks; an age that expires does so rounded down.

- Wheel and pedals (accelerator and brake) are trusted while they are armed or live.
- STEERING: moved by 8 deg (7 once it counts) or faster than 60 deg/s, from one sample to another at least 50 ms later.
  The angle is taken when a mode in which the car drives itself (AUTONOMOUS to MINIMAL_RISK) is entered from one in
  which it does not, and anew when a lost wheel is back; autonomy asked for again in between takes none. Where only a
  pedal is lost the wheel counts on, but takes effect only when all are trusted.
- A controller that is invalid is not stale as well, whatever its age: its reason is COMMAND_INVALID.
- COMMANDER_LOST and NO_ANSWER on the console's own side concern the ROS side: they do nothing while the ECU commands.
- A take-over request during a wait for lost devices joins that wait while they are lost, and begins its own once they
  are back; either way its reason is given from then on.
- A safe stop that began because wheel or pedals were lost: BRAKE and STEERING count once all of them have been trusted
  again for 0.5 s (`device_back_s`), so that a plug that bounces does not hand the car to and fro. MANUAL_ASKED counts
  at once, and the brake brakes in full all the while.
- STANDSTILL: at most 0.1 m/s for 0.3 s. RESET needs the same.

## When autonomy and shared control are granted

A controller that commands is fresh, not invalid, and has been so without a refused or implausible command for 100 ms
(at least for one tick; for a second from TAKEOVER_REQUESTED and the modes after it); the person does not press the
brake, and has wheel and pedals trusted (autonomy: only if `person_required`); at most 25 m/s, 1 m/s2 of lateral
acceleration, 10 m/s between speed asked for and driven and, above 1 m/s, 0.35 rad between road wheels asked for and
there.

What is refused while the newest command is not finite counts when a finite one comes. Neither an
invalid controller nor an implausible command renews the lease.

## What each mode does

| mode | steering | throttle and brake | clutch and gears |
|---|---|---|---|
| PARKED | held | brake and handbrake on | neutral |
| MANUAL | person | person | person; after autonomy the car until the person's clutch is pressed |
| SHARED | both: blended, or haptic | blended, fixed authority | person, or the car if the controller has a share |
| AUTONOMOUS | controller | controller; person while the accelerator is pressed | car |
| TAKEOVER_REQUESTED | as AUTONOMOUS; escalates after 4 s, MINIMAL_RISK after 10 s | as AUTONOMOUS | car |
| MINIMAL_RISK | the controller if it is well | 2.5 m/s2 by 1.5 m/s3, at most 4 | car |
| the same, with nobody to steer | last angle, slowly to straight | 3.5 m/s2 by 5 m/s3, at most 4 | car |
| STOPPED | held | brake and handbrake on | neutral |
| EMERGENCY_STOP | held | full service brake | car |

A controller steers a safe stop that is not its fault: if it drove; or if a person did and their wheel is lost, and it
is steady and differs from what they steered by at most 2 m/s2 of lateral acceleration.

The person's brake counts in full and at once in every mode, as fast as the foot is, and the brake always beats the
throttle. Authority moves from one side to the other over 0.6 s, starting from the command in force. Every figure is a
setting of `simconsole/profiles/control.py`, with its source.

## Turn indicators and hazard lights

The person's stalk and hazard switch keep their position through every mode. While the controller drives, its indicator
goes before the stalk where it sets one, and either side may put the hazard lights on. MINIMAL_RISK, STOPPED and
EMERGENCY_STOP always show them.

## Authority over steering in SHARED

`shared_authority` of the profile says how much the controller has; it never moves faster than the fade.

| rule | authority of the controller |
|---|---|
| fixed | `shared_lateral` |
| line_crossing | `shared_lateral` down to 2 s before the lane would be left, `shared_lateral_urgent` at 0.8 s |
| traded | `shared_lateral`; none after a second of pushing against it with 1.5 N m, and back in a second of peace |

The time to line crossing is that of the person's steering against the line that the controller steers: two arcs that
part by `shared_line_margin_m`. `shared_steering` says what authority is over: `blended` weighs the two angles (the
weights sum to one) and guides the hands through the motor as well; `haptic` acts through the motor alone, and the road
wheels follow the hand wheel.

## Steering that cannot be meant

A command that asks for more than twice the gate's lateral acceleration at the present speed, 10 m/s2 (a road tyre
gives less), is a mistake of its sender: full lock is one at 13 m/s and none at walking pace. It is refused whole, in
words (`REFUSED_IMPLAUSIBLE`): the angle and the pedals in force are held, except that it may release the throttle and
brake harder, for an emergency may mean that. It counts as a refused command: five in a row, and the controller is
invalid. It does not renew anything either: 200 ms after the last plausible command (`command_stale_s`, rounded down to
whole ticks) the controller is invalid or stale, whatever has come since then, at any rate and in any order.

## What the last gate lets pass

Every path goes through it, a person's too. What it changes is told by limit (`command.gate_active`) and counted in
ticks (`command.gate_active_ticks`).

| | MANUAL, SHARED | AUTONOMOUS, TAKEOVER_REQUESTED, the controller's part in SHARED | stops |
|---|---|---|---|
| finite, in range, a gear that exists | yes | yes | yes |
| steering rate | 1500 deg/s at the hand wheel | 1 rad/s at the road wheels | 0.5 rad/s at the road wheels |
| lateral acceleration | free | 5 m/s2 | 5 m/s2, EMERGENCY_STOP free |
| lateral jerk | free | 7 m/s3 | 7 m/s3 |
| throttle, brake | a stroke in 40 ms | 4/s, 6/s | throttle cut at once; brake 6/s, EMERGENCY_STOP in the same tick |

In MANUAL the wheel acts in the same tick: the only limits are the lock and a rate above what the fastest hands reach
(about 1100 deg/s). Lateral acceleration and jerk stay free there: catching a skid or swerving around an obstacle needs
more of both than any comfort limit leaves.
"""


def text() -> str:
    """Return the whole page."""
    return "\n".join([_INTRODUCTION, _diagram(), _table(), _triggers(), _AUTHORITY])


def _diagram() -> str:
    lines = ["```mermaid", "stateDiagram-v2", f"    [*] --> {Mode.PARKED.name}"]
    for mode in Mode:
        for target in Mode:
            names = [trigger.name for trigger, after in sorted(REACTIONS[mode].items()) if after == target]
            if names:
                lines.append(f"    {mode.name} --> {target.name}: {', '.join(names)}")
    return "\n".join([*lines, "```", ""])


def _table() -> str:
    lines = ["## The table", "", "A dot: the mode stays.", ""]
    lines.append(f"| trigger, strongest first | {' | '.join(mode.name for mode in Mode)} |")
    lines.append("|---" * (len(Mode) + 1) + "|")
    for trigger in Trigger:
        cells = [REACTIONS[mode][trigger].name if trigger in REACTIONS[mode] else "." for mode in Mode]
        lines.append(f"| {trigger.name} | {' | '.join(cells)} |")
    return "\n".join([*lines, ""])


def _triggers() -> str:
    lines = ["## The triggers", "", "| trigger | when | reason given |", "|---|---|---|"]
    lines += [f"| {trigger.name} | {MEANING[trigger]} | {REASONS[trigger].name} |" for trigger in Trigger]
    note = (
        "`PERSON_ASKED` becomes `OPERATOR_ASKED` where no button of the wheel was pressed. What an operator asks for\n"
        "through `/console/operate` is told as the operator's: `OPERATOR_EMERGENCY`, `OPERATOR_RESET`, and\n"
        "`OPERATOR_ASKED` for a take-over request, which is `PERSON_ASKED` where the wheel's button made it."
    )
    return "\n".join([*lines, "", note, ""])


if __name__ == "__main__":
    print(text(), end="")
