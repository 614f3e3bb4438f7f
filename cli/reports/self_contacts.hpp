#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "supple/result.hpp"

namespace supple::cli {

struct Input;
class MovingObjects;

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

}  // namespace supple::cli
