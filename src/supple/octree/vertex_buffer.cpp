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
void VertexBuffer::copy(const PositionsView& positions, std::span<const std::uint32_t> numbers,
                        const Parallel& parallel) {
  Scalar* const target = storage(Scalar{}).data();
  const auto copy_one = [&](std::size_t from, std::size_t to) {
    const Vec3<Scalar> p = positions.get<Scalar>(from);
    target[3 * to] = p.x;
    target[3 * to + 1] = p.y;
    target[3 * to + 2] = p.z;
  };
  parallel.for_ranges(count_, 16384, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    if (numbers.empty()) {
      for (std::size_t i = begin; i < end; ++i) copy_one(i, i);
    } else {
      for (std::size_t i = begin; i < end; ++i) copy_one(i, numbers[i]);
    }
  });
}

void VertexBuffer::assign(const PositionsView& positions, std::span<const std::uint32_t> numbers,
                          const Parallel& parallel) {
  resize(positions.size(), positions.is_double());
  if (is_double_) copy<double>(positions, numbers, parallel);
  if (!is_double_) copy<float>(positions, numbers, parallel);
}

bool VertexBuffer::borrow(const PositionsView& positions) {
  const std::size_t size = positions.is_double() ? sizeof(double) : sizeof(float);
  const auto stride = static_cast<std::size_t>(positions.point_stride());
  const bool is_aligned =
      stride % size == 0 && reinterpret_cast<std::uintptr_t>(positions.data()) % size == 0;
  if (positions.point_stride() < 0 || positions.coordinate_stride() != std::ptrdiff_t(size) || !is_aligned)
    return false;
  std::vector<float>().swap(floats_);
  std::vector<double>().swap(doubles_);
  borrowed_ = positions.data();
  borrowed_stride_ = stride / size;
  count_ = positions.size();
  is_double_ = positions.is_double();
  return true;
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

}  // namespace supple
