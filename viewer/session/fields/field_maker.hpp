#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "fields/field_forms.hpp"
#include "messages/message.hpp"
#include "sources/extent.hpp"
#include "sources/stage.hpp"

namespace supple::viewer {

/// Computes the values of the chosen field. Velocities need the step before in the history of the stage.
class FieldMaker {
 public:
  /// Chooses a field; null for none.
  void choose(const FieldForm* form);
  /// Call when another run or other objects begin.
  void restart() { starts_.clear(); }

  /// Adds the sections of a frame: values of the objects that have some.
  void pack(Stage& stage, MessageWriter& message);
  /// Writes the member `field` of the answer for a vertex or a triangle, when it has a value of the field.
  void answer(Stage& stage, FieldElement element, std::uint32_t object, std::uint32_t number, JsonText& json);

  /// One or three numbers for each vertex or triangle of an object, NaN where there is none. Empty when the
  /// object has no values.
  std::span<const double> values(Stage& stage, std::size_t object);

 private:
  void begin(Stage& stage);
  void write(std::string_view key, Stage& stage, std::size_t object);
  void write_velocities(Stage& stage, std::size_t object, bool only_speeds);
  void write_displacements(Stage& stage, std::size_t object);
  void write_strains(Stage& stage, std::size_t object);
  void write_distances(Stage& stage, std::size_t object);
  void write_depths(Stage& stage, std::size_t object);
  void write_users(Stage& stage, std::size_t object);
  double read_step_before(Stage& stage, std::size_t object);
  std::span<const Vec3d> start_of_object(Stage& stage, std::size_t object);

  FieldForm form_;
  bool is_on_ = false;
  std::vector<std::vector<Vec3d>> starts_;  // of objects, when they are needed
  std::vector<Extent> extents_;             // of objects in this frame, for distances
  std::vector<Vec3d> earlier_;              // the positions of one object in the step before
  std::vector<double> values_;
};

}  // namespace supple::viewer
