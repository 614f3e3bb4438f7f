#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "reports/impact_tables.hpp"
#include "reports/report.hpp"
#include "reports/self_contacts.hpp"
#include "reports/tested_kinds.hpp"

namespace supple::cli {

/// Tables of all frames together: the objects that touch, and the work and time of each stage.
class TextReport {
 public:
  /// `noun` is the word for a frame: `frame` or `step`.
  TextReport(std::string noun, const Input& input, const MovingObjects& objects);

  void add(const Frame& frame);
  /// Prints to standard output.
  void print(const TestedKinds& tested) const;

 private:
  struct PairSummary {
    std::uint64_t frames = 0;
    std::uint64_t triangle_pairs = 0;
    std::uint64_t most = 0;           ///< triangle pairs in one frame
    std::uint64_t frame_of_most = 0;  ///< the first frame with this number
  };

  struct NearSummary {
    std::uint64_t frames = 0, pairs = 0;
    double smallest = 0;  ///< distance
  };

  struct InsideSummary {
    std::uint64_t frames = 0, vertices = 0;
    double deepest = 0;
    std::uint32_t deepest_vertex = 0;
    std::uint64_t frame_of_deepest = 0;  ///< the first frame with this depth
    std::uint64_t frames_contained = 0;  ///< frames in which the whole object is inside
  };

  void print_contacts(const TestedKinds& tested) const;
  void print_curves() const;
  void print_penetrations() const;
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
  std::map<ObjectPair, PairSummary> pairs_;
  std::map<ObjectPair, NearSummary> near_;
  std::map<ObjectPair, InsideSummary> inside_;  ///< a in b
  std::uint64_t closed_curves_ = 0, open_curves_ = 0, branched_curves_ = 0;
  SelfContacts self_contacts_;
  ImpactTables impacts_;  ///< of continuous contacts
  StepStats sum_;
  std::uint64_t volumes_begun_ = 0, leaves_begun_ = 0, near_begun_ = 0, begun_ = 0, ended_ = 0;
  bool simulated_ = false;
  double motion_seconds_ = 0;
  std::uint64_t non_finite_ = 0;  ///< in the last frame
  bool verified_ = false;
  std::uint64_t checked_ = 0, differences_ = 0;
};

}  // namespace supple::cli
