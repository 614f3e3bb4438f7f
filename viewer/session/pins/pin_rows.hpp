#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "messages/message.hpp"
#include "pins/pin_meter.hpp"

namespace supple::viewer {

/// Rows of pins that are kept for the next frame, or for the session; of more, the last ones.
inline constexpr std::size_t most_pin_rows = 65'536;

/// Removes the first half when there are too many.
void limit_rows(std::vector<PinRow>& rows);

/// Pins and the rows that the page does not have.
class PinRows {
 public:
  void set(std::vector<Pin> pins);
  /// Call at the start of a new run.
  void restart();
  void measure(const Scene& scene, std::uint64_t step, double time, const PinMeter::Earlier& earlier = {});
  /// Takes rows that were measured elsewhere.
  void add(std::span<const PinRow> rows);
  /// Rows that the page does not have.
  std::size_t size() const { return rows_.size(); }
  /// Adds a section for each pin that has rows, and forgets the rows.
  void add_to(MessageWriter& message);

 private:
  PinMeter meter_;
  std::vector<std::uint32_t> numbers_;  // of the pins
  std::vector<PinRow> rows_;
};

}  // namespace supple::viewer
