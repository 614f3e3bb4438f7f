#include "supple/animation.hpp"

#include <cmath>

#include "animation/animated_model.hpp"
#include "animation/model_readers.hpp"
#include "core/error.hpp"
#include "files/file_access.hpp"

namespace supple {

struct AnimatedMesh::Content {
  AnimatedModel model;
  std::string file;
};

AnimatedMesh::AnimatedMesh(const std::filesystem::path& path)
    : content_(std::make_shared<const Content>(Content{read_model(path), shown(path)})) {}

const TriangleMesh& AnimatedMesh::mesh() const {
  return content_->model.mesh;
}

const CoordinateFrame& AnimatedMesh::frame() const {
  return content_->model.frame;
}

std::span<const AnimationClip> AnimatedMesh::clips() const {
  return content_->model.clips;
}

void AnimatedMesh::positions(std::size_t clip, double time, std::span<Vec3d> positions) const {
  const AnimatedModel& model = content_->model;
  if (clip >= model.clips.size())
    fail(content_->file + ": there is no clip " + std::to_string(clip) + "; the file has " +
         std::to_string(model.clips.size()) + ", counted from 0");
  if (positions.size() != model.mesh.positions.size())
    fail(content_->file + ": " + std::to_string(positions.size()) + " positions given for " +
         std::to_string(model.mesh.positions.size()) + " vertices");
  if (!std::isfinite(time)) fail(content_->file + ": the time of a pose must be finite");
  if (model.evaluate)
    model.evaluate(clip, time, positions);
  else
    model.pose(&model.tracks[clip], time, positions);
}

}  // namespace supple
