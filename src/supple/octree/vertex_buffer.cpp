#include "octree/vertex_buffer.hpp"

#include <algorithm>
#include <cassert>

namespace supple {
namespace {

constexpr std::size_t vertices_of_a_task = 16384;

}  // namespace

void VertexBuffer::reserve(std::size_t count, bool is_double) {
  if (is_double) doubles_.reserve(3 * count + 1);
  if (!is_double) floats_.reserve(3 * count + 1);
}

void VertexBuffer::resize(std::size_t count, bool is_double) {
  reserve(count, is_double);  // before anything changes
  // A change of precision frees the other storage. This happens once, not in the steady state.
  if (is_double != is_double_ || count != count_) {
    if (is_double) std::vector<float>().swap(floats_);
    if (!is_double) std::vector<double>().swap(doubles_);
  }
  // One more scalar, so that kernels can read four scalars from the last vertex on.
  if (is_double) doubles_.resize(3 * count + 1);
  if (!is_double) floats_.resize(3 * count + 1);
  borrowed_ = nullptr;
  count_ = count;
  is_double_ = is_double;
}

template <class Scalar>
void VertexBuffer::copy(const PositionsView& positions, const Parallel& parallel) {
  Scalar* const target = storage(Scalar{}).data();
  parallel.for_ranges(count_, vertices_of_a_task, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3<Scalar> p = positions.get<Scalar>(i);
      target[3 * i] = p.x;
      target[3 * i + 1] = p.y;
      target[3 * i + 2] = p.z;
    }
  });
}

void VertexBuffer::assign(const PositionsView& positions, const Parallel& parallel) {
  resize(positions.size(), positions.is_double());
  if (is_double_) copy<double>(positions, parallel);
  if (!is_double_) copy<float>(positions, parallel);
}

void VertexBuffer::set(std::span<const std::uint32_t> ids, const PositionsView& positions,
                       const Parallel& parallel) {
  assert(ids.size() == positions.size() && (ids.empty() || positions.is_double() == is_double_));
  if (borrowed_ != nullptr) assign(view(), parallel);
  for (std::size_t i = 0; i < ids.size(); ++i) set(ids[i], positions, i);
}

void VertexBuffer::set(std::size_t vertex, const PositionsView& positions, std::size_t i) {
  if (is_double_) return set_double(vertex, positions.get<double>(i));
  const Vec3f p = positions.get<float>(i);
  std::copy_n(&p.x, 3, &floats_[3 * vertex]);
}

void VertexBuffer::reserve_more(std::size_t count) {
  const auto reserve_in = [&](auto& coordinates) {
    const std::size_t needed = 3 * (count_ + count) + 1;
    if (needed > coordinates.capacity()) coordinates.reserve(needed + needed / 4);
  };
  if (is_double_) reserve_in(doubles_);
  if (!is_double_) reserve_in(floats_);
}

void VertexBuffer::append(const PositionsView& positions) {
  assert(borrowed_ == nullptr && positions.is_double() == is_double_);
  const std::size_t first = count_;
  count_ += positions.size();
  if (is_double_) doubles_.resize(3 * count_ + 1);
  if (!is_double_) floats_.resize(3 * count_ + 1);
  for (std::size_t i = 0; i < positions.size(); ++i) set(first + i, positions, i);
}

void VertexBuffer::gather(const VertexBuffer& source, std::span<const std::uint32_t> ids,
                          const Parallel& parallel) {
  assert(&source != this);
  resize(ids.size(), source.is_double_);
  const auto copy = [&](const auto& from, auto* to) {
    parallel.for_ranges(ids.size(), vertices_of_a_task,
                        [&](std::size_t begin, std::size_t end, std::uint32_t) {
                          for (std::size_t v = begin; v < end; ++v) std::copy_n(from[ids[v]], 3, to + 3 * v);
                        });
  };
  if (is_double_) {
    copy(source.doubles(), doubles_.data());
  } else {
    copy(source.floats(), floats_.data());
  }
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

}  // namespace supple
