#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "messages/message.hpp"
#include "messages/sections.hpp"
#include "supple/contact.hpp"

namespace supple::viewer {

using ObjectPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  ///< of object indices, sorted

/// The pairs of objects of the last step, and the steps in which pairs began and ended.
class PairHistory {
 public:
  PairHistory(Tag begin, Tag end) : sides_{Side{begin}, Side{end}} {}

  /// Forgets everything.
  void restart();
  /// Call when the page has no events.
  void forget_sent();
  /// The pairs of a step; takes over the contents of `pairs`.
  void set(std::uint64_t step, ObjectPairs& pairs);
  /// What a step without a frame changed.
  void change(std::uint64_t step, std::span<const ObjectPair> begin, std::span<const ObjectPair> end);
  /// Drops events before a step.
  void drop_before(std::uint64_t step);
  /// Adds the events that the page does not have.
  void send(MessageWriter& message);

 private:
  struct Side {
    Tag tag;
    std::vector<std::array<std::uint32_t, 3>> events{};  // the step, and two objects
    std::size_t sent = 0;
    void add(std::uint64_t step, std::pair<std::uint32_t, std::uint32_t> pair);
  };

  std::array<Side, 2> sides_;
  ObjectPairs pairs_, changed_;
};

}  // namespace supple::viewer
