#include "broad_phase/volume_store.hpp"

#include <algorithm>
#include <cstring>

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

/// Whether the volumes of [begin, end) are certainly the same as before; quick for volumes at rest.
template <class Volume>
bool is_same_block(std::span<const Volume> given, const std::vector<Volume>& known, std::size_t begin,
                   std::size_t end) {
  return end <= given.size() &&
         std::memcmp(&given[begin], &known[begin], (end - begin) * sizeof(Volume)) == 0;
}

}  // namespace

void VolumeStore::update(const ObjectVolumes& given, const Parallel& parallel) {
  const std::size_t known_count = given_count_;
  given_count_ = has_spheres_ ? given.spheres.size() : given.boxes.size();
  boxes_.resize(std::max(given_count_, known_count));
  if (has_spheres_) spheres_.resize(boxes_.size());
  if (!given.dirty) {
    compare_all(given, parallel);
  } else {
    listed_.assign(given.dirty->begin(), given.dirty->end());
    const auto [fewer, more] = std::minmax(given_count_, known_count);
    for (std::size_t slot = fewer; slot < more; ++slot) listed_.push_back(static_cast<std::uint32_t>(slot));
    std::sort(listed_.begin(), listed_.end());
    std::erase_if(listed_, [&](std::uint32_t slot) { return !take_if_changed(given, slot); });
    changed_count_ = listed_.size();
  }
  revision_ += changed_count_ != 0;
}

bool VolumeStore::take_if_changed(const ObjectVolumes& given, std::uint32_t slot) {
  if (has_spheres_) {
    const BoundingSphere sphere = volume_at(given.spheres, slot);
    if (!differs(sphere, spheres_[slot])) return false;
    spheres_[slot] = sphere;
    boxes_[slot] = bounding_box(sphere);
  } else {
    const Aabb box = volume_at(given.boxes, slot);
    if (!differs(box, boxes_[slot])) return false;
    boxes_[slot] = box;
  }
  return true;
}

void VolumeStore::compare_all(const ObjectVolumes& given, const Parallel& parallel) {
  constexpr std::size_t chunk_size = 8192, block_size = 8;
  const std::size_t slots = slot_count(), chunk_count = (slots + chunk_size - 1) / chunk_size;
  listed_.resize(slots);
  chunk_sizes_.resize(chunk_count);
  parallel.for_ranges(chunk_count, 1, [&](std::size_t first, std::size_t last, std::uint32_t) {
    for (std::size_t chunk = first; chunk < last; ++chunk) {
      std::size_t count = 0;
      const std::size_t begin = chunk * chunk_size, end = std::min(begin + chunk_size, slots);
      for (std::size_t block = begin; block < end; block += block_size) {
        const std::size_t block_end = std::min(block + block_size, end);
        if (has_spheres_ ? is_same_block(given.spheres, spheres_, block, block_end)
                         : is_same_block(given.boxes, boxes_, block, block_end))
          continue;
        for (std::size_t slot = block; slot < block_end; ++slot)
          if (take_if_changed(given, static_cast<std::uint32_t>(slot)))
            listed_[begin + count++] = static_cast<std::uint32_t>(slot);
      }
      chunk_sizes_[chunk] = count;
    }
  });
  changed_count_ = 0;
  for (std::size_t chunk = 0; chunk < chunk_count; ++chunk) {
    std::copy_n(listed_.data() + chunk * chunk_size, chunk_sizes_[chunk], listed_.data() + changed_count_);
    changed_count_ += chunk_sizes_[chunk];
  }
}

}  // namespace supple
