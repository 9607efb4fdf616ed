"""What the driver hears, as samples: from a tick to six columns of sound. No device, no clock."""
