#include "fields/field_maker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "program/program.hpp"
#include "sources/start.hpp"
#include "supple/queries.hpp"

namespace supple::viewer {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The squares and products of two edges of a triangle.
struct Metric {
  double uu, uv, vv;
  double determinant() const { return uu * vv - uv * uv; }
};

Metric metric_of(std::span<const Vec3d> positions, const Triangle& corners) {
  const Vec3d u = positions[corners[1]] - positions[corners[0]],
              v = positions[corners[2]] - positions[corners[0]];
  return {dot(u, u), dot(u, v), dot(v, v)};
}

/// The largest stretch of a direction in a triangle, minus 1; NaN when the triangle has no area at rest. The
/// squares of the principal stretches are the eigenvalues of rest⁻¹ · now.
double strain_of(const Metric& rest, const Metric& now) {
  const double area = rest.determinant();
  if (!(area > 0)) return none;
  const double half_trace = 0.5 * (rest.vv * now.uu - 2 * rest.uv * now.uv + rest.uu * now.vv) / area;
  const double product = now.determinant() / area;
  const double largest = half_trace + std::sqrt(std::max(half_trace * half_trace - product, 0.0));
  return std::sqrt(std::max(largest, 0.0)) - 1;
}

/// At most the distance of two boxes, one of which may be a point; the factor is for rounding.
double least_distance(const Vec3d& low, const Vec3d& high, const Extent& box) {
  Vec3d apart;
  for (int axis = 0; axis < 3; ++axis)
    apart[axis] = std::max({box.low[axis] - high[axis], low[axis] - box.high[axis], 0.0});
  return norm(apart) * (1 - 1e-12);
}

float narrow(double value) {
  return Center::narrow(value);
}

}  // namespace

void FieldMaker::choose(const FieldForm* form) {
  is_on_ = form != nullptr;
  form_ = is_on_ ? *form : FieldForm{};
  starts_.clear();
}

void FieldMaker::pack(Stage& stage, MessageWriter& message) {
  if (!is_on_ || !form_.list.empty()) return;
  begin(stage);
  for (std::size_t i = 0; i < stage.show().objects.size(); ++i) {
    const std::span<const double> numbers = values(stage, i);
    if (numbers.empty()) continue;
    const auto object = static_cast<std::uint32_t>(i);
    if (!form_.is_vector) {
      const auto sent = message.add<float>(Tag::field_values, object, numbers.size());
      std::transform(numbers.begin(), numbers.end(), sent.begin(), narrow);
      continue;
    }
    const auto sent = message.add<std::array<float, 3>>(Tag::field_vectors, object, numbers.size() / 3);
    for (std::size_t k = 0; k < sent.size(); ++k)
      sent[k] = {narrow(numbers[3 * k]), narrow(numbers[3 * k + 1]), narrow(numbers[3 * k + 2])};
  }
}

void FieldMaker::answer(Stage& stage, FieldElement element, std::uint32_t object, std::uint32_t number,
                        JsonText& json) {
  if (!is_on_ || !form_.list.empty() || form_.element != element) return;
  begin(stage);
  const std::span<const double> numbers = values(stage, object);
  if (numbers.empty()) return;
  json.key("field");
  json.begin_object();
  json.key(form_.label.c_str());
  if (form_.is_vector)
    json.value(Vec3d{numbers[3 * number], numbers[3 * number + 1], numbers[3 * number + 2]});
  else
    json.value(numbers[number]);
  json.end_object();
}

/// Prepares what all objects share.
void FieldMaker::begin(Stage& stage) {
  extents_.clear();
  if (form_.key != "distance") return;
  for (std::size_t i = 0; i < stage.show().objects.size(); ++i)
    extents_.emplace_back().add(stage.source().positions(i));
}

std::span<const double> FieldMaker::values(Stage& stage, std::size_t object) {
  values_.clear();
  const ViewedObject& shown = stage.show().objects[object];
  const bool is_removed = stage.program() != nullptr && !shown.id;
  if (is_on_ && !is_removed && !shown.mesh.positions.empty()) write(form_.key, stage, object);
  return values_;
}

void FieldMaker::write(std::string_view key, Stage& stage, std::size_t object) {
  if (key == "speed" || key == "velocity") return write_velocities(stage, object, key == "speed");
  if (key == "displacement") return write_displacements(stage, object);
  if (key == "strain") return write_strains(stage, object);
  if (key == "distance") return write_distances(stage, object);
  if (key == "depth") return write_depths(stage, object);
  write_users(stage, object);
}

/// Reads the positions of the step before into `earlier_`: of the frame before, or of the last kept step of a
/// program. Returns the time since then; 0 when they are not known.
double FieldMaker::read_step_before(Stage& stage, std::size_t object) {
  const std::span<const Vec3d> now = stage.source().positions(object);
  earlier_.assign(now.begin(), now.end());
  const RecordingSource* const recording = stage.recording() != nullptr ? stage.recording() : stage.past();
  if (recording != nullptr) {
    const std::uint64_t frame = recording->frame();
    if (frame == 0 || recording->frame_count() == 0) return 0;
    if (!stage.show().objects[object].options.is_static)
      stage.show().frames->read(frame - 1, object, earlier_);
    return recording->time_of(frame) - recording->time_of(frame - 1);
  }
  const History& history = stage.history();
  const std::uint64_t count = history.count();
  if (count < 2 || history.step(count - 1) != stage.source().step()) return 0;
  history.read(count - 2, object, earlier_);
  return stage.source().time() - history.time(count - 2);
}

