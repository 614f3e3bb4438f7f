#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/files.hpp"
#include "base/json_writer.hpp"
#include "options/options.hpp"
#include "supple/result.hpp"
#include "supple/verify.hpp"

namespace supple::cli {

struct Input;
class MovingObjects;

/// The data of a frame for all reports.
struct Frame {
  std::uint64_t number = 0;
  const DetectResult& result;
  std::optional<VerifyReport> verify{};
  /// Only for simulated frames.
  struct Simulated {
    double time = 0;            ///< s, since the start
    double motion_seconds = 0;  ///< wall-clock time of the motion
  };
  std::optional<Simulated> simulated{};
  /// Objects whose straight paths in a step are not their motion; see half_turns.hpp.
  std::vector<ObjectId> turned{};
};

/// The names of the columns for contacts of one kind, with or without those of `--contact-details`.
std::vector<std::string> csv_columns(ContactKinds kinds, bool details);

/// Writes one row per contact, as docs/json.md describes: the frame, and the members of the record; vectors
/// and weights only with `details`. With colliding vertices, one row per contact of triangles, per vertex and
/// per event of the narrow phase.
class CsvReport {
 public:
  CsvReport(const std::string& file_name, const SceneOptions& options, bool details);

  void add(const Frame& frame);
  /// Adds a row `truncated` with empty cells when the results are not complete.
  void finish(bool is_truncated);

 private:
  void add_narrow_phase(const Frame& frame, fmt::memory_buffer& rows);

  OutputFile file_;
  std::size_t columns_ = 0;
  ContactKinds kinds_;
  bool has_kinds_;  ///< a column says what each row is
  bool has_details_;
};

/// Writes the result of `supple detect` as docs/json.md describes, frame by frame.
class JsonReport {
 public:
  JsonReport(const std::string& file_name, const Input& input, const MovingObjects& objects,
             const JsonContent& content);

  void add(const Frame& frame);
  /// `was_ended` says that frames are missing.
  void finish(bool was_ended);

 private:
  JsonWriter json_;
  void add_files(std::uint64_t frame);

  const Input& input_;
  const MovingObjects& objects_;
  JsonContent content_;
  bool is_truncated_ = false;
};

/// Throws an error that names --node-pairs when an object does not exist, or is not tested against itself.
void check_node_pairs(const Input& input, ObjectNumbers objects);

/// Prints the pairs of nodes that collide in the scene's last detection, level by level.
void print_node_pairs(const Scene& scene, ObjectNumbers objects, std::uint64_t frame);
/// Writes all these pairs as the member `node_pairs`.
void write_node_pairs(JsonWriter& json, const Scene& scene, ObjectNumbers objects);

}  // namespace supple::cli
