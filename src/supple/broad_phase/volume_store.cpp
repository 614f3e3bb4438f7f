#include "broad_phase/volume_store.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace supple {
namespace {

template <class Volume>
bool differs(const Volume& now, const Volume& before) {
  return std::memcmp(&now, &before, sizeof(Volume)) != 0 && !(now.empty() && before.empty());
}

template <class Volume>
Volume volume_at(std::span<const Volume> given, std::size_t slot) {
  return slot < given.size() ? given[slot] : Volume{};
}

template <class Item>
bool is_same_range(std::span<const Item> given, const std::vector<Item>& known, std::size_t begin,
                   std::size_t end) {
  return end <= given.size() && std::memcmp(&given[begin], &known[begin], (end - begin) * sizeof(Item)) == 0;
}

}  // namespace

void VolumeStore::update(const ObjectVolumes& given, const Parallel& parallel) {
  const std::size_t known_count = given_count_;
  given_count_ = has_spheres_ ? given.spheres.size() : given.boxes.size();
  boxes_.resize(std::max(given_count_, known_count));
  if (has_spheres_) spheres_.resize(boxes_.size());
  if (wanted_.has_kinds()) kinds_.resize(boxes_.size());
  changed_.clear();
  if (given.dirty) {
    changed_.assign(given.dirty->begin(), given.dirty->end());
    const auto [fewer, more] = std::minmax(given_count_, known_count);
    for (std::size_t slot = fewer; slot < more; ++slot) changed_.push_back(static_cast<std::uint32_t>(slot));
    std::sort(changed_.begin(), changed_.end());
    std::erase_if(changed_, [&](std::uint32_t slot) { return !take_if_changed(given, slot); });
  } else {
    constexpr std::size_t grain = 8192, block_size = 8;
    is_changed_.resize(slot_count());
    parallel.for_ranges(slot_count(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t) {
      for (std::size_t block_end = begin; begin < end; begin = block_end) {
        block_end = std::min(begin + block_size, end);
        const bool is_same = is_same_block(given, begin, block_end);
        for (std::size_t slot = begin; slot < block_end; ++slot)
          is_changed_[slot] = !is_same && take_if_changed(given, static_cast<std::uint32_t>(slot)) ? 1 : 0;
      }
    });
    for (std::uint32_t slot = 0; slot < slot_count(); ++slot)
      if (is_changed_[slot] != 0) changed_.push_back(slot);
  }
  revision_ += changed_.empty() ? 0 : 1;
}

/// A volume whose kind has no partner is empty.
inline bool VolumeStore::take_volume_if_changed(const ObjectVolumes& given, std::uint32_t slot,
                                                bool has_partner) {
  if (has_spheres_) {
    const BoundingSphere sphere = has_partner ? volume_at(given.spheres, slot) : BoundingSphere{};
    if (!differs(sphere, spheres_[slot])) return false;
    spheres_[slot] = sphere;
    boxes_[slot] = bounding_box(sphere);
  } else {
    const Aabb box = has_partner ? volume_at(given.boxes, slot) : Aabb{};
    if (!differs(box, boxes_[slot])) return false;
    boxes_[slot] = box;
  }
  return true;
}

bool VolumeStore::take_kind_if_changed(const ObjectVolumes& given, std::uint32_t slot) {
  if (slot >= given.kinds.size()) return take_volume_if_changed(given, slot, true);
  const std::uint8_t kind = given.kinds[slot], last_kind = std::exchange(kinds_[slot], kind);
  const bool has_other_volume = take_volume_if_changed(given, slot, wanted_.partners(kind) != 0);
  return has_other_volume || (kind != last_kind && !boxes_[slot].empty());
}

bool VolumeStore::take_if_changed(const ObjectVolumes& given, std::uint32_t slot) {
  return wanted_.has_kinds() ? take_kind_if_changed(given, slot) : take_volume_if_changed(given, slot, true);
}

/// Whether the volumes of [begin, end) are certainly the same as before; quick for volumes at rest.
bool VolumeStore::is_same_block(const ObjectVolumes& given, std::size_t begin, std::size_t end) const {
  if (wanted_.has_kinds() && !is_same_range(given.kinds, kinds_, begin, end)) return false;
  return has_spheres_ ? is_same_range(given.spheres, spheres_, begin, end)
                      : is_same_range(given.boxes, boxes_, begin, end);
}

}  // namespace supple
