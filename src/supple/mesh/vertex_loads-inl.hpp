// Compiled once for each instruction set: include after hwy/highway.h, between HWY_BEFORE_NAMESPACE and
// HWY_AFTER_NAMESPACE of the including file's own namespace.
#if defined(SUPPLE_MESH_VERTEX_LOADS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUPPLE_MESH_VERTEX_LOADS_INL_HPP
#undef SUPPLE_MESH_VERTEX_LOADS_INL_HPP
#else
#define SUPPLE_MESH_VERTEX_LOADS_INL_HPP
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

/// Loads x, y, z and one undefined number. It does not read memory after z.
HWY_INLINE hn::Vec<hn::FixedTag<float, 4>> load_vertex(const float* vertex) {
#if HWY_TARGET <= HWY_AVX3
  const hn::FixedTag<float, 4> tag;
  return hn::MaskedLoad(hn::FirstN(tag, 3), tag, vertex);
#else
  const hn::FixedTag<float, 2> half;
  return hn::Combine(hn::FixedTag<float, 4>(), hn::Set(half, vertex[2]), hn::LoadU(half, vertex));
#endif
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#endif
