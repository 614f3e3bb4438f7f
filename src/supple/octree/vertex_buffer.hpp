#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "supple/types.hpp"

namespace supple {

/// The positions of an object in octree order, in the precision they were given in. Four scalars a vertex (x,
/// y, z and an unused one), so that one vector load reads a vertex.
class VertexBuffer {
 public:
  std::size_t size() const { return count_; }
  bool is_double() const { return is_double_; }
  const float* floats() const { return floats_.data(); }
  const double* doubles() const { return doubles_.data(); }

  Vec3d operator[](std::uint32_t vertex) const {
    const std::size_t i = std::size_t{vertex} * 4;
    if (is_double_) return {doubles_[i], doubles_[i + 1], doubles_[i + 2]};
    return {floats_[i], floats_[i + 1], floats_[i + 2]};
  }

  /// Vertex `octree_order[i]` of the buffer becomes `positions[i]`. Returns whether all of them are finite.
  template <class Scalar>
  bool assign(const PositionsView<Scalar>& positions, std::span<const std::uint32_t> octree_order,
              const Parallel& parallel);

  /// Each vertex becomes `function(vertex)` of `source`, in double. Returns whether all of them are finite.
  template <class Function>
  bool transform(const VertexBuffer& source, const Parallel& parallel, const Function& function);

  std::size_t bytes() const {
    return floats_.capacity() * sizeof(float) + doubles_.capacity() * sizeof(double);
  }

 private:
  void resize(std::size_t count, bool is_double);
  std::vector<float>& storage(float) { return floats_; }
  std::vector<double>& storage(double) { return doubles_; }

  std::vector<float> floats_;
  std::vector<double> doubles_;
  std::size_t count_ = 0;
  bool is_double_ = false;
};

template <class Function>
bool VertexBuffer::transform(const VertexBuffer& source, const Parallel& parallel, const Function& function) {
  const std::size_t count = source.size();
  resize(count, true);
  return parallel.all_of_ranges(count, 16384, [&](std::size_t begin, std::size_t end) {
    double non_finite = 0;  // NaN as soon as one coordinate is NaN or infinite
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3d p = function(source[static_cast<std::uint32_t>(i)]);
      doubles_[4 * i] = p.x;
      doubles_[4 * i + 1] = p.y;
      doubles_[4 * i + 2] = p.z;
      non_finite += p.x * 0 + p.y * 0 + p.z * 0;
    }
    return non_finite == 0;
  });
}

}  // namespace supple
