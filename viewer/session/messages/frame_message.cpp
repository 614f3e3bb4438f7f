#include "messages/frame_message.hpp"

#include <algorithm>
#include <array>

#include "supple/inspection.hpp"

namespace supple::viewer {
namespace {

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
  add_lists(frame);
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
