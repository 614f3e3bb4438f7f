#include "pins/pin_rows.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace supple::viewer {

void limit_rows(std::vector<PinRow>& rows) {
  if (rows.size() > most_pin_rows) rows.erase(rows.begin(), rows.begin() + most_pin_rows / 2);
}

void PinRows::set(std::vector<Pin> pins) {
  numbers_.clear();
  for (const Pin& pin : pins) numbers_.push_back(pin.number);
  std::erase_if(rows_, [&](const PinRow& row) {
    return std::find(numbers_.begin(), numbers_.end(), row.pin) == numbers_.end();
  });
  meter_.set(std::move(pins));
}

void PinRows::restart() {
  rows_.clear();
  meter_.forget();
}

void PinRows::measure(const Scene& scene, std::uint64_t step, double time, const PinMeter::Earlier& earlier) {
  while (!rows_.empty() && rows_.back().step == step) rows_.pop_back();  // detected again
  meter_.measure(scene, step, time, rows_, earlier);
  limit_rows(rows_);
}

void PinRows::add(std::span<const PinRow> rows) {
  rows_.insert(rows_.end(), rows.begin(), rows.end());
  limit_rows(rows_);
}

void PinRows::add_to(MessageWriter& message) {
  for (const std::uint32_t number : numbers_) {
    const auto is_of_pin = [&](const PinRow& row) { return row.pin == number; };
    const auto count = static_cast<std::size_t>(std::count_if(rows_.begin(), rows_.end(), is_of_pin));
    if (count == 0) continue;
    const auto sent = message.add<std::array<double, pin_row_width>>(Tag::pin_rows, number, count);
    std::size_t at = 0;
    for (const PinRow& row : rows_) {
      if (!is_of_pin(row)) continue;
      auto& numbers = sent[at++];
      numbers[0] = static_cast<double>(row.step);
      numbers[1] = row.time;
      std::size_t place = 2;
      for_each_leaf([&](const auto&, double value) { numbers[place++] = value; }, row.values);
    }
  }
  rows_.clear();
}

}  // namespace supple::viewer
