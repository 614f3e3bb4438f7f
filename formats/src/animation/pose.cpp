#include <algorithm>
#include <cmath>

#include "animation/angles.hpp"
#include "animation/animated_model.hpp"
#include "supple/trigonometry.hpp"

namespace supple {
namespace {

void interpolate_rotation(std::span<double> a, std::span<const double> b, double part) {
  double cosine = 0;
  for (std::size_t i = 0; i < 4; ++i) cosine += a[i] * b[i];
  const double sign = cosine < 0 ? -1 : 1;
  cosine *= sign;
  // The part of b that is normal to a has the length of the sine.
  double squared = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double normal = sign * b[i] - cosine * a[i];
    squared += normal * normal;
  }
  const double sine = std::sqrt(squared);
  double of_a = 1 - part, of_b = part;
  if (sine > 1e-6) {
    const double turns = angle_in_turns(cosine, sine);
    of_a = sin_turns((1 - part) * turns) / sine;
    of_b = sin_turns(part * turns) / sine;
  }
  for (std::size_t i = 0; i < 4; ++i) a[i] = of_a * a[i] + of_b * sign * b[i];
}

/// The cubic Hermite spline of glTF between keys `left` and `left` + 1.
double spline(const AnimationTrack& track, std::size_t left, std::size_t i, double part, double seconds) {
  const std::size_t width = track.width();
  const auto number = [&](std::size_t key, std::size_t kind) {
    return track.values[(3 * key + kind) * width + i];
  };
  const double p2 = part * part, p3 = p2 * part;
  return (2 * p3 - 3 * p2 + 1) * number(left, 1) + seconds * (p3 - 2 * p2 + part) * number(left, 2) +
         (3 * p2 - 2 * p3) * number(left + 1, 1) + seconds * (p3 - p2) * number(left + 1, 0);
}

void put(ModelNode& node, const AnimationTrack& track, const std::vector<double>& value) {
  const auto vector = [&] { return Vec3d{value[0], value[1], value[2]}; };
  if (track.property == Animated::translation)
    node.translation = vector();
  else if (track.property == Animated::scale)
    node.scale = vector();
  else if (track.property == Animated::rotation)
    node.rotation = {value[0], value[1], value[2], value[3]};
  else if (track.weight && *track.weight < node.weights.size())
    node.weights[*track.weight] = value[0];
  else if (!track.weight)
    node.weights = value;
  if (track.property != Animated::weights) node.matrix.reset();
}

/// A vertex with the displacements of its morph targets.
Vec3d morphed(const ModelPart& part, const std::vector<double>& weights, std::size_t vertex) {
  Vec3d point = part.points[vertex];
  for (std::size_t i = 0; i < std::min(weights.size(), part.targets.size()); ++i) {
    if (weights[i] != 0) point = point + weights[i] * part.targets[i][vertex];
  }
  return point;
}

/// The mean of what the joints make of a point. It is exact where all of them agree.
Vec3d skinned(const std::vector<Transform>& joints, const std::vector<Influence>& influences,
              const Vec3d& point) {
  const Vec3d first = apply(joints[influences[0].joint], point);
  Vec3d result = first;
  for (std::size_t i = 1; i < influences.size(); ++i)
    result = result + influences[i].weight * (apply(joints[influences[i].joint], point) - first);
  return result;
}

}  // namespace

double angle_in_turns(double cosine, double sine) {
  constexpr double turn = 6.283185307179586;
  double turns = 2 * sine / (1 + cosine) / turn;
  // Each step cubes the error, which is at most 0.43 at the start.
  for (int step = 0; step < 4; ++step) turns += (sine * cos_turns(turns) - cosine * sin_turns(turns)) / turn;
  return turns;
}

std::vector<double> value_at(const AnimationTrack& track, double time) {
  const std::size_t width = track.width();
  const bool is_spline = track.interpolation == Interpolation::cubic_spline;
  const auto key_value = [&](std::size_t key) {
    const auto begin =
        track.values.begin() + static_cast<std::ptrdiff_t>((is_spline ? 3 * key + 1 : key) * width);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(width));
  };
  const auto after = std::upper_bound(track.times.begin(), track.times.end(), time);
  if (after == track.times.begin()) return key_value(0);
  const auto left = static_cast<std::size_t>(after - track.times.begin()) - 1;
  if (after == track.times.end() || track.interpolation == Interpolation::step || time == track.times[left])
    return key_value(left);

  std::vector<double> value = key_value(left);
  const double seconds = track.times[left + 1] - track.times[left];
  const double part = (time - track.times[left]) / seconds;
  if (is_spline) {
    for (std::size_t i = 0; i < width; ++i) value[i] = spline(track, left, i, part, seconds);
    return value;
  }
  const std::vector<double> next = key_value(left + 1);
  if (track.property == Animated::rotation) {
    interpolate_rotation(value, next, part);
  } else {
    for (std::size_t i = 0; i < width; ++i) value[i] += part * (next[i] - value[i]);
  }
  return value;
}

std::vector<Transform> AnimatedModel::to_scene(const std::vector<ModelNode>& posed) const {
  std::vector<Transform> result(posed.size());
  for (const std::uint32_t i : order_) {
    const ModelNode& node = posed[i];
    const Transform own = node.matrix ? *node.matrix : compose(node.translation, node.rotation, node.scale);
    result[i] = node.parent == ModelNode::no_parent ? own : result[node.parent] * own;
  }
  return result;
}

void AnimatedModel::pose(const std::vector<AnimationTrack>* played, double time,
                         std::span<Vec3d> positions) const {
  std::vector<ModelNode> posed = nodes;
  if (played != nullptr) {
    for (const AnimationTrack& track : *played) put(posed[track.node], track, value_at(track, time));
  }
  const std::vector<Transform> scene = to_scene(posed);
  for (const ModelPart& part : parts) {
    const std::vector<double>& own = posed[part.node].weights;
    const std::vector<double>& weights = own.empty() ? part.weights : own;
    std::vector<Transform> joints;
    if (part.skin) {
      const ModelSkin& skin = skins[*part.skin];
      for (std::size_t i = 0; i < skin.joints.size(); ++i)
        joints.push_back(scene[skin.joints[i]] * skin.inverse_bind[i]);
    }
    const Transform map = scene[part.node] * part.local;
    for (std::size_t i = 0; i < part.points.size(); ++i) {
      const Vec3d point = morphed(part, weights, i);
      positions[part.first_vertex + i] = part.skin && !part.influences[i].empty()
                                             ? skinned(joints, part.influences[i], point)
                                             : apply(map, point);
    }
  }
}

}  // namespace supple
