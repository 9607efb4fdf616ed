"""geometry_msgs, as ROS 2 Kilted has it: names, types and constants, without comments."""

from typing import Final

TEXT: Final = """
MSG: geometry_msgs/Accel
geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
===
MSG: geometry_msgs/AccelStamped
std_msgs/Header header
geometry_msgs/Accel accel
===
MSG: geometry_msgs/AccelWithCovariance
geometry_msgs/Accel accel
float64[36] covariance
===
MSG: geometry_msgs/AccelWithCovarianceStamped
std_msgs/Header header
geometry_msgs/AccelWithCovariance accel
===
MSG: geometry_msgs/Inertia
float64 m
geometry_msgs/Vector3 com
float64 ixx
float64 ixy
float64 ixz
float64 iyy
float64 iyz
float64 izz
===
MSG: geometry_msgs/InertiaStamped
std_msgs/Header header
geometry_msgs/Inertia inertia
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
geometry_msgs/Point point
===
MSG: geometry_msgs/Polygon
geometry_msgs/Point32[] points
===
MSG: geometry_msgs/PolygonInstance
geometry_msgs/Polygon polygon
int64 id
===
MSG: geometry_msgs/PolygonInstanceStamped
std_msgs/Header header
geometry_msgs/PolygonInstance polygon
===
MSG: geometry_msgs/PolygonStamped
std_msgs/Header header
geometry_msgs/Polygon polygon
===
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
===
MSG: geometry_msgs/Pose2D
float64 x
float64 y
float64 theta
===
MSG: geometry_msgs/PoseArray
std_msgs/Header header
geometry_msgs/Pose[] poses
===
MSG: geometry_msgs/PoseStamped
std_msgs/Header header
geometry_msgs/Pose pose
===
MSG: geometry_msgs/PoseWithCovariance
geometry_msgs/Pose pose
float64[36] covariance
===
MSG: geometry_msgs/PoseWithCovarianceStamped
std_msgs/Header header
geometry_msgs/PoseWithCovariance pose
===
MSG: geometry_msgs/Quaternion
float64 x 0.0
float64 y 0.0
float64 z 0.0
float64 w 1.0
===
MSG: geometry_msgs/QuaternionStamped
std_msgs/Header header
geometry_msgs/Quaternion quaternion
===
MSG: geometry_msgs/Transform
geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
===
MSG: geometry_msgs/TransformStamped
std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
===
MSG: geometry_msgs/Twist
geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
===
MSG: geometry_msgs/TwistStamped
std_msgs/Header header
geometry_msgs/Twist twist
===
MSG: geometry_msgs/TwistWithCovariance
geometry_msgs/Twist twist
float64[36] covariance
===
MSG: geometry_msgs/TwistWithCovarianceStamped
std_msgs/Header header
geometry_msgs/TwistWithCovariance twist
===
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
===
MSG: geometry_msgs/Vector3Stamped
std_msgs/Header header
geometry_msgs/Vector3 vector
===
MSG: geometry_msgs/VelocityStamped
std_msgs/Header header
string body_frame_id
string reference_frame_id
geometry_msgs/Twist velocity
===
MSG: geometry_msgs/Wrench
geometry_msgs/Vector3 force
geometry_msgs/Vector3 torque
===
MSG: geometry_msgs/WrenchStamped
std_msgs/Header header
geometry_msgs/Wrench wrench
"""
