"""What every room needs of the machine: compilation of kernels, files written whole."""
