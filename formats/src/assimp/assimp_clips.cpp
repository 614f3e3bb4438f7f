#include "assimp/assimp_clips.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace supple {
namespace {

/// Keys in the order of their times.
using Keys = std::map<double, std::vector<double>>;

void add_track(std::uint32_t node, Animated property, const Keys& keys, std::vector<AnimationTrack>& tracks) {
  if (keys.empty()) return;
  AnimationTrack& track = tracks.emplace_back();
  track.node = node;
  track.property = property;
  for (const auto& [time, value] : keys) {
    track.times.push_back(time);
    track.values.insert(track.values.end(), value.begin(), value.end());
  }
}

std::vector<double> numbers(const aiVector3D& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
std::vector<double> numbers(const aiQuaternion& q) {
  return {static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z),
          static_cast<double>(q.w)};
}

template <class Key>
Keys keys_of(const Key* keys, unsigned count, double ticks_per_second) {
  Keys result;
  for (unsigned i = 0; i < count; ++i) {
    const double time = keys[i].mTime / ticks_per_second;
    if (std::isfinite(time)) result.emplace(time, numbers(keys[i].mValue));
  }
  return result;
}

/// The properties that a channel leaves out are those of the node's matrix.
void decompose(const aiMatrix4x4& matrix, ModelNode& node) {
  aiVector3D scale, translation;
  aiQuaternion rotation;
  matrix.Decompose(scale, rotation, translation);
  const std::vector<double> q = numbers(rotation);
  node.scale = {static_cast<double>(scale.x), static_cast<double>(scale.y), static_cast<double>(scale.z)};
  node.translation = {static_cast<double>(translation.x), static_cast<double>(translation.y),
                      static_cast<double>(translation.z)};
  node.rotation = {q[0], q[1], q[2], q[3]};
}

/// The weights of all targets at each key. A key may have some of them only; the others are interpolated.
Keys weights_of(const aiMeshMorphAnim& channel, double ticks_per_second) {
  std::map<unsigned, AnimationTrack> targets;
  std::map<double, std::map<unsigned, double>> given;
  for (unsigned i = 0; i < channel.mNumKeys; ++i) {
    const aiMeshMorphKey& key = channel.mKeys[i];
    const double time = key.mTime / ticks_per_second;
    if (!std::isfinite(time)) continue;
    for (unsigned k = 0; k < key.mNumValuesAndWeights; ++k) given[time][key.mValues[k]] = key.mWeights[k];
  }
  for (const auto& [time, weights] : given) {
    for (const auto& [target, weight] : weights) {
      targets[target].property = Animated::weights;
      targets[target].times.push_back(time);
      targets[target].values.push_back(weight);
    }
  }
  Keys keys;
  constexpr unsigned most_targets = 65536;
  if (targets.empty() || targets.rbegin()->first >= most_targets) return keys;
  for (const auto& [time, weights] : given) {
    std::vector<double> all(targets.rbegin()->first + 1);
    for (const auto& [target, track] : targets) all[target] = value_at(track, time)[0];
    keys.emplace(time, std::move(all));
  }
  return keys;
}

void read_channels(const aiScene& scene, const aiAnimation& animation, const NodesByName& nodes,
                   double ticks_per_second, AnimatedModel& model, std::vector<AnimationTrack>& tracks) {
  for (unsigned i = 0; i < animation.mNumChannels; ++i) {
    const aiNodeAnim& channel = *animation.mChannels[i];
    const auto node = nodes.find(channel.mNodeName.C_Str());
    // Assimp turns and scales the root.
    if (node == nodes.end() || node->second == 0) continue;
    decompose(scene.mRootNode->FindNode(channel.mNodeName)->mTransformation, model.nodes[node->second]);
    const auto add = [&](Animated property, const auto* keys, unsigned count) {
      add_track(node->second, property, keys_of(keys, count, ticks_per_second), tracks);
    };
    add(Animated::translation, channel.mPositionKeys, channel.mNumPositionKeys);
    add(Animated::rotation, channel.mRotationKeys, channel.mNumRotationKeys);
    add(Animated::scale, channel.mScalingKeys, channel.mNumScalingKeys);
  }
}

void read_morphs(const aiAnimation& animation, const NodesByName& nodes, const NodesByName& nodes_of_meshes,
                 double ticks_per_second, std::vector<AnimationTrack>& tracks) {
  for (unsigned i = 0; i < animation.mNumMorphMeshChannels; ++i) {
    const aiMeshMorphAnim& channel = *animation.mMorphMeshChannels[i];
    std::string name = channel.mName.C_Str();
    auto node = nodes.find(name);
    // FBX adds a star and the number of the geometry.
    if (node == nodes.end() && name.rfind('*') != std::string::npos)
      node = nodes.find(name.substr(0, name.rfind('*')));
    if (node == nodes.end()) {
      node = nodes_of_meshes.find(name);
      if (node == nodes_of_meshes.end()) continue;
    }
    add_track(node->second, Animated::weights, weights_of(channel, ticks_per_second), tracks);
  }
}

}  // namespace

void read_clips(const aiScene& scene, const NodesByName& nodes, const NodesByName& nodes_of_meshes,
                AnimatedModel& model) {
  for (unsigned i = 0; i < scene.mNumAnimations; ++i) {
    const aiAnimation& animation = *scene.mAnimations[i];
    // Assimp leaves 0 where the file does not say.
    const double ticks_per_second = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 25;
    std::vector<AnimationTrack> tracks;
    read_channels(scene, animation, nodes, ticks_per_second, model, tracks);
    read_morphs(animation, nodes, nodes_of_meshes, ticks_per_second, tracks);
    if (tracks.empty()) continue;
    AnimationClip clip{animation.mName.C_Str(), tracks[0].times.front(), tracks[0].times.back()};
    if (clip.name.empty()) clip.name = "clip " + std::to_string(i);
    for (const AnimationTrack& track : tracks) {
      clip.start = std::min(clip.start, track.times.front());
      clip.end = std::max(clip.end, track.times.back());
    }
    model.clips.push_back(std::move(clip));
    model.tracks.push_back(std::move(tracks));
  }
}

}  // namespace supple
