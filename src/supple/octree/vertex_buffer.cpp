#include "octree/vertex_buffer.hpp"

namespace supple {

void VertexBuffer::resize(std::size_t count, bool is_double) {
  // Switching the precision gives the other storage back; that happens once, not in the steady state.
  if (is_double != is_double_ || count != count_) {
    if (is_double) std::vector<float>().swap(floats_);
    if (!is_double) std::vector<double>().swap(doubles_);
  }
  if (is_double) doubles_.resize(4 * count);
  if (!is_double) floats_.resize(4 * count);
  count_ = count;
  is_double_ = is_double;
}

template <class Scalar>
bool VertexBuffer::assign(const PositionsView<Scalar>& positions, std::span<const std::uint32_t> octree_order,
                          const Parallel& parallel) {
  resize(positions.count, sizeof(Scalar) == sizeof(double));
  Scalar* const target = storage(Scalar{}).data();
  return parallel.all_of_ranges(positions.count, 16384, [&](std::size_t begin, std::size_t end) {
    Scalar non_finite = 0;  // NaN as soon as one coordinate is NaN or infinite
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3<Scalar> p = positions[i];
      Scalar* const vertex = target + std::size_t{octree_order[i]} * 4;
      vertex[0] = p.x;
      vertex[1] = p.y;
      vertex[2] = p.z;
      non_finite += p.x * 0 + p.y * 0 + p.z * 0;
    }
    return non_finite == 0;
  });
}

template bool VertexBuffer::assign(const PositionsView<float>&, std::span<const std::uint32_t>,
                                   const Parallel&);
template bool VertexBuffer::assign(const PositionsView<double>&, std::span<const std::uint32_t>,
                                   const Parallel&);

}  // namespace supple
