#pragma once

#include "supple/mesh.hpp"

namespace supple::models {

/// The built-in models that `make_model` returns. Building one takes well below a second.
TriangleMesh make_pawn();
TriangleMesh make_fish();
TriangleMesh make_rabbit();
TriangleMesh make_human();
TriangleMesh make_bike();

}  // namespace supple::models
