#include "messages/frame_message.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <tuple>
#include <utility>

#include "supple/inspection.hpp"

namespace supple::viewer {
namespace {

using Ids = std::array<std::uint32_t, 8>;

constexpr std::size_t most_elements = 1'000'000;
/// Rows of statistics that are kept, for pages that take no frames for a while and for pages that come again.
constexpr std::size_t most_rows = 4'000;
constexpr std::size_t row_width = 1 + statistic_count;

}  // namespace

void FramePacker::restart() {
  forget();
  for (PairHistory* const pairs : {&touching_, &colliding_, &overlapping_}) pairs->restart();
  rows_.clear();
}

void FramePacker::forget() {
  forget_positions();
  for (PairHistory* const pairs : {&touching_, &colliding_, &overlapping_}) pairs->forget_sent();
  sent_rows_ = 0;
}

void FramePacker::forget_positions() {
  versions_.clear();
  paper_vertices_.forget();
}

void FramePacker::add_step(std::uint64_t step, double motion_seconds, const DetectResult& result) {
  add_row(step, motion_seconds, result.stats);
  now_.clear();
  for (const ObjectPair& pair : result.object_pairs) now_.emplace_back(pair.a.index, pair.b.index);
  overlapping_.set(step, now_);
  now_.clear();
  for (const auto groups : {result.groups, result.continuous_groups}) {
    for (const ContactGroup& group : groups) {
      if (group.a != group.b) now_.emplace_back(group.a.index, group.b.index);
    }
  }
  std::sort(now_.begin(), now_.end());
  now_.erase(std::unique(now_.begin(), now_.end()), now_.end());
  touching_.set(step, now_);
}

void FramePacker::add_step(const StepRow& row) {
  add_row(row.step, 0, row.stats);
  overlapping_.change(row.step, row.volumes.begin, row.volumes.end);
  touching_.change(row.step, row.contacts.begin, row.contacts.end);
}

void FramePacker::add_row(std::uint64_t step, double motion_seconds, const StepStats& stats) {
  rows_.reserve(most_rows * row_width);
  if (!rows_.empty() && step == last_row_)
    rows_.resize(rows_.size() - row_width);  // detected again after the step
  else if (step != last_row_ + 1)
    rows_.clear();
  last_row_ = step;
  if (rows_.size() == most_rows * row_width) drop_old_rows();
  sent_rows_ = std::min(sent_rows_, rows_.size() / row_width);
  rows_.push_back(motion_seconds);
  for_each_statistic(stats, [&](const char*, double value) { rows_.push_back(value); });
}

/// Drops many rows at once, so that the cost per step is small.
void FramePacker::drop_old_rows() {
  constexpr std::size_t surplus = most_rows / 4;
  rows_.erase(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(surplus * row_width));
  sent_rows_ -= std::min(sent_rows_, surplus);
  const std::uint64_t first = last_row_ - (most_rows - surplus);
  for (PairHistory* const pairs : {&touching_, &colliding_, &overlapping_}) pairs->drop_before(first);
}

void FramePacker::pack(const FrameView& frame, MessageWriter& message) {
  message_ = &message;
  omissions_.clear();
  octree_levels_.clear();
  message.begin(MessageKind::frame);
  add_positions(frame);
  add_contacts(frame);
  add_impacts(frame);
  add_proximity_pairs(frame);
  add_penetrations(frame);
  add_curves(frame);
  add_steps(frame);
  if (frame.layers.candidates) add_candidates(frame);
  for (const std::uint32_t object : frame.layers.octree_objects) {
    if (frame.source.scene().contains(frame.source.id(object))) add_octree(frame, object);
  }
  if (frame.layers.colliding_nodes) add_colliding_nodes(frame, *frame.layers.colliding_nodes);
  if (frame.layers.scene_regions) add_scene_regions(frame);
  if (frame.layers.colliding_vertices)
    add_colliding_vertices(frame);
  else
    paper_vertices_.forget();
  add_text(frame);
}

void FramePacker::add_positions(const FrameView& frame) {
  versions_.resize(frame.show.objects.size(), 0);
  for (std::size_t i = 0; i < versions_.size(); ++i) {
    const std::uint64_t version = frame.source.version(i);
    if (versions_[i] == version) continue;
    versions_[i] = version;
    const std::span<const Vec3d> positions = frame.source.positions(i);
    const auto sent =
        message_->add<std::array<float, 3>>(Tag::positions, static_cast<std::uint32_t>(i), positions.size());
    std::transform(positions.begin(), positions.end(), sent.begin(), frame.center);
  }
}

void FramePacker::add_contacts(const FrameView& frame) {
  const DetectResult& result = frame.source.scene().result();
  const std::size_t pair_count = limited("object_pairs", result.object_pairs.size());
  const auto pairs = message_->add<std::array<std::uint32_t, 2>>(Tag::object_pairs, pair_count);
  for (std::size_t i = 0; i < pair_count; ++i)
    pairs[i] = {result.object_pairs[i].a.index, result.object_pairs[i].b.index};

  const std::size_t count = limited("contacts", result.contacts.size());
  const bool has_points = !result.contact_points.empty();
  const auto rows = message_->add<Ids>(Tag::contacts, count);
  for (std::size_t i = 0; i < count; ++i) {
    const Contact& c = result.contacts[i];
    rows[i] = {c.object_a.index,
               c.triangle_a,
               c.object_b.index,
               c.triangle_b,
               static_cast<std::uint32_t>(c.kind),
               has_points ? c.point_count : 0u,
               has_points ? c.first_point : 0u,
               0};
  }
  if (has_points) add_contact_points(frame, count);
}

/// Adds the points of the contacts that are sent, in the order of the contacts.
void FramePacker::add_contact_points(const FrameView& frame, std::size_t contact_count) {
  const DetectResult& result = frame.source.scene().result();
  const Contact* const last = contact_count == 0 ? nullptr : &result.contacts[contact_count - 1];
  const std::size_t count = last == nullptr ? 0 : last->first_point + last->point_count;
  const auto rows = message_->add<Row>(Tag::contact_points, count);
  for (const Contact& contact : result.contacts.first(contact_count)) {
    const std::array<float, 3> normal = floats(contact.normal);
    for (std::size_t i = 0; i < contact.point_count; ++i) {
      const std::size_t point = contact.first_point + i;
      rows[point] = row_of(frame.center(result.contact_points[point].position), 0, normal, 0);
    }
  }
}

void FramePacker::add_impacts(const FrameView& frame) {
  const auto contacts = frame.source.scene().result().continuous_contacts;
  if (!contains(frame.source.contacts(), ContactKinds::continuous)) return;
  const std::size_t count = limited("impacts", contacts.size());
  const auto rows = message_->add<Ids>(Tag::impacts, count);
  for (std::size_t i = 0; i < count; ++i) {
    const ContinuousContact& c = contacts[i];
    rows[i] = {c.object_a.index,
               c.element_a[0],
               c.element_a[1],
               c.object_b.index,
               c.element_b[0],
               c.element_b[1],
               static_cast<std::uint32_t>(c.kind),
               static_cast<std::uint32_t>(c.certainty)};
  }
  const auto points = message_->add<Row>(Tag::impact_points, count);
  for (std::size_t i = 0; i < count; ++i) {
    const ContinuousContact& c = contacts[i];
    points[i] = row_of(frame.center(c.point), static_cast<float>(c.toi), floats(c.normal), 0);
  }
}

/// Adds the proximity pairs, each with its closest points.
void FramePacker::add_proximity_pairs(const FrameView& frame) {
  if (!contains(frame.source.contacts(), ContactKinds::proximity)) return;
  const auto pairs = frame.source.scene().result().proximity_pairs;
  const std::size_t count = limited("proximity_pairs", pairs.size());
  const auto objects = message_->add<std::array<std::uint32_t, 2>>(Tag::proximity_pairs, count);
  for (std::size_t i = 0; i < count; ++i) objects[i] = {pairs[i].object_a.index, pairs[i].object_b.index};
  const auto rows = message_->add<Row>(Tag::proximity_points, count);
  const auto margin = [&](ObjectId object) { return frame.show.objects[object.index].options.margin; };
  for (std::size_t i = 0; i < count; ++i) {
    const ProximityPair& pair = pairs[i];
    const double reach = margin(pair.object_a) + margin(pair.object_b);
    const double share = reach > 0 ? pair.distance / reach : 0;
    rows[i] = row_of(frame.center(pair.point_a), static_cast<float>(pair.distance),
                     frame.center(pair.point_b), static_cast<float>(share));
  }
}

/// Adds the vertices inside solid objects, each with the closest point of the surface.
void FramePacker::add_penetrations(const FrameView& frame) {
  const Scene& scene = frame.source.scene();
  if (!contains(frame.source.contacts(), ContactKinds::penetration)) return;
  const auto penetrations = scene.result().penetrations;
  const std::size_t count = limited("penetrations", penetrations.size());
  const auto ids = message_->add<std::array<std::uint32_t, 4>>(Tag::penetrations, count);
  for (std::size_t i = 0; i < count; ++i) {
    const Penetration& p = penetrations[i];
    ids[i] = {p.object_a.index, p.vertex, p.object_b.index, p.triangle};
  }
  const auto rows = message_->add<Row>(Tag::penetration_points, count);
  for (std::size_t i = 0; i < count; ++i) {
    const Penetration& p = penetrations[i];
    rows[i] = row_of(frame.center(scene.position(p.object_a, p.vertex)), static_cast<float>(p.depth),
                     frame.center(p.point), 0);
  }
}

/// Adds as many curves as there is room for with the vertices that they enclose.
void FramePacker::add_curves(const FrameView& frame) {
  const Scene& scene = frame.source.scene();
  if (!contains(frame.source.contacts(), ContactKinds::penetration)) return;
  const std::span<const IntersectionCurve> all = scene.result().curves;
  const auto vertex_end = [](const IntersectionCurve& curve) {
    return std::size_t{curve.first_enclosed} + curve.enclosed_count_a + curve.enclosed_count_b;
  };
  std::size_t count = 0;
  while (count < std::min(all.size(), most_elements) && vertex_end(all[count]) <= most_elements) ++count;
  if (count < all.size()) omissions_.push_back({"curves", all.size()});
  const std::span<const IntersectionCurve> curves = all.first(count);
  const auto ids = message_->add<Ids>(Tag::curves, count);
  for (std::size_t i = 0; i < count; ++i) {
    const IntersectionCurve& c = curves[i];
    ids[i] = {c.a.index,
              c.b.index,
              static_cast<std::uint32_t>(c.kind),
              c.contact_count,
              c.first_enclosed,
              c.enclosed_count_a,
              c.enclosed_count_b,
              0};
  }
  const auto rows = message_->add<Row>(Tag::curve_points, count);
  for (std::size_t i = 0; i < count; ++i) {
    const IntersectionCurve& c = curves[i];
    rows[i] = row_of(frame.center(c.centroid), static_cast<float>(c.depth), floats(c.normal),
                     static_cast<float>(norm(c.area)));
  }
  const std::size_t vertex_count = curves.empty() ? 0 : vertex_end(curves.back());
  const auto vertices = message_->add<std::uint32_t>(Tag::enclosed_vertices, vertex_count);
  std::copy_n(scene.result().enclosed_vertices.begin(), vertex_count, vertices.begin());
}

/// Adds the statistics and the events that the page does not have. The last row is that of this frame. Frames
/// of the past have only this row, and those of a recording no events, because the page has the others.
void FramePacker::add_steps(const FrameView& frame) {
  const Source& source = frame.source;
  const DetectResult& result = source.scene().result();
  if (frame.is_past || frame.is_recorded) {
    const auto row = message_->add<double>(Tag::statistics, row_width);
    std::size_t column = 0;
    row[column++] = source.motion_seconds();
    for_each_statistic(result.stats, [&](const char*, double value) { row[column++] = value; });
    return;
  }
  add_step(source.step(), source.motion_seconds(), result);
  const auto unsent = std::span(rows_).subspan(sent_rows_ * row_width);
  std::copy(unsent.begin(), unsent.end(), message_->add<double>(Tag::statistics, unsent.size()).begin());
  sent_rows_ = rows_.size() / row_width;
  touching_.send(*message_);
  overlapping_.send(*message_);
}

void FramePacker::add_candidates(const FrameView& frame) {
  const auto [candidates, total] = SceneInspector(frame.source.scene()).candidates(most_elements);
  limited("candidates", total);
  const auto rows = message_->add<std::array<std::uint32_t, 4>>(Tag::candidates, candidates.size());
  std::transform(candidates.begin(), candidates.end(), rows.begin(), [](const CandidatePair& pair) {
    return std::array{pair.object_a.index, pair.triangle_a, pair.object_b.index, pair.triangle_b};
  });
}

/// Also adds the events of the narrow phase, because the same detection finds them.
void FramePacker::add_colliding_vertices(const FrameView& frame) {
  const auto& vertices = paper_vertices_.find(frame.show, frame.source);
  now_.clear();
  for (const ObjectPair& pair : paper_vertices_.pairs()) now_.emplace_back(pair.a.index, pair.b.index);
  if (!frame.is_past && !frame.is_recorded) {
    colliding_.set(frame.source.step(), now_);
    colliding_.send(*message_);
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const std::size_t count = limited("colliding_vertices", vertices[i].size());
    const auto sent =
        message_->add<std::uint32_t>(Tag::colliding_vertices, static_cast<std::uint32_t>(i), count);
    std::copy_n(vertices[i].begin(), count, sent.begin());
  }
}

void FramePacker::add_text(const FrameView& frame) {
  json_.clear();
  json_.begin_object();
  json_.member("generation", frame.generation);
  json_.member("step", frame.source.step());
  json_.member("time", frame.source.time());
  json_.member("broad_phase_method", word_of(frame.source.scene().result().stats.broad_phase_method));
  json_.member("playing", frame.playing);
  json_.member("speed", frame.speed);
  json_.member("loop", frame.loop);
  add_numbers("section", frame.section);
  add_numbers("range", frame.range);
  add_numbers("pin_frames", frame.pin_frames);
  json_.member("past", frame.is_past);
  json_.key("field");
  frame.layers.field.empty() ? json_.null() : json_.value(frame.layers.field);
  frame.source.add_to(json_, frame.center);
  json_.key("octree_levels");
  json_.begin_array();
  for (const std::uint32_t level : octree_levels_) json_.value(level);
  json_.end_array();
  json_.key("omitted");
  json_.begin_object();
  for (const Omission& omission : omissions_) json_.member(omission.layer, omission.count);
  json_.end_object();
  json_.key("untested");
  json_.begin_array();
  for (const UntestedKind& untested : frame.source.scene().result().untested) {
    json_.begin_object();
    json_.member("kind", word_of(untested.kind));
    json_.member("reason", word_of(untested.reason));
    json_.end_object();
  }
  if (!frame.has_path && frame.source.step() > 0 &&
      contains(frame.source.contacts(), ContactKinds::continuous)) {
    json_.begin_object();
    json_.member("kind", "continuous");
    json_.member("reason", "no_step_before");
    json_.end_object();
  }
  json_.end_array();
  json_.end_object();
  message_->add_text(json_.text());
}

/// Adds a member with two numbers, or null.
void FramePacker::add_numbers(const char* name, const std::optional<std::array<std::uint64_t, 2>>& numbers) {
  json_.key(name);
  if (!numbers) return json_.null();
  json_.begin_array();
  for (const std::uint64_t number : *numbers) json_.value(number);
  json_.end_array();
}

/// The number of elements to send. Counts the omitted ones, summed over objects.
std::size_t FramePacker::limited(const char* layer, std::uint64_t count) {
  if (count <= most_elements) return static_cast<std::size_t>(count);
  omissions_.push_back({layer, count});
  return most_elements;
}

}  // namespace supple::viewer
