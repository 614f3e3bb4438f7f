#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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

/// Shows the frames of a run in one form.
class Report {
 public:
  virtual ~Report() = default;
  virtual void add(const Frame& frame) = 0;
  /// `was_ended` says that frames are missing.
  virtual void finish(bool was_ended) = 0;
};

/// The result of `supple detect` as JSON, as docs/json.md describes, frame by frame.
std::unique_ptr<Report> make_json_report(const std::string& file_name, const Input& input,
                                         const MovingObjects& objects, const JsonContent& content);
/// One row per contact, as docs/json.md describes: the frame, and the members of the record; vectors and
/// weights only with `details`. With colliding vertices, one row per contact of triangles, per vertex and per
/// event of the narrow phase.
std::unique_ptr<Report> make_csv_report(const std::string& file_name, const SceneOptions& options,
                                        bool details);
/// Tables of all frames together, on standard output. `noun` is the word for a frame: `frame` or `step`.
std::unique_ptr<Report> make_text_report(std::string noun, const Input& input, const MovingObjects& objects,
                                         const TestedKinds& tested);

/// The requested reports, and the results that decide the exit status.
class Reports {
 public:
  /// `noun` is the word for a frame in messages: `frame` or `step`.
  Reports(const DetectionOptions& options, const Input& input, const MovingObjects& objects,
          std::string noun);

  /// No tables are printed with --quiet, or when standard output has other data.
  bool has_tables() const { return text_ != nullptr; }
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
  TestedKinds tested_;
  std::vector<std::unique_ptr<Report>> files_;
  std::unique_ptr<Report> text_;
  std::uint64_t last_frame_ = 0, truncated_frames_ = 0;
  bool touched_ = false, differed_ = false, was_ended_ = false;
};

}  // namespace supple::cli
