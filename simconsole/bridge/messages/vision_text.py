"""vision_msgs: names, types and constants."""

from typing import Final

TEXT: Final = """
MSG: vision_msgs/BoundingBox2D
vision_msgs/Pose2D center
float64 size_x
float64 size_y
===
MSG: vision_msgs/BoundingBox2DArray
std_msgs/Header header
vision_msgs/BoundingBox2D[] boxes
===
MSG: vision_msgs/BoundingBox3D
geometry_msgs/Pose center
geometry_msgs/Vector3 size
===
MSG: vision_msgs/BoundingBox3DArray
std_msgs/Header header
vision_msgs/BoundingBox3D[] boxes
===
MSG: vision_msgs/Classification
std_msgs/Header header
vision_msgs/ObjectHypothesis[] results
===
MSG: vision_msgs/Detection2D
std_msgs/Header header
vision_msgs/ObjectHypothesisWithPose[] results
vision_msgs/BoundingBox2D bbox
string id
===
MSG: vision_msgs/Detection2DArray
std_msgs/Header header
vision_msgs/Detection2D[] detections
===
MSG: vision_msgs/Detection3D
std_msgs/Header header
vision_msgs/ObjectHypothesisWithPose[] results
vision_msgs/BoundingBox3D bbox
string id
===
MSG: vision_msgs/Detection3DArray
std_msgs/Header header
vision_msgs/Detection3D[] detections
===
MSG: vision_msgs/LabelInfo
std_msgs/Header header
vision_msgs/VisionClass[] class_map
float32 threshold
===
MSG: vision_msgs/ObjectHypothesis
string class_id
float64 score
===
MSG: vision_msgs/ObjectHypothesisWithPose
vision_msgs/ObjectHypothesis hypothesis
geometry_msgs/PoseWithCovariance pose
===
MSG: vision_msgs/Point2D
float64 x
float64 y
===
MSG: vision_msgs/Pose2D
vision_msgs/Point2D position
float64 theta
===
MSG: vision_msgs/VisionClass
uint16 class_id
string class_name
===
MSG: vision_msgs/VisionInfo
std_msgs/Header header
string method
string database_location
int32 database_version
"""
