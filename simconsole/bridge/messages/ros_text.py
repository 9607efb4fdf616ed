"""The usual ROS 2 interfaces (Jazzy) that the console speaks: names, types and defaults, without their comments."""

from typing import Final

TEXT: Final = """
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
===
MSG: builtin_interfaces/Duration
int32 sec
uint32 nanosec
===
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
===
MSG: std_msgs/Empty
===
MSG: std_msgs/Bool
bool data
===
MSG: std_msgs/String
string data
===
MSG: std_msgs/Byte
byte data
===
MSG: std_msgs/Char
char data
===
MSG: std_msgs/Int8
int8 data
===
MSG: std_msgs/Int16
int16 data
===
MSG: std_msgs/Int32
int32 data
===
MSG: std_msgs/Int64
int64 data
===
MSG: std_msgs/UInt8
uint8 data
===
MSG: std_msgs/UInt16
uint16 data
===
MSG: std_msgs/UInt32
uint32 data
===
MSG: std_msgs/UInt64
uint64 data
===
MSG: std_msgs/Float32
float32 data
===
MSG: std_msgs/Float64
float64 data
===
MSG: std_msgs/ColorRGBA
float32 r
float32 g
float32 b
float32 a
===
MSG: std_msgs/MultiArrayDimension
string label
uint32 size
uint32 stride
===
MSG: std_msgs/MultiArrayLayout
MultiArrayDimension[] dim
uint32 data_offset
===
MSG: std_msgs/Float64MultiArray
MultiArrayLayout layout
float64[] data
===
MSG: std_msgs/UInt8MultiArray
MultiArrayLayout layout
uint8[] data
===
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
===
MSG: geometry_msgs/Vector3Stamped
std_msgs/Header header
Vector3 vector
===
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
===
MSG: geometry_msgs/Point32
float32 x
float32 y
float32 z
===
MSG: geometry_msgs/PointStamped
std_msgs/Header header
Point point
===
MSG: geometry_msgs/Polygon
Point32[] points
===
MSG: geometry_msgs/Quaternion
float64 x 0
float64 y 0
float64 z 0
float64 w 1
===
MSG: geometry_msgs/Pose
Point position
Quaternion orientation
===
MSG: geometry_msgs/Pose2D
float64 x
float64 y
float64 theta
===
MSG: geometry_msgs/PoseStamped
std_msgs/Header header
Pose pose
===
MSG: geometry_msgs/PoseArray
std_msgs/Header header
Pose[] poses
===
MSG: geometry_msgs/PoseWithCovariance
Pose pose
float64[36] covariance
===
MSG: geometry_msgs/PoseWithCovarianceStamped
std_msgs/Header header
PoseWithCovariance pose
===
MSG: geometry_msgs/Transform
Vector3 translation
Quaternion rotation
===
MSG: geometry_msgs/TransformStamped
std_msgs/Header header
string child_frame_id
Transform transform
===
MSG: geometry_msgs/Twist
Vector3 linear
Vector3 angular
===
MSG: geometry_msgs/TwistStamped
std_msgs/Header header
Twist twist
===
MSG: geometry_msgs/TwistWithCovariance
Twist twist
float64[36] covariance
===
MSG: geometry_msgs/TwistWithCovarianceStamped
std_msgs/Header header
TwistWithCovariance twist
===
MSG: geometry_msgs/Accel
Vector3 linear
Vector3 angular
===
MSG: geometry_msgs/AccelStamped
std_msgs/Header header
Accel accel
===
MSG: geometry_msgs/Wrench
Vector3 force
Vector3 torque
===
MSG: geometry_msgs/WrenchStamped
std_msgs/Header header
Wrench wrench
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
MSG: sensor_msgs/Joy
std_msgs/Header header
float32[] axes
int32[] buttons
===
MSG: sensor_msgs/Imu
std_msgs/Header header
geometry_msgs/Quaternion orientation
float64[9] orientation_covariance
geometry_msgs/Vector3 angular_velocity
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration
float64[9] linear_acceleration_covariance
===
MSG: sensor_msgs/JointState
std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
===
MSG: sensor_msgs/LaserScan
std_msgs/Header header
float32 angle_min
float32 angle_max
float32 angle_increment
float32 time_increment
float32 scan_time
float32 range_min
float32 range_max
float32[] ranges
float32[] intensities
===
MSG: tf2_msgs/TFMessage
geometry_msgs/TransformStamped[] transforms
===
MSG: rosgraph_msgs/Clock
builtin_interfaces/Time clock
"""
