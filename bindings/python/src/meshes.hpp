#pragma once

#include "supple/mesh.hpp"

namespace supple::python {

/// A mesh that Python holds.
struct MeshData {
  TriangleMesh mesh;
};

}  // namespace supple::python
