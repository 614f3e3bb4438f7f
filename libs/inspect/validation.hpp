#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "octree/vertex_buffer.hpp"

namespace supple {

class MovingBoxes;
class ObjectOctree;
class SurfaceElements;
class World;

// The empty string when every invariant holds; otherwise what is wrong.

/// Every volume encloses its triangles. Spheres fitted to boxes need not enclose and are not checked.
std::string fault_of(const ObjectOctree& octree, const VertexBuffer& vertices,
                     std::span<const std::uint8_t> inert);
/// O(n log n).
std::string fault_of(const SurfaceElements& elements, const ObjectOctree& octree);
/// Every box is that of its elements.
std::string fault_of(const MovingBoxes& boxes, const ObjectOctree& octree, const SurfaceElements& elements,
                     const VertexBuffer& start, const VertexBuffer& end);
/// The shapes of all objects that are up to date.
std::string fault_of(const World& world);

}  // namespace supple
