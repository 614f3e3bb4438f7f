"""The same calls as other libraries: `compat.trimesh` and `compat.ipctk`."""
