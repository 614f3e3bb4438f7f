#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "mesh/vertex_arrays.hpp"
#include "supple/views.hpp"

namespace supple {

/// The positions of an object in their original precision: a copy, or a reference to the user's memory.
class VertexBuffer {
 public:
  std::size_t size() const { return count_; }
  bool is_double() const { return is_double_; }
  /// The data of the other precision are null.
  VertexArray<float> floats() const { return is_double_ ? VertexArray<float>{} : array(floats_); }
  VertexArray<double> doubles() const { return is_double_ ? array(doubles_) : VertexArray<double>{}; }

  Vec3d operator[](std::uint32_t vertex) const {
    if (is_double_) {
      const double* const p = doubles()[vertex];
      return {p[0], p[1], p[2]};
    }
    const float* const p = floats()[vertex];
    return {p[0], p[1], p[2]};
  }

  PositionsView view() const {
    const auto view_of = [&](const auto& array) {
      return PositionsView(array.data, count_,
                           static_cast<std::ptrdiff_t>(array.stride * sizeof *array.data));
    };
    return is_double_ ? view_of(doubles()) : view_of(floats());
  }

  /// Takes memory, so that `assign` and `transform` of this many positions cannot fail.
  void reserve(std::size_t count, bool is_double);
  void assign(const PositionsView& positions, const Parallel& parallel);

  /// Vertex `ids[i]` becomes `positions[i]`, which has the precision of the buffer. Borrowed positions are
  /// copied first.
  void set(std::span<const std::uint32_t> ids, const PositionsView& positions, const Parallel& parallel);

  /// Takes memory, so that `append` of this many positions cannot fail.
  void reserve_more(std::size_t count);
  /// Adds vertices, in the precision of the buffer, which is not borrowed.
  void append(const PositionsView& positions);
  bool is_borrowed() const { return borrowed_ != nullptr; }

  /// Vertex v becomes vertex `ids[v]` of `source`, in the precision of `source`.
  void gather(const VertexBuffer& source, std::span<const std::uint32_t> ids, const Parallel& parallel);

  /// Refers to these positions in the user's memory and frees the copy. Returns false and changes nothing
  /// when the layout does not allow that: x, y, z must be adjacent and aligned.
  bool borrow(const PositionsView& positions);

  /// Vertex v becomes `function(source[v])`, in double: all vertices, or those in `ids`.
  template <class Function>
  void transform(const VertexBuffer& source, const Parallel& parallel, const Function& function);
  template <class Function>
  void transform(const VertexBuffer& source, std::span<const std::uint32_t> ids, const Function& function) {
    for (const std::uint32_t vertex : ids) set_double(vertex, function(source[vertex]));
  }

  std::size_t bytes() const {
    return floats_.capacity() * sizeof(float) + doubles_.capacity() * sizeof(double);
  }

 private:
  void resize(std::size_t count, bool is_double);
  void set(std::size_t vertex, const PositionsView& positions, std::size_t i);
  template <class Scalar>
  void copy(const PositionsView& positions, const Parallel& parallel);
  void set_double(std::size_t vertex, const Vec3d& p) {
    for (std::size_t axis = 0; axis < 3; ++axis) doubles_[3 * vertex + axis] = p[static_cast<int>(axis)];
  }
  std::vector<float>& storage(float) { return floats_; }
  std::vector<double>& storage(double) { return doubles_; }

  template <class Scalar>
  VertexArray<Scalar> array(const std::vector<Scalar>& copy) const {
    if (borrowed_ == nullptr) return {copy.data(), 3};
    return {static_cast<const Scalar*>(borrowed_), borrowed_stride_};
  }

  std::vector<float> floats_;
  std::vector<double> doubles_;
  const void* borrowed_ = nullptr;
  std::size_t borrowed_stride_ = 0;
  std::size_t count_ = 0;
  bool is_double_ = false;
};

template <class Function>
void VertexBuffer::transform(const VertexBuffer& source, const Parallel& parallel, const Function& function) {
  const std::size_t count = source.size();
  resize(count, true);
  parallel.for_ranges(count, 16384, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end; ++i) set_double(i, function(source[static_cast<std::uint32_t>(i)]));
  });
}

}  // namespace supple
