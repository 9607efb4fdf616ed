"""geographic_msgs: names, types and constants of its ROS 2 release."""

from typing import Final

TEXT: Final = """
MSG: geographic_msgs/BoundingBox
geographic_msgs/GeoPoint min_pt
geographic_msgs/GeoPoint max_pt
===
MSG: geographic_msgs/GeoPath
std_msgs/Header header
geographic_msgs/GeoPoseStamped[] poses
===
MSG: geographic_msgs/GeoPoint
float64 latitude
float64 longitude
float64 altitude
===
MSG: geographic_msgs/GeoPointStamped
std_msgs/Header header
geographic_msgs/GeoPoint position
===
MSG: geographic_msgs/GeoPose
geographic_msgs/GeoPoint position
geometry_msgs/Quaternion orientation
===
MSG: geographic_msgs/GeoPoseStamped
std_msgs/Header header
geographic_msgs/GeoPose pose
===
MSG: geographic_msgs/GeoPoseWithCovariance
geographic_msgs/GeoPose pose
float64[36] covariance
===
MSG: geographic_msgs/GeoPoseWithCovarianceStamped
std_msgs/Header header
geographic_msgs/GeoPoseWithCovariance pose
===
MSG: geographic_msgs/GeographicMap
std_msgs/Header header
unique_identifier_msgs/UUID id
geographic_msgs/BoundingBox bounds
geographic_msgs/WayPoint[] points
geographic_msgs/MapFeature[] features
geographic_msgs/KeyValue[] props
===
MSG: geographic_msgs/GeographicMapChanges
std_msgs/Header header
geographic_msgs/GeographicMap diffs
unique_identifier_msgs/UUID[] deletes
===
MSG: geographic_msgs/KeyValue
string key
string value
===
MSG: geographic_msgs/MapFeature
unique_identifier_msgs/UUID id
unique_identifier_msgs/UUID[] components
geographic_msgs/KeyValue[] props
===
MSG: geographic_msgs/RouteNetwork
std_msgs/Header header
unique_identifier_msgs/UUID id
geographic_msgs/BoundingBox bounds
geographic_msgs/WayPoint[] points
geographic_msgs/RouteSegment[] segments
geographic_msgs/KeyValue[] props
===
MSG: geographic_msgs/RoutePath
std_msgs/Header header
unique_identifier_msgs/UUID network
unique_identifier_msgs/UUID[] segments
geographic_msgs/KeyValue[] props
===
MSG: geographic_msgs/RouteSegment
unique_identifier_msgs/UUID id
unique_identifier_msgs/UUID start
unique_identifier_msgs/UUID end
geographic_msgs/KeyValue[] props
===
MSG: geographic_msgs/WayPoint
unique_identifier_msgs/UUID id
geographic_msgs/GeoPoint position
geographic_msgs/KeyValue[] props
"""
