"""What every package needs of the machine: compilation of kernels, files written atomically."""
