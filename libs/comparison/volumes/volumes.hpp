#pragma once

#include <cstddef>
#include <memory>

#include "octree/volumes/node_volumes.hpp"

namespace supple {

/// `SphereFit::minimal` starts with the sphere of `SphereFit::vertices`. Then it finds the vertex farthest
/// from the centre and computes the smallest sphere of this vertex and of the up to four vertices on the
/// sphere before, again and again, until no vertex is outside. (Gärtner, "Fast and robust smallest enclosing
/// balls", 1999.) It takes the smallest of these spheres after their radii reached the farthest vertex, so
/// the result encloses all vertices and is never larger than the first, even when rounding ends the search
/// early.
///
/// Both fits search the farthest vertex below a node top-down and skip children whose sphere ends before the
/// farthest vertex so far. A refit takes O(n · levels).
std::unique_ptr<NodeVolumes> make_spheres(SphereFit fit, std::size_t nodes);

/// Oriented boxes, rounded outward. Their axes are the principal axes of the surface, as in Gottschalk, Lin
/// and Manocha, "OBBTree", 1996; the area as weight makes them independent of the tessellation. They are
/// never larger than the box of the triangles: they equal that box when the principal axes are worse. They
/// are infinite when coordinates are so large that squares overflow. A refit takes O(vertices · levels).
std::unique_ptr<NodeVolumes> make_oriented_boxes(std::size_t nodes);

/// The slabs that make k-DOPs of the boxes. A refit takes O(vertices).
std::unique_ptr<NodeVolumes> make_kdops(BoundingVolume kind, std::size_t nodes);

}  // namespace supple
