#pragma once

#include "supple/mesh.hpp"

namespace supple::models {

/// The built-in models, as `make_model` gives them. Each costs well below a second.
TriangleMesh make_pawn();
TriangleMesh make_fish();
TriangleMesh make_rabbit();
TriangleMesh make_human();
TriangleMesh make_bike();

}  // namespace supple::models
