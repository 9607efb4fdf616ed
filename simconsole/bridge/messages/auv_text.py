"""auv_msgs, the interfaces of underwater vehicles that the paper names: names, types and constants."""

from typing import Final

TEXT: Final = """
MSG: auv_msgs/BodyForceReq
std_msgs/Header header
auv_msgs/GoalDescriptor goal
geometry_msgs/Wrench wrench
auv_msgs/Bool6Axis disable_axis
auv_msgs/Windup6Axis windup
===
MSG: auv_msgs/BodyVelocityReq
std_msgs/Header header
auv_msgs/GoalDescriptor goal
geometry_msgs/Twist twist
auv_msgs/Bool6Axis disable_axis
===
MSG: auv_msgs/Bool6Axis
bool x
bool y
bool z
bool roll
bool pitch
bool yaw
===
MSG: auv_msgs/DecimalLatLon
float64 latitude
float64 longitude
===
MSG: auv_msgs/GoalDescriptor
uint32 PRIORITY_LOW=0
uint32 PRIORITY_NORMAL=10
uint32 PRIORITY_AVOID_OBSTACLE=20
uint32 PRIORITY_EMERGENCY=30
uint32 PRIORITY_MANUAL_OVERRIDE=40
string requester
uint32 id
uint32 priority
===
MSG: auv_msgs/NED
float64 north
float64 east
float64 depth
===
MSG: auv_msgs/NavSts
uint8 STATUS_FAULT=0
uint8 STATUS_LOCAL_FRAME_OK=1
uint8 STATUS_GLOBAL_FRAME_OK=2
uint8 STATUS_POSITION_OK=3
uint8 STATUS_VELOCITY_OK=4
uint8 STATUS_ESTIMATION_ERROR_OK=8
uint8 STATUS_ALL_OK=15
std_msgs/Header header
auv_msgs/DecimalLatLon global_position
auv_msgs/DecimalLatLon origin
auv_msgs/NED position
float32 altitude
geometry_msgs/Point body_velocity
auv_msgs/RPY orientation
auv_msgs/RPY orientation_rate
auv_msgs/NED position_variance
auv_msgs/RPY orientation_variance
uint8 status
===
MSG: auv_msgs/NavStsReq
std_msgs/Header header
auv_msgs/DecimalLatLon global_position
auv_msgs/DecimalLatLon origin
auv_msgs/GoalDescriptor goal
auv_msgs/NED position
float32 altitude
geometry_msgs/Point body_velocity
auv_msgs/RPY orientation
auv_msgs/RPY orientation_rate
geometry_msgs/Vector3 position_tolerance
auv_msgs/RPY orientation_tolerance
auv_msgs/Bool6Axis disable_axis
===
MSG: auv_msgs/RPY
float32 roll
float32 pitch
float32 yaw
===
MSG: auv_msgs/VehiclePose
auv_msgs/NED position
auv_msgs/RPY orientation
===
MSG: auv_msgs/Windup6Axis
int8 x
int8 y
int8 z
int8 roll
int8 pitch
int8 yaw
"""
