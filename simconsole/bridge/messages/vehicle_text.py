"""Interfaces of driving: ackermann_msgs, Autoware's control and vehicle packages, and the console's own."""

from typing import Final

_GEARS: Final = "\n".join(
    (
        "uint8 NONE = 0",
        "uint8 NEUTRAL = 1",
        "uint8 DRIVE = 2",
        *(f"uint8 DRIVE_{gear} = {gear + 1}" for gear in range(2, 19)),
        "uint8 REVERSE = 20",
        "uint8 REVERSE_2 = 21",
        "uint8 PARK = 22",
        "uint8 LOW = 23",
        "uint8 LOW_2 = 24",
    )
)

TEXT: Final = f"""
MSG: ackermann_msgs/AckermannDrive
float32 steering_angle
float32 steering_angle_velocity
float32 speed
float32 acceleration
float32 jerk
===
MSG: ackermann_msgs/AckermannDriveStamped
std_msgs/Header header
AckermannDrive drive
===
MSG: autoware_control_msgs/Lateral
builtin_interfaces/Time stamp
builtin_interfaces/Time control_time
float32 steering_tire_angle
float32 steering_tire_rotation_rate
bool is_defined_steering_tire_rotation_rate
===
MSG: autoware_control_msgs/Longitudinal
builtin_interfaces/Time stamp
builtin_interfaces/Time control_time
float32 velocity
float32 acceleration
float32 jerk
bool is_defined_acceleration
bool is_defined_jerk
===
MSG: autoware_control_msgs/Control
builtin_interfaces/Time stamp
builtin_interfaces/Time control_time
Lateral lateral
Longitudinal longitudinal
===
MSG: autoware_vehicle_msgs/ControlModeReport
uint8 NO_COMMAND = 0
uint8 AUTONOMOUS = 1
uint8 AUTONOMOUS_STEER_ONLY = 2
uint8 AUTONOMOUS_VELOCITY_ONLY = 3
uint8 MANUAL = 4
uint8 DISENGAGED = 5
uint8 NOT_READY = 6
builtin_interfaces/Time stamp
uint8 mode
===
MSG: autoware_vehicle_msgs/GearCommand
{_GEARS}
builtin_interfaces/Time stamp
uint8 command
===
MSG: autoware_vehicle_msgs/GearReport
{_GEARS}
builtin_interfaces/Time stamp
uint8 report
===
MSG: autoware_vehicle_msgs/HazardLightsCommand
uint8 NO_COMMAND = 0
uint8 DISABLE = 1
uint8 ENABLE = 2
builtin_interfaces/Time stamp
uint8 command
===
MSG: autoware_vehicle_msgs/HazardLightsReport
uint8 DISABLE = 1
uint8 ENABLE = 2
builtin_interfaces/Time stamp
uint8 report
===
MSG: autoware_vehicle_msgs/SteeringReport
builtin_interfaces/Time stamp
float32 steering_tire_angle
===
MSG: autoware_vehicle_msgs/TurnIndicatorsCommand
uint8 NO_COMMAND = 0
uint8 DISABLE = 1
uint8 ENABLE_LEFT = 2
uint8 ENABLE_RIGHT = 3
builtin_interfaces/Time stamp
uint8 command
===
MSG: autoware_vehicle_msgs/TurnIndicatorsReport
uint8 DISABLE = 1
uint8 ENABLE_LEFT = 2
uint8 ENABLE_RIGHT = 3
builtin_interfaces/Time stamp
uint8 report
===
MSG: autoware_vehicle_msgs/VelocityReport
std_msgs/Header header
float32 longitudinal_velocity
float32 lateral_velocity
float32 heading_rate
===
MSG: simconsole_msgs/Arbitration
std_msgs/Header header
uint8 mode
uint8 reason
string mode_words
string reason_words
# Why the latest request was refused, shown for a while; 0 and empty: none.
uint8 refusal
string refusal_words
# Share of the remote side, 0 to 1; the person has the rest.
float64 remote_lateral
float64 remote_longitudinal
# What each asks: road wheel in rad, left-positive; pedals 0 to 1.
float64 person_road_wheel
float64 person_throttle
float64 person_brake
float64 remote_road_wheel
float64 remote_throttle
float64 remote_brake
uint8 takeover_stage
# Whose commands are the remote side's: 0 nobody, 1 ROS, 2 the ECU on CAN.
uint8 commander
string commander_words
Controller ros
Controller ecu
================================================================================
MSG: simconsole_msgs/Controller
# 0 no command yet, 1 not steady yet, 2 steady, 3 silent, 4 invalid.
uint8 state
string state_words
# What it asks, whether it commands or not.
float64 road_wheel
float64 throttle
float64 brake
uint64 commands_accepted
uint64 commands_refused
# Seconds since the newest accepted command was received; -1 before the first.
float64 command_age
"""
