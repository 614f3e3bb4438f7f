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

/// Computes the values of the chosen field. Without a field, nothing is computed, and from the next step on
/// nothing is kept.
class FieldMaker {
 public:
  /// Chooses a field; null for none.
  void choose(const FieldForm* form, Stage& stage);
  /// Call after each step: velocities need the positions of the step before.
  void see(Stage& stage);
  /// Call when another run or other objects begin.
  void restart(Stage& stage);

  /// Adds the sections of a frame: values of the objects that have some.
  void pack(Stage& stage, MessageWriter& message);
  /// Writes the member `field` of the answer for a vertex or a triangle, when it has a value of the field.
  void answer(Stage& stage, FieldElement element, std::uint32_t object, std::uint32_t number, JsonText& json);

  /// One or three numbers for each vertex or triangle of an object, NaN where there is none. Empty when the
  /// object has no values.
  std::span<const double> values(Stage& stage, std::size_t object);

 private:
  struct Step {
    std::vector<std::vector<Vec3d>> positions{};
    std::uint64_t number = 0;
    double time = 0;
    bool is_known = false;
  };

  void begin(Stage& stage);
  bool needs_steps() const;
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
  Step now_, before_;
  std::vector<std::vector<Vec3d>> starts_;  // of objects, when they are needed
  std::vector<Extent> extents_;             // of objects in this frame, for distances
  std::vector<Vec3d> earlier_;              // the positions of one object in the step before
  std::vector<double> values_;
};

}  // namespace supple::viewer
