"""nav_msgs as ROS 2 Kilted has it, rosgraph_msgs, builtin_interfaces, diagnostic_msgs, tf2_msgs."""

from typing import Final

TEXT: Final = """
MSG: nav_msgs/Goals
std_msgs/Header header
geometry_msgs/PoseStamped[] goals
===
MSG: nav_msgs/GridCells
std_msgs/Header header
float32 cell_width
float32 cell_height
geometry_msgs/Point[] cells
===
MSG: nav_msgs/MapMetaData
builtin_interfaces/Time map_load_time
float32 resolution
uint32 width
uint32 height
geometry_msgs/Pose origin
===
MSG: nav_msgs/OccupancyGrid
std_msgs/Header header
nav_msgs/MapMetaData info
int8[] data
===
MSG: nav_msgs/Odometry
std_msgs/Header header
string child_frame_id
geometry_msgs/PoseWithCovariance pose
geometry_msgs/TwistWithCovariance twist
===
MSG: nav_msgs/Path
std_msgs/Header header
geometry_msgs/PoseStamped[] poses
===
MSG: builtin_interfaces/Duration
int32 sec
uint32 nanosec
===
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
===
MSG: rosgraph_msgs/Clock
builtin_interfaces/Time clock
===
MSG: unique_identifier_msgs/UUID
uint8[16] uuid
===
MSG: diagnostic_msgs/DiagnosticArray
std_msgs/Header header
diagnostic_msgs/DiagnosticStatus[] status
===
MSG: diagnostic_msgs/DiagnosticStatus
byte OK=0
byte WARN=1
byte ERROR=2
byte STALE=3
byte level
string name
string message
string hardware_id
diagnostic_msgs/KeyValue[] values
===
MSG: diagnostic_msgs/KeyValue
string key
string value
===
MSG: tf2_msgs/TF2Error
uint8 NO_ERROR=0
uint8 LOOKUP_ERROR=1
uint8 CONNECTIVITY_ERROR=2
uint8 EXTRAPOLATION_ERROR=3
uint8 INVALID_ARGUMENT_ERROR=4
uint8 TIMEOUT_ERROR=5
uint8 TRANSFORM_ERROR=6
uint8 error
string error_string
===
MSG: tf2_msgs/TFMessage
geometry_msgs/TransformStamped[] transforms
"""
