#include "studies/box_field.hpp"

#include <cmath>
#include <random>

#include "supple/comparison.hpp"

namespace supple::experiments {

BoxField::BoxField(std::size_t count, std::uint64_t seed, std::size_t stride)
    : side_(static_cast<float>(std::cbrt(8.0 * static_cast<double>(count)))), stride_(stride) {
  std::mt19937_64 random(seed);
  // The distributions differ between standard libraries.
  const auto uniform = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53);
  };
  boxes_.reserve(count);
  velocities_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Aabb box;
    Vec3f velocity;
    for (int axis = 0; axis < 3; ++axis) {
      const float extent = uniform(0.5, 1);
      box.min[axis] = uniform(0, side_ - extent);
      box.max[axis] = box.min[axis] + extent;
      velocity[axis] = uniform(-0.05, 0.05);
    }
    boxes_.push_back(box);
    velocities_.push_back(velocity);
  }
}

void BoxField::move() {
  for (std::size_t i = 0; i < boxes_.size(); i += stride_) {
    for (int axis = 0; axis < 3; ++axis) {
      float& velocity = velocities_[i][axis];
      if ((boxes_[i].min[axis] < 0 && velocity < 0) || (boxes_[i].max[axis] > side_ && velocity > 0))
        velocity = -velocity;
      boxes_[i].min[axis] += velocity;
      boxes_[i].max[axis] += velocity;
    }
  }
}

BroadPhaseOptions broad_phase_of_2007(const BoxField& field, bool grows) {
  BroadPhaseOptions options;
  options.threads = 1;
  options.method = BroadPhaseMethod::octree;
  options.scene_octree = with_method_of_2007({}).scene_octree;
  options.scene_octree.root = field.cube();
  std::uint32_t& level = options.scene_octree.max_level;
  while (grows && level < most_full_levels && field.cube().edge / (2 << level) > 1) ++level;
  return options;
}

}  // namespace supple::experiments
