#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "supple/result.hpp"

namespace supple::cli {

struct Frame;
struct Input;

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

}  // namespace supple::cli
