#include "sources/paper_vertices.hpp"

#include <algorithm>

#include "sources/start.hpp"

namespace supple::viewer {

const std::vector<std::vector<std::uint32_t>>& PaperVertices::find(const SceneView& show,
                                                                   const Source& source) {
  if (!scene_) {
    SceneOptions options = show.simulation.scene;
    options.contacts = ContactKinds::none;
    options.comparison.colliding_vertices = true;
    scene_.emplace(options);
    if (show.comparison) scene_->set_pair_filter(filter_of(*show.comparison));
    for (const ViewedObject& object : show.objects)
      ids_.push_back(scene_->add(start_of(show, object), object.options));
    versions_.assign(ids_.size(), 0);
  }
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (versions_[i] == source.version(i)) continue;
    versions_[i] = source.version(i);
    if (!show.objects[i].options.is_static) scene_->set_positions(ids_[i], source.positions(i));
  }
  const DetectResult& result = scene_->detect();
  vertices_.resize(ids_.size());
  for (std::vector<std::uint32_t>& vertices : vertices_) vertices.clear();
  pairs_.clear();
  for (const CollidingVertices& group : result.colliding_vertex_groups) {
    if (group.a != group.b) pairs_.push_back({group.a, group.b});
    const auto first = result.colliding_vertices.begin() + group.first_vertex;
    const auto middle = first + group.count_a;
    vertices_[group.a.index].insert(vertices_[group.a.index].end(), first, middle);
    vertices_[group.b.index].insert(vertices_[group.b.index].end(), middle, middle + group.count_b);
  }
  for (std::vector<std::uint32_t>& vertices : vertices_) {
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }
  return vertices_;
}

void PaperVertices::forget() {
  scene_.reset();
  ids_.clear();
}

}  // namespace supple::viewer
