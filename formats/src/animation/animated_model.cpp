#include "animation/animated_model.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "animation/vertex_rows.hpp"
#include "core/error.hpp"

namespace supple {
namespace {

/// Joints in ascending order, each once, without weights of 0; the weights have the sum 1. Empty when no
/// weight is positive and finite.
std::vector<Influence> tidy(std::vector<Influence> influences) {
  std::sort(influences.begin(), influences.end(),
            [](const Influence& a, const Influence& b) { return a.joint < b.joint; });
  std::vector<Influence> result;
  double sum = 0;
  for (const Influence& influence : influences) {
    if (!(influence.weight > 0) || influence.weight > std::numeric_limits<double>::max()) continue;
    if (!result.empty() && result.back().joint == influence.joint)
      result.back().weight += influence.weight;
    else
      result.push_back(influence);
    sum += influence.weight;
  }
  for (Influence& influence : result) influence.weight /= sum;
  return result;
}

/// Writes a vertex as numbers: its point, displacements and influences, filled up to `width` with zeros.
class RowWriter {
 public:
  RowWriter(std::size_t targets, bool has_skin, std::span<const Surface> surfaces)
      : targets_(targets), has_skin_(has_skin) {
    std::size_t most = 0;
    if (has_skin) {
      for (const Surface& surface : surfaces) {
        for (const auto& influences : surface.influences) most = std::max(most, influences.size());
      }
    }
    row_.resize(3 + 3 * targets + 2 * most);
  }

  std::size_t width() const { return row_.size(); }

  std::span<const double> write(const Surface& surface, std::uint32_t vertex) {
    std::fill(row_.begin(), row_.end(), 0);
    put(0, surface.points[vertex]);
    for (std::size_t i = 0; i < std::min(targets_, surface.targets.size()); ++i)
      put(3 + 3 * i, surface.targets[i][vertex]);
    if (has_skin_ && !surface.influences.empty()) {
      std::size_t place = 3 + 3 * targets_;
      for (const Influence& influence : tidy(surface.influences[vertex])) {
        row_[place++] = influence.joint;
        row_[place++] = influence.weight;
      }
    }
    return row_;
  }

  /// Adds a vertex to the part.
  void read(std::span<const double> row, ModelPart& part) const {
    const auto point = [&](std::size_t place) { return Vec3d{row[place], row[place + 1], row[place + 2]}; };
    part.points.push_back(point(0));
    for (std::size_t i = 0; i < targets_; ++i) part.targets[i].push_back(point(3 + 3 * i));
    if (!has_skin_) return;
    std::vector<Influence>& influences = part.influences.emplace_back();
    for (std::size_t place = 3 + 3 * targets_; place < row.size() && row[place + 1] > 0; place += 2)
      influences.push_back({static_cast<std::uint32_t>(row[place]), row[place + 1]});
  }

 private:
  void put(std::size_t place, const Vec3d& point) {
    for (int axis = 0; axis < 3; ++axis) row_[place + static_cast<std::size_t>(axis)] = point[axis];
  }

  std::size_t targets_;
  bool has_skin_;
  std::vector<double> row_;
};

}  // namespace

void add(PolygonCounts& sum, const PolygonCounts& more) {
  sum.quads += more.quads;
  sum.larger += more.larger;
  sum.concave += more.concave;
  sum.crossing += more.crossing;
  sum.bent += more.bent;
}

void AnimatedModel::add_part(ModelPart part, std::span<const Surface> surfaces, const std::string& file) {
  std::size_t targets = 0;
  for (const Surface& surface : surfaces) targets = std::max(targets, surface.targets.size());
  RowWriter writer(targets, part.skin.has_value(), surfaces);
  VertexRows rows(writer.width());

  part.first_vertex = mesh.positions.size();
  part.first_triangle = mesh.triangles.size();
  for (const Surface& surface : surfaces) {
    add(mesh.polygons, surface.polygons);
    for (const Triangle& triangle : surface.triangles) {
      Triangle& added = mesh.triangles.emplace_back();
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint64_t id = part.first_vertex + rows.id_of(writer.write(surface, triangle[corner]));
        if (id > std::numeric_limits<std::uint32_t>::max())
          fail(file + ": more vertices than ids can tell; split the file");
        added[corner] = static_cast<std::uint32_t>(id);
      }
    }
  }
  part.targets.resize(targets);
  for (std::size_t id = 0; id < rows.size(); ++id) writer.read(rows.row(id), part);
  mesh.positions.insert(mesh.positions.end(), part.points.begin(), part.points.end());
  part.vertex_end = mesh.positions.size();
  part.triangle_end = mesh.triangles.size();
  parts.push_back(std::move(part));
}

void AnimatedModel::remove_idle_tracks() {
  std::vector<bool> moves_mesh(nodes.size());
  const auto mark = [&](std::uint32_t node) {
    for (; node != ModelNode::no_parent && !moves_mesh[node]; node = nodes[node].parent)
      moves_mesh[node] = true;
  };
  for (const ModelPart& part : parts) {
    mark(part.node);
    if (part.skin) std::for_each(skins[*part.skin].joints.begin(), skins[*part.skin].joints.end(), mark);
  }
  for (std::size_t i = clips.size(); i-- > 0;) {
    std::erase_if(tracks[i], [&](const AnimationTrack& track) { return !moves_mesh[track.node]; });
    if (!tracks[i].empty()) continue;
    clips.erase(clips.begin() + static_cast<std::ptrdiff_t>(i));
    tracks.erase(tracks.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void AnimatedModel::finish(const std::string& file) {
  std::vector<std::vector<std::uint32_t>> children(nodes.size());
  order_.clear();
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].parent == ModelNode::no_parent)
      order_.push_back(i);
    else
      children[nodes[i].parent].push_back(i);
  }
  for (std::size_t done = 0; done < order_.size(); ++done) {
    const auto& next = children[order_[done]];
    order_.insert(order_.end(), next.begin(), next.end());
  }
  if (order_.size() != nodes.size()) fail(file + ": a node is its own ancestor; the nodes must form trees");

  remove_idle_tracks();
  pose(nullptr, 0, mesh.positions);
  const std::vector<Transform> scene = to_scene(nodes);
  for (const ModelPart& part : parts) {
    Transform map = scene[part.node] * part.local;
    if (part.skin) {
      const auto skinned = std::find_if(part.influences.begin(), part.influences.end(),
                                        [](const auto& influences) { return !influences.empty(); });
      const ModelSkin& skin = skins[*part.skin];
      map = identity_transform;
      if (skinned != part.influences.end()) {
        const std::uint32_t joint = skinned->front().joint;
        map = scene[skin.joints[joint]] * skin.inverse_bind[joint];
      }
    }
    if (!mirrors(map)) continue;
    for (std::size_t i = part.first_triangle; i < part.triangle_end; ++i)
      std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  }
}

}  // namespace supple
