#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "history/pair_history.hpp"
#include "layers.hpp"
#include "messages/json_text.hpp"
#include "messages/message.hpp"
#include "program/program.hpp"
#include "scene_view.hpp"
#include "sources/center.hpp"
#include "sources/paper_vertices.hpp"
#include "sources/source.hpp"
#include "supple/inspection.hpp"
#include "supple/record_info.hpp"
#include "supple/result_descriptions.hpp"

namespace supple::viewer {

// Each frame contains `motion_seconds` and then the members of `StepStats` in their order.
inline constexpr std::size_t statistic_count = count_leaves<StepStats>();

/// Calls `function(name, value)` for each member. The value of an enumeration is its number.
template <class Function>
void for_each_statistic(const StepStats& stats, Function function) {
  for_each_leaf(
      [&](const auto& field, const auto& value) { function(field.key, static_cast<double>(value)); }, stats);
}

/// Eight numbers of a section.
using Row = std::array<float, 8>;

inline Row row_of(const std::array<float, 3>& first, float w, const std::array<float, 3>& second,
                  float last) {
  return {first[0], first[1], first[2], w, second[0], second[1], second[2], last};
}

/// The input of one frame message.
struct FrameView {
  const SceneView& show;
  const Source& source;
  const Layers& layers;
  Center center{};
  std::uint64_t generation = 0;
  bool playing = false;
  double speed = 1;
  bool loop = false;
  std::optional<std::array<std::uint64_t, 2>> section{};  ///< that loops: its first and its last step
  std::array<std::uint64_t, 2> range{};                   ///< the first and the last step that can be shown
  bool is_past = false;                                   ///< a kept step, which is not the last one
  bool has_path = true;                                   ///< false: not the motion since the step before
  /// While pins are measured in other frames: how many are measured, and how many there are.
  std::optional<std::array<std::uint64_t, 2>> pin_frames{};
  bool is_recorded = false;  ///< a frame of a recording, whose events are in the time series
};

/// Writes frame messages and tracks what the page already has.
class FramePacker {
 public:
  /// Call when a new run starts: there are no steps.
  void restart();
  /// Call when the page has nothing yet.
  void forget();
  /// Call when the page keeps only events and statistics.
  void forget_positions();
  /// Call after each step of a simulation, and again when the step was detected again: the next frame
  /// contains the statistics and the events of all steps.
  void add_step(std::uint64_t step, double motion_seconds, const DetectResult& result);
  /// Call for each step of a program.
  void add_step(const StepRow& row);
  void pack(const FrameView& frame, MessageWriter& message);

 private:
  /// A layer that is too large to send, and its full number of elements.
  struct Omission {
    const char* layer;
    std::uint64_t count;
  };

  void add_positions(const FrameView& frame);
  void add_lists(const FrameView& frame);
  void add_row(std::uint64_t step, double motion_seconds, const StepStats& stats);
  void drop_old_rows();
  void add_steps(const FrameView& frame);
  void add_candidates(const FrameView& frame);
  void add_octree(const FrameView& frame, std::uint32_t object);
  void add_colliding_nodes(const FrameView& frame, const CollidingNodes& wanted);
  /// The tags of a layer of cells, by the shape of the cells.
  struct CellTags {
    Tag boxes, spheres, edges;
  };
  void add_cells(const FrameView& frame, const char* layer, CellTags tags, std::uint32_t object,
                 std::vector<OctreeCell> cells);
  void add_edges(const FrameView& frame, const char* layer, Tag tag, std::uint32_t object,
                 std::span<const OctreeCell> cells);
  void add_scene_regions(const FrameView& frame);
  void add_colliding_vertices(const FrameView& frame);
  void add_text(const FrameView& frame);
  void add_numbers(const char* name, const std::optional<std::array<std::uint64_t, 2>>& numbers);
  std::size_t limited(const char* layer, std::uint64_t count);

  MessageWriter* message_ = nullptr;
  std::vector<std::uint64_t> versions_;  // one per object, of the positions last sent; 0 for none
  /// Pairs of objects in the last step: that touch, and whose volumes overlap. Their events are those of the
  /// steps. Pairs of the narrow phase are only in frames.
  PairHistory touching_{Tag::contact_begin, Tag::contact_end},
      overlapping_{Tag::volume_begin, Tag::volume_end},
      colliding_{Tag::narrow_phase_begin, Tag::narrow_phase_end};
  ObjectPairs now_;
  /// Statistics of the last steps, a row for each; the step of the last row; and how many the page has.
  std::vector<double> rows_;
  std::uint64_t last_row_ = 0;
  std::size_t sent_rows_ = 0;
  std::vector<ListRows> list_rows_;  // of the frame that is packed
  std::vector<Omission> omissions_;
  std::vector<std::uint32_t> octree_levels_;
  std::vector<std::array<float, 8>> edges_;  // of the cells of one object
  PaperVertices paper_vertices_;
  JsonText json_;
};

}  // namespace supple::viewer
