#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "files/polygon/polygon.hpp"

namespace supple {

/// The index as a vertex id. Fails through `source.fail_here` when it is not below `vertices`; the message
/// names the element.
template <class Source>
std::uint32_t checked_vertex(std::int64_t index, std::uint64_t vertices, const char* element,
                             std::uint64_t number, const Source& source) {
  if (index < 0 || static_cast<std::uint64_t>(index) >= vertices) {
    source.fail_here(element + (' ' + std::to_string(number)) + ": vertex index " + std::to_string(index) +
                     " is out of range; the file has " + std::to_string(vertices) +
                     " vertices, counted from 0");
  }
  return static_cast<std::uint32_t>(index);
}

/// Reads the faces of formats that list the vertices of a face by ids from 0.
class FaceReader {
 public:
  /// Reads the face with the given number in its file, and adds it to the mesh. `next_index()` reads a
  /// corner. A face without corners is none. Fails through `source.fail_here` when an index is not below
  /// `vertices`, and when both corners of a face of two are the same.
  template <class Source, class NextIndex>
  void read(TriangleMesh& mesh, std::uint64_t vertices, std::uint64_t number, std::int64_t corners,
            const Source& source, NextIndex&& next_index) {
    const auto fail = [&](const std::string& message) {
      source.fail_here("face " + std::to_string(number) + message);
    };
    if (corners < 0) fail(" has " + std::to_string(corners) + " corners");
    if (corners == 0) return;
    corners_.clear();
    for (std::int64_t k = 0; k < corners; ++k)
      corners_.push_back(checked_vertex(next_index(), vertices, "face", number, source));
    if (corners == 2 && corners_[0] == corners_[1])
      fail(" is a line that joins vertex " + std::to_string(corners_[0]) + " to itself; leave it out");
    add_face(mesh, fans_, corners_);
  }

  /// Call this after all vertices and faces.
  void finish(TriangleMesh& mesh) const { cut_polygons(mesh, fans_); }

 private:
  std::vector<std::uint32_t> corners_;
  std::vector<PolygonFan> fans_;
};

}  // namespace supple
