#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
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

/// Which kinds of contacts a run has tested: a kind counts as tested when one frame had something to test.
class TestedKinds {
 public:
  TestedKinds(const Input& input, ContactKinds requested);

  void add(const Frame& frame);
  bool was_tested(ContactKinds kind) const { return contains(tested_, kind); }
  /// What was not tested, why, and how to test it: lines without a full stop.
  std::vector<std::string> faults() const;

 private:
  std::string reason_in_words(ContactKinds kind, NothingToTest reason) const;
  bool leaves_out_lines(ContactKinds kind) const;
  std::string advice_for_one_object(ContactKinds kind) const;

  const Input& input_;
  // Facts of the meshes. The input may lose the meshes during a run.
  bool are_frames_ = false;        ///< several meshes with the same triangles
  bool has_lines_ = false;         ///< edges or points of no triangle
  bool has_one_triangle_ = false;  ///< all objects together have one triangle that can touch something
  ContactKinds requested_, tested_ = ContactKinds::none;
  std::uint64_t frames_ = 0;
  std::map<ContactKinds, NothingToTest> reasons_;  // the last ones
  std::uint64_t steps_with_turns_ = 0;
  std::optional<std::uint64_t> first_turn_;  // frame
  std::optional<ObjectId> turned_;           // in this frame
};

/// What contacts of objects with themselves do not show: that they follow from split seams, and how many
/// pairs of triangles are left out because they share a vertex.
class SelfContacts {
 public:
  SelfContacts(const Input& input, const MovingObjects& objects) : input_(input), objects_(objects) {}

  void add(const DetectResult& result);
  /// Lines without a full stop.
  std::vector<std::string> notes() const;

 private:
  struct Counts {
    std::uint64_t all = 0, at_seams = 0;
  };

  template <class Contact>
  bool is_at_seam(const Contact& contact) const;
  std::string note_of_neighbours() const;

  const Input& input_;
  const MovingObjects& objects_;
  std::map<ObjectId, Counts> counts_;
};

/// Tables of all frames together: the objects that touch, and the work and time of each stage.
class TextReport {
 public:
  /// `noun` is the word for a frame: `frame` or `step`.
  TextReport(std::string noun, const Input& input, const MovingObjects& objects);

  void add(const Frame& frame);
  /// Prints to standard output.
  void print(const TestedKinds& tested) const;

 private:
  struct Counts {
    std::uint64_t frames = 0;
    std::uint64_t count = 0;  ///< pairs of triangles or elements, or vertices inside
  };
  struct PairSummary : Counts {
    std::uint64_t most = 0;           ///< triangle pairs in one frame
    std::uint64_t frame_of_most = 0;  ///< the first frame with this number
  };
  struct ImpactSummary : Counts {
    std::uint64_t edge_edge = 0;
  };
  struct NearSummary : Counts {
    double smallest = 0;  ///< distance
  };
  struct InsideSummary : Counts {
    double deepest = 0;
    std::uint32_t deepest_vertex = 0;
    std::uint64_t frame_of_deepest = 0;  ///< the first frame with this depth
    std::uint64_t frames_contained = 0;  ///< frames in which the whole object is inside
  };
  struct ImpactStep {
    std::uint64_t number = 0, vertex_face = 0, edge_edge = 0;
    double earliest = 1;
  };
  template <class Summary>
  using Summaries = std::map<ObjectPair, Summary>;

  void add_impacts(const Frame& frame);
  /// The pairs of objects with the most first. `cells(summary)` are the cells after the number of frames.
  template <class Summary, class Cells>
  void print_table(const Summaries<Summary>& pairs, const char* option, const Cells& cells) const;

  void print_contacts(const TestedKinds& tested) const;
  void print_curves() const;
  void print_penetrations() const;
  void print_impacts() const;
  void print_near() const;
  void print_pairs() const;
  void print_collisions() const;
  void print_stages() const;
  void print_verify() const;

  std::string noun_;
  const Input& input_;
  const MovingObjects& objects_;
  std::uint64_t triangles_ = 0;  ///< of the input
  std::uint64_t triangle_pairs_ = 0;
  std::uint64_t frames_ = 0;
  Summaries<PairSummary> pairs_;
  Summaries<ImpactSummary> impacts_;
  std::vector<ImpactStep> impact_steps_;  ///< the first that have contacts
  std::uint64_t steps_with_impacts_ = 0, impacts_within_tolerance_ = 0;
  Summaries<NearSummary> near_;
  Summaries<InsideSummary> inside_;  ///< a in b
  std::uint64_t closed_curves_ = 0, open_curves_ = 0, branched_curves_ = 0;
  SelfContacts self_contacts_;
  StepStats sum_;
  std::uint64_t volumes_begun_ = 0, leaves_begun_ = 0, near_begun_ = 0, begun_ = 0, ended_ = 0;
  bool simulated_ = false;
  double motion_seconds_ = 0;
  std::uint64_t non_finite_ = 0;  ///< in the last frame
  bool verified_ = false;
  std::uint64_t checked_ = 0, differences_ = 0;
};

/// The requested reports, and the results that decide the exit status.
class Reports {
 public:
  /// `noun` is the word for a frame in messages: `frame` or `step`.
  Reports(const DetectionOptions& options, const Input& input, const MovingObjects& objects,
          std::string noun);

  /// No tables are printed with --quiet, or when standard output has other data.
  bool has_tables() const { return text_.has_value(); }
  /// Prints the first difference of the run; the JSON has all of them.
  void add(const Frame& frame);
  /// `was_ended` says that a limit or a signal ended the run, so that frames are missing.
  void finish(bool was_ended = false);
  /// The exit status of a finished run. With --fail-on-contact, it reports on standard error what was not
  /// tested.
  int exit_status() const;

 private:
  void report_faults(const char* what) const;
  /// Whether what was not tested decides the exit status, which then reports it.
  bool is_failing() const { return options_.fail_on_contact && !touched_ && !differed_; }

  const DetectionOptions& options_;
  const Input& input_;
  const MovingObjects& objects_;
  std::string solid_parts_;
  std::optional<JsonReport> json_;
  std::optional<CsvReport> csv_;
  std::optional<TextReport> text_;
  TestedKinds tested_;
  std::uint64_t last_frame_ = 0, truncated_frames_ = 0;
  bool touched_ = false, differed_ = false, was_ended_ = false;
};

}  // namespace supple::cli
