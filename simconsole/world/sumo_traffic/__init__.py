"""SUMO as a source of traffic: stepped with the drive, its road users and signals recorded as inputs."""
