#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace supple::cli {

/// The numbers of two objects whose descent in the narrow phase is reported (Figure 4 of the paper).
using ObjectNumbers = std::array<std::uint32_t, 2>;

/// Optional parts of the JSON; `contact_details` also of the CSV.
struct JsonContent {
  /// Options, and the times and counts of each frame: the parts that may differ between two runs with the
  /// same results.
  bool stats = true;
  bool contact_details = false;               ///< points, normals and barycentric coordinates of each contact
  bool faces = false;                         ///< the triangles of each object
  std::optional<ObjectNumbers> node_pairs{};  ///< the objects whose colliding nodes are written
};

}  // namespace supple::cli
