"""The torque at the rim, and the motor that is commanded: pure."""
