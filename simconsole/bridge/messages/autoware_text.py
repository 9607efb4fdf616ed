"""autoware_control_msgs, autoware_vehicle_msgs and, of tier4_vehicle_msgs, the actuation command."""

from typing import Final

_GEARS: Final = """\
uint8 NONE=0
uint8 NEUTRAL=1
uint8 DRIVE=2
uint8 DRIVE_2=3
uint8 DRIVE_3=4
uint8 DRIVE_4=5
uint8 DRIVE_5=6
uint8 DRIVE_6=7
uint8 DRIVE_7=8
uint8 DRIVE_8=9
uint8 DRIVE_9=10
uint8 DRIVE_10=11
uint8 DRIVE_11=12
uint8 DRIVE_12=13
uint8 DRIVE_13=14
uint8 DRIVE_14=15
uint8 DRIVE_15=16
uint8 DRIVE_16=17
uint8 DRIVE_17=18
uint8 DRIVE_18=19
uint8 REVERSE=20
uint8 REVERSE_2=21
uint8 PARK=22
uint8 LOW=23
uint8 LOW_2=24
"""
"""Of the command and of the report."""

TEXT: Final = f"""
MSG: autoware_control_msgs/Control
builtin_interfaces/Time stamp
builtin_interfaces/Time control_time
autoware_control_msgs/Lateral lateral
autoware_control_msgs/Longitudinal longitudinal
===
MSG: autoware_control_msgs/ControlHorizon
builtin_interfaces/Time stamp
builtin_interfaces/Time control_time
float32 time_step_ms
autoware_control_msgs/Control[] controls
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
MSG: autoware_vehicle_msgs/ControlModeReport
uint8 NO_COMMAND=0
uint8 AUTONOMOUS=1
uint8 AUTONOMOUS_STEER_ONLY=2
uint8 AUTONOMOUS_VELOCITY_ONLY=3
uint8 MANUAL=4
uint8 DISENGAGED=5
uint8 NOT_READY=6
builtin_interfaces/Time stamp
uint8 mode
===
MSG: autoware_vehicle_msgs/Engage
builtin_interfaces/Time stamp
bool engage
===
MSG: autoware_vehicle_msgs/GearCommand
{_GEARS}builtin_interfaces/Time stamp
uint8 command
===
MSG: autoware_vehicle_msgs/GearReport
{_GEARS}builtin_interfaces/Time stamp
uint8 report
===
MSG: autoware_vehicle_msgs/HazardLightsCommand
uint8 NO_COMMAND=0
uint8 DISABLE=1
uint8 ENABLE=2
builtin_interfaces/Time stamp
uint8 command
===
MSG: autoware_vehicle_msgs/HazardLightsReport
uint8 DISABLE=1
uint8 ENABLE=2
builtin_interfaces/Time stamp
uint8 report
===
MSG: autoware_vehicle_msgs/SteeringReport
builtin_interfaces/Time stamp
float32 steering_tire_angle
===
MSG: autoware_vehicle_msgs/TurnIndicatorsCommand
uint8 NO_COMMAND=0
uint8 DISABLE=1
uint8 ENABLE_LEFT=2
uint8 ENABLE_RIGHT=3
builtin_interfaces/Time stamp
uint8 command
===
MSG: autoware_vehicle_msgs/TurnIndicatorsReport
uint8 DISABLE=1
uint8 ENABLE_LEFT=2
uint8 ENABLE_RIGHT=3
builtin_interfaces/Time stamp
uint8 report
===
MSG: autoware_vehicle_msgs/VelocityReport
std_msgs/Header header
float32 longitudinal_velocity
float32 lateral_velocity
float32 heading_rate
===
MSG: tier4_vehicle_msgs/ActuationCommand
float64 accel_cmd
float64 brake_cmd
float64 steer_cmd
===
MSG: tier4_vehicle_msgs/ActuationCommandStamped
std_msgs/Header header
tier4_vehicle_msgs/ActuationCommand actuation
"""
