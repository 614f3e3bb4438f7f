#include "broad_phase/volume_store.hpp"

#include <algorithm>
#include <cstring>

namespace supple {
namespace {

template <class Volume>
bool differs(const Volume& now, const Volume& before) {
  return std::memcmp(&now, &before, sizeof(Volume)) != 0 && !(now.empty() && before.empty());
}

Aabb box_of(const Aabb& box) {
  return box;
}
Aabb box_of(const BoundingSphere& sphere) {
  return bounding_box(sphere);
}

/// Writes the slots of [begin, end) whose volumes changed to `out` and returns how many there are. Slots past
/// the end of `now` are empty now. With `take` the volumes, and the boxes around them, become those of now.
template <class Volume>
std::size_t compare(std::span<const Volume> now, std::vector<Volume>& known, std::vector<Aabb>& boxes,
                    bool take, std::size_t begin, std::size_t end, std::uint32_t* out) {
  constexpr std::size_t block_size = 8;
  const Volume none{};
  std::size_t count = 0;
  for (std::size_t block = begin; block < end; block += block_size) {
    const std::size_t block_end = std::min(block + block_size, end);
    if (block_end <= now.size() &&
        std::memcmp(&now[block], &known[block], (block_end - block) * sizeof(Volume)) == 0)
      continue;
    for (std::size_t i = block; i < block_end; ++i) {
      const Volume& incoming = i < now.size() ? now[i] : none;
      if (!differs(incoming, known[i])) continue;
      out[count++] = static_cast<std::uint32_t>(i);
      if (!take) continue;
      boxes[i] = box_of(incoming);
      known[i] = incoming;
    }
  }
  return count;
}

}  // namespace

void VolumeStore::update(const ObjectVolumes& given, bool keep_previous, const Parallel& parallel) {
  const std::size_t known_count = given_count_;
  given_ = given;
  given_count_ = has_spheres_ ? given.spheres.size() : given.boxes.size();
  boxes_.resize(std::max(given_count_, known_count));
  if (has_spheres_) spheres_.resize(boxes_.size());
  taken_ = !keep_previous;
  if (!given.dirty) {
    compare_all(parallel);
  } else {
    listed_.assign(given.dirty->begin(), given.dirty->end());
    const auto [fewer, more] = std::minmax(given_count_, known_count);
    for (std::size_t slot = fewer; slot < more; ++slot) listed_.push_back(static_cast<std::uint32_t>(slot));
    std::sort(listed_.begin(), listed_.end());
    listed_.erase(std::unique(listed_.begin(), listed_.end()), listed_.end());
    std::erase_if(listed_, [&](std::uint32_t slot) { return !is_changed(slot); });
    changed_count_ = listed_.size();
    if (taken_)
      for (const std::uint32_t slot : listed_) take(slot);
  }
  revision_ += changed_count_ != 0;
}

void VolumeStore::take(std::uint32_t slot) {
  const ObjectVolume now = incoming(slot);
  boxes_[slot] = now.box;
  if (has_spheres_) spheres_[slot] = now.sphere;
}

void VolumeStore::take_changed() {
  if (taken_) return;
  for (const std::uint32_t slot : changed()) take(slot);
  taken_ = true;
}

ObjectVolume VolumeStore::incoming(std::uint32_t slot) const {
  if (slot >= given_count_) return {};
  if (has_spheres_) return {bounding_box(given_.spheres[slot]), given_.spheres[slot]};
  return {given_.boxes[slot], {}};
}

bool VolumeStore::is_changed(std::uint32_t slot) const {
  const ObjectVolume now = incoming(slot);
  return has_spheres_ ? differs(now.sphere, spheres_[slot]) : differs(now.box, boxes_[slot]);
}

void VolumeStore::compare_all(const Parallel& parallel) {
  constexpr std::size_t chunk_size = 8192;
  const std::size_t slots = slot_count(), chunk_count = (slots + chunk_size - 1) / chunk_size;
  listed_.resize(slots + 1);
  chunk_sizes_.resize(chunk_count);
  parallel.for_ranges(chunk_count, 1, [&](std::size_t first, std::size_t last, std::uint32_t) {
    for (std::size_t chunk = first; chunk < last; ++chunk) {
      const std::size_t begin = chunk * chunk_size;
      const std::size_t end = std::min(begin + chunk_size, slots);
      std::uint32_t* const out = listed_.data() + begin;
      chunk_sizes_[chunk] = has_spheres_ ? compare(given_.spheres, spheres_, boxes_, taken_, begin, end, out)
                                         : compare(given_.boxes, boxes_, boxes_, taken_, begin, end, out);
    }
  });
  changed_count_ = 0;
  for (std::size_t chunk = 0; chunk < chunk_count; ++chunk) {
    std::copy_n(listed_.data() + chunk * chunk_size, chunk_sizes_[chunk], listed_.data() + changed_count_);
    changed_count_ += chunk_sizes_[chunk];
  }
}

}  // namespace supple
