#include "scene/element_candidates.hpp"

#include <type_traits>

namespace supple {
namespace {

template <class Scalar>
void set_motions_of(const std::array<const MovingObject*, 4>& objects,
                    std::span<const std::array<std::uint32_t, 4>> vertices, bool are_edges, float latest,
                    RelativeMotionBlock& block) {
  const auto paths = [&](std::size_t i) -> VertexPaths<Scalar> {
    if constexpr (std::is_same_v<Scalar, float>)
      return {objects[i]->start->floats(), objects[i]->end->floats()};
    else
      return {objects[i]->start->doubles(), objects[i]->end->doubles()};
  };
  set_motions({paths(0), paths(1), paths(2), paths(3)}, vertices.data(), vertices.size(), are_edges, latest,
              block);
}

}  // namespace

void set_motion(bool are_edges, const std::array<const MovingObject*, 4>& objects,
                const std::array<std::uint32_t, 4>& vertices, ElementMotion& motion) {
  motion.are_edges = are_edges;
  for (std::size_t i = 0; i < 4; ++i) {
    motion.start[i] = placed((*objects[i]->start)[vertices[i]], *objects[i]);
    motion.end[i] = placed((*objects[i]->end)[vertices[i]], *objects[i]);
  }
}

void fill(const std::array<const MovingObject*, 4>& objects,
          std::span<const std::array<std::uint32_t, 4>> vertices, bool are_edges, float latest,
          RelativeMotionBlock& block) {
  const MovingObject &first = *objects.front(), &last = *objects.back();
  const bool is_translated = first.view.translation != Vec3d{} || last.view.translation != Vec3d{};
  if (!is_translated && first.end->is_double() == last.end->is_double()) {
    const auto set = first.end->is_double() ? set_motions_of<double> : set_motions_of<float>;
    return set(objects, vertices, are_edges, latest, block);
  }
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    ElementMotion motion;
    set_motion(are_edges, objects, vertices[k], motion);
    for (std::size_t i = 0; latest < 1 && i < 4; ++i)
      motion.end[i] = (1 - double{latest}) * motion.start[i] + double{latest} * motion.end[i];
    block.set(k, relative_motion(motion));
  }
}

}  // namespace supple
