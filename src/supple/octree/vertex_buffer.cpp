#include "octree/vertex_buffer.hpp"

#include <cassert>

namespace supple {

void VertexBuffer::resize(std::size_t count, bool is_double) {
  // Switching the precision gives the other storage back; that happens once, not in the steady state.
  if (is_double != is_double_ || count != count_) {
    if (is_double) std::vector<float>().swap(floats_);
    if (!is_double) std::vector<double>().swap(doubles_);
  }
  // One scalar more than there are, so that four can be read from the last vertex on.
  if (is_double) doubles_.resize(3 * count + 1);
  if (!is_double) floats_.resize(3 * count + 1);
  borrowed_ = nullptr;
  count_ = count;
  is_double_ = is_double;
}

template <class Scalar>
void VertexBuffer::assign(const PositionsView<Scalar>& positions, std::span<const std::uint32_t> numbers,
                          const Parallel& parallel) {
  resize(positions.count, sizeof(Scalar) == sizeof(double));
  Scalar* const target = storage(Scalar{}).data();
  const auto copy = [&](std::size_t from, std::size_t to) {
    const Vec3<Scalar> p = positions[from];
    target[3 * to] = p.x;
    target[3 * to + 1] = p.y;
    target[3 * to + 2] = p.z;
  };
  parallel.for_ranges(positions.count, 16384, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    if (numbers.empty()) {
      for (std::size_t i = begin; i < end; ++i) copy(i, i);
    } else {
      for (std::size_t i = begin; i < end; ++i) copy(i, numbers[i]);
    }
  });
}

template <class Scalar>
void VertexBuffer::borrow(const PositionsView<Scalar>& positions) {
  assert(positions.stride % sizeof(Scalar) == 0);
  std::vector<float>().swap(floats_);
  std::vector<double>().swap(doubles_);
  borrowed_ = positions.data;
  borrowed_stride_ = positions.stride / sizeof(Scalar);
  count_ = positions.count;
  is_double_ = sizeof(Scalar) == sizeof(double);
}

VertexBuffer VertexBuffer::renumbered(std::span<const std::uint32_t> numbers) const {
  assert(borrowed_ == nullptr && numbers.size() == count_);
  VertexBuffer result = *this;
  for (std::size_t vertex = 0; vertex < count_; ++vertex) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t from = 3 * vertex + axis, to = 3 * std::size_t{numbers[vertex]} + axis;
      if (is_double_) result.doubles_[to] = doubles_[from];
      if (!is_double_) result.floats_[to] = floats_[from];
    }
  }
  return result;
}

template void VertexBuffer::assign(const PositionsView<float>&, std::span<const std::uint32_t>,
                                   const Parallel&);
template void VertexBuffer::assign(const PositionsView<double>&, std::span<const std::uint32_t>,
                                   const Parallel&);
template void VertexBuffer::borrow(const PositionsView<float>&);
template void VertexBuffer::borrow(const PositionsView<double>&);

}  // namespace supple