void FieldMaker::write_velocities(Stage& stage, std::size_t object, bool only_speeds) {
  const double seconds = read_step_before(stage, object);
  if (!(seconds > 0)) return;
  const std::span<const Vec3d> now = stage.source().positions(object);
  for (std::size_t v = 0; v < now.size(); ++v) {
    const Vec3d velocity = (now[v] - earlier_[v]) * (1 / seconds);
    if (only_speeds)
      values_.push_back(norm(velocity));
    else
      values_.insert(values_.end(), {velocity.x, velocity.y, velocity.z});
  }
}

std::span<const Vec3d> FieldMaker::start_of_object(Stage& stage, std::size_t object) {
  const SceneView& show = stage.show();
  const ViewedObject& shown = show.objects[object];
  const RecordingSource* const recording = stage.recording();
  const bool is_recorded = recording != nullptr && recording->frame_count() > 0 && !shown.options.is_static;
  if (!is_recorded && !std::holds_alternative<WaveMotion>(shown.motion)) return shown.mesh.positions;
  starts_.resize(show.objects.size());
  std::vector<Vec3d>& start = starts_[object];
  if (!start.empty()) return start;
  start = start_of(show, shown).positions;
  if (is_recorded) show.frames->read(0, object, start);
  return start;
}

void FieldMaker::write_displacements(Stage& stage, std::size_t object) {
  const std::span<const Vec3d> start = start_of_object(stage, object), now = stage.source().positions(object);
  for (std::size_t v = 0; v < now.size(); ++v) {
    const Vec3d way = now[v] - start[v];
    values_.insert(values_.end(), {way.x, way.y, way.z});
  }
}

void FieldMaker::write_strains(Stage& stage, std::size_t object) {
  const TriangleMesh& rest = stage.show().objects[object].mesh;
  const std::span<const Vec3d> now = stage.source().positions(object);
  for (const Triangle& corners : rest.triangles)
    values_.push_back(strain_of(metric_of(rest.positions, corners), metric_of(now, corners)));
}

/// Asks the other objects in the order of their distance, each only for vertices that may be nearer to it
/// than to those before.
void FieldMaker::write_distances(Stage& stage, std::size_t object) {
  const Source& source = stage.source();
  const Extent& own = extents_[object];
  const std::span<const Vec3d> vertices = source.positions(object);
  std::vector<std::pair<double, std::size_t>> others;
  for (std::size_t i = 0; i < extents_.size(); ++i) {
    if (i != object && !extents_[i].empty() && !stage.show().objects[i].mesh.triangles.empty())
      others.emplace_back(least_distance(own.low, own.high, extents_[i]), i);
  }
  if (own.empty() || others.empty()) return;
  std::sort(others.begin(), others.end());
  values_.assign(vertices.size(), std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> asked;
  std::vector<Vec3d> points;
  std::vector<std::optional<ClosestPoint>> found;
  double farthest = std::numeric_limits<double>::infinity();  // of the vertices, so far
  for (const auto& [least, other] : others) {
    if (least > farthest) break;
    asked.clear();
    points.clear();
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
      if (!is_finite(vertices[v]) || least_distance(vertices[v], vertices[v], extents_[other]) > values_[v])
        continue;
      asked.push_back(v);
      points.push_back(vertices[v]);
    }
    found.assign(points.size(), std::nullopt);
    source.scene().closest(points, found, {.filter = {.object = source.id(other)}, .max_distance = farthest});
    for (std::size_t i = 0; i < asked.size(); ++i) {
      if (found[i]) values_[asked[i]] = std::min(values_[asked[i]], found[i]->distance);
    }
    farthest = 0;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      if (is_finite(vertices[v])) farthest = std::max(farthest, values_[v]);
    }
  }
  for (double& value : values_) {
    if (std::isinf(value)) value = none;
  }
}

void FieldMaker::write_depths(Stage& stage, std::size_t object) {
  const Source& source = stage.source();
  for (const Penetration& found : source.scene().result().penetrations) {
    if (found.object_a.index != object) continue;
    if (values_.empty()) values_.assign(source.positions(object).size(), none);
    double& value = values_[found.vertex];
    value = std::isnan(value) ? found.depth : std::max(value, found.depth);
  }
}

void FieldMaker::write_users(Stage& stage, std::size_t object) {
  // The program has its numbers for the present only.
  if (stage.program() == nullptr || stage.past() != nullptr) return;
  const auto numbers = stage.program()->program().field_values(form_.label, stage.source().id(object));
  if (numbers == nullptr) return;
  const TriangleMesh& mesh = stage.show().objects[object].mesh;
  const std::size_t count =
      form_.element == FieldElement::vertex ? mesh.positions.size() : mesh.triangles.size();
  if (numbers->size() == (form_.is_vector ? 3 : 1) * count) values_ = *numbers;
}

}  // namespace supple::viewer
