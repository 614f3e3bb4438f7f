#include "history/history.hpp"

#include <algorithm>
#include <utility>

namespace supple::viewer {
namespace {

/// Bounds the memory and the time that very small steps take.
constexpr std::size_t most_steps = 10'000;

double bytes_of(std::span<const Vec3d> positions) {
  return static_cast<double>(positions.size_bytes());
}

}  // namespace

void History::keep(const Source& source) {
  if (!(most_bytes_ > 0)) return;
  const bool is_same_step = !steps_.empty() && steps_.back().number == source.step();
  double needed = 0;
  for (std::size_t i = 0; i < spare_.size(); ++i) {
    if (has_moved(source, i)) needed += bytes_of(source.positions(i));
  }
  if (is_same_step && needed == 0) return;
  struct Guard {
    History* history;
    ~Guard() {
      if (history != nullptr) history->clear();
    }
  } guard{this};
  add(source, needed, is_same_step);
  guard.history = nullptr;
}

void History::clear() {
  steps_.clear();
  spare_steps_.clear();
  for (std::vector<Positions>& list : spare_) list.clear();
  versions_.clear();
  series_.values.clear();
  bytes_ = 0;
}

void History::add(const Source& source, double needed, bool is_same_step) {
  make_room(needed);
  Step step;
  if (is_same_step) {
    step = std::move(steps_.back());
    steps_.pop_back();
    series_.values.pop_back();
  } else if (!spare_steps_.empty()) {
    step = std::move(spare_steps_.back());
    spare_steps_.pop_back();
  }
  const std::size_t count = spare_.size();
  step.objects.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (!has_moved(source, i)) {
      if (!is_same_step) step.objects[i] = steps_.back().objects[i];
      continue;
    }
    put_back(i, step.objects[i]);
    step.objects[i] = copy(i, source.positions(i));
  }
  step.number = source.step();
  versions_.resize(count);
  for (std::size_t i = 0; i < count; ++i) versions_[i] = source.version(i);
  steps_.push_back(std::move(step));
  series_.values.push_back(source.time());
}

void History::read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const {
  const std::vector<Vec3d>& kept = *at(frame).objects[object];
  std::copy(kept.begin(), kept.end(), positions.begin());
}

std::uint64_t History::frame_of(std::uint64_t step) const {
  const auto after =
      std::upper_bound(steps_.begin(), steps_.end(), step,
                       [](std::uint64_t wanted, const Step& kept) { return wanted < kept.number; });
  return after == steps_.begin() ? 0 : static_cast<std::uint64_t>(after - steps_.begin()) - 1;
}

/// The last step stays: the next one needs it for continuous contacts.
void History::make_room(double bytes) {
  while (steps_.size() > 1 && (bytes_ + bytes > most_bytes_ || steps_.size() >= most_steps)) drop_first();
}

void History::drop_first() {
  std::rotate(steps_.begin(), steps_.begin() + 1, steps_.end());
  spare_steps_.push_back(std::move(steps_.back()));
  steps_.pop_back();
  series_.values.erase(series_.values.begin());
  for (std::size_t i = 0; i < spare_.size(); ++i) put_back(i, spare_steps_.back().objects[i]);
}

History::Positions History::copy(std::size_t object, std::span<const Vec3d> positions) {
  Positions made;
  if (spare_[object].empty()) {
    made = std::make_shared<std::vector<Vec3d>>(positions.begin(), positions.end());
  } else {
    made = std::move(spare_[object].back());
    spare_[object].pop_back();
    made->assign(positions.begin(), positions.end());
  }
  bytes_ += bytes_of(positions);
  return made;
}

/// Keeps the memory of positions that no other step has.
void History::put_back(std::size_t object, Positions& positions) {
  if (positions != nullptr && positions.use_count() == 1) {
    bytes_ -= bytes_of(*positions);
    spare_[object].push_back(std::move(positions));
  }
  positions.reset();
}

}  // namespace supple::viewer
