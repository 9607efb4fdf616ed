"""Interfaces of driving: ackermann_msgs and the console's own; Autoware's stand in autoware_text.py."""

from typing import Final

TEXT: Final = """
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
MSG: simconsole_msgs/Arbitration
std_msgs/Header header
uint8 mode
uint8 reason
string mode_words
string reason_words
# Why the latest request was refused, shown for a while; 0 and empty: none.
uint8 refusal
string refusal_words
# What the person is told for as long as it is so; 0 and empty: nothing.
uint8 notice
string notice_words
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
# Not taken at the bridge, or not followed because they steer too hard to be meant at the car's speed.
uint64 commands_refused
# Seconds since the newest accepted command was received; -1 before the first.
float64 command_age
================================================================================
MSG: simconsole_msgs/Bridge
std_msgs/Header header
# Who holds the commander's lease; empty: nobody.
string commander
# How it stands with the server that the console is a client of: connecting, connected, lost; empty: none.
string upstream
# How the link stands, as the driver reads it: nobody, N clients, commander, lost (all have gone), connecting or
# retrying (upstream was never there, or was lost).
string state
# How many clients there have been, and messages of all of them, also of those that are gone.
uint64 connections
uint64 received
uint64 refused
# Commands passed over because a client sent too many.
uint64 throttled
uint64 sent
# Lost because a client was too slow.
uint64 dropped
BridgeClient[] clients
================================================================================
MSG: simconsole_msgs/BridgeClient
string peer
string role
uint64 received
uint64 refused
uint64 throttled
uint64 sent
uint64 dropped
uint64 waiting_bytes
# What it is subscribed to, and how many messages of each it has lost.
string[] topics
uint64[] topics_dropped
"""
