"""std_msgs, as ROS 2 Kilted has it: names, types and constants, without comments."""

from typing import Final

TEXT: Final = """
MSG: std_msgs/Bool
bool data
===
MSG: std_msgs/Byte
byte data
===
MSG: std_msgs/ByteMultiArray
std_msgs/MultiArrayLayout layout
byte[] data
===
MSG: std_msgs/Char
char data
===
MSG: std_msgs/ColorRGBA
float32 r
float32 g
float32 b
float32 a
===
MSG: std_msgs/Empty
===
MSG: std_msgs/Float32
float32 data
===
MSG: std_msgs/Float32MultiArray
std_msgs/MultiArrayLayout layout
float32[] data
===
MSG: std_msgs/Float64
float64 data
===
MSG: std_msgs/Float64MultiArray
std_msgs/MultiArrayLayout layout
float64[] data
===
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
===
MSG: std_msgs/Int16
int16 data
===
MSG: std_msgs/Int16MultiArray
std_msgs/MultiArrayLayout layout
int16[] data
===
MSG: std_msgs/Int32
int32 data
===
MSG: std_msgs/Int32MultiArray
std_msgs/MultiArrayLayout layout
int32[] data
===
MSG: std_msgs/Int64
int64 data
===
MSG: std_msgs/Int64MultiArray
std_msgs/MultiArrayLayout layout
int64[] data
===
MSG: std_msgs/Int8
int8 data
===
MSG: std_msgs/Int8MultiArray
std_msgs/MultiArrayLayout layout
int8[] data
===
MSG: std_msgs/MultiArrayDimension
string label
uint32 size
uint32 stride
===
MSG: std_msgs/MultiArrayLayout
std_msgs/MultiArrayDimension[] dim
uint32 data_offset
===
MSG: std_msgs/String
string data
===
MSG: std_msgs/UInt16
uint16 data
===
MSG: std_msgs/UInt16MultiArray
std_msgs/MultiArrayLayout layout
uint16[] data
===
MSG: std_msgs/UInt32
uint32 data
===
MSG: std_msgs/UInt32MultiArray
std_msgs/MultiArrayLayout layout
uint32[] data
===
MSG: std_msgs/UInt64
uint64 data
===
MSG: std_msgs/UInt64MultiArray
std_msgs/MultiArrayLayout layout
uint64[] data
===
MSG: std_msgs/UInt8
uint8 data
===
MSG: std_msgs/UInt8MultiArray
std_msgs/MultiArrayLayout layout
uint8[] data
"""
