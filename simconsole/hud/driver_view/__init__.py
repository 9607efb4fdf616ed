"""The road as the driver sees it: cameras, meshes and what stands beside the road. Pure arrays, no graphics library."""
