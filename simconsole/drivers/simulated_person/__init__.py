"""What a simulated person perceives, decides and can do: pure."""
