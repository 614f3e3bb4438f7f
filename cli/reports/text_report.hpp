#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "supple/result.hpp"

namespace supple::cli {

struct Frame;
struct Input;
class MovingObjects;
class TestedKinds;

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

}  // namespace supple::cli
