#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace supple::viewer {

// `section_forms` (sections.hpp) says what the sections contain.

enum class MessageKind : std::uint16_t { scene = 1, frame = 2, answer = 3, failure = 4, series = 5 };

inline constexpr const char* names_of_message_kinds[] = {"", "scene", "frame", "answer", "failure", "series"};

enum class Tag : std::uint32_t {
  text = 1,
  triangles = 16,
  edges = 17,
  points = 18,
  positions = 32,
  column = 33,
  candidates = 38,
  scene_regions = 39,
  octree_boxes = 40,
  octree_spheres = 41,
  colliding_vertices = 42,
  statistics = 43,
  contact_begin = 44,
  contact_end = 45,
  narrow_phase_begin = 46,
  narrow_phase_end = 47,
  volume_begin = 48,
  volume_end = 49,
  colliding_boxes = 50,
  colliding_spheres = 51,
  octree_edges = 52,
  colliding_edges = 53,
  field_values = 61,
  field_vectors = 62,
  pin_rows = 63,
  series = 64,
  series_contact_begin = 65,
  series_contact_end = 66,
  series_narrow_phase_begin = 67,
  series_narrow_phase_end = 68,
  series_volume_begin = 69,
  series_volume_end = 70,
};

/// The object id of sections that belong to no object.
inline constexpr std::uint32_t no_object = ~std::uint32_t{0};

/// Writes messages one after the other into the same memory, which only grows.
class MessageWriter {
 public:
  void begin(MessageKind kind);
  void add_text(std::string_view json);
  /// Adds a section of `count` elements. The caller must write them before it adds anything else.
  template <class Element>
  std::span<Element> add(Tag tag, std::uint32_t object, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<Element> && alignof(Element) <= alignment);
    std::byte* const data = add_section(tag, object, count, count * sizeof(Element));
    return {reinterpret_cast<Element*>(data), count};
  }
  /// Adds a section of `count` elements that take `length` bytes.
  std::span<std::byte> add_bytes(Tag tag, std::uint32_t object, std::size_t count, std::size_t length) {
    return {add_section(tag, object, count, length), length};
  }
  template <class Element>
  std::span<Element> add(Tag tag, std::size_t count) {
    return add<Element>(tag, no_object, count);
  }
  /// Adds a section of `count` elements with `values` values each.
  template <class Value>
  std::span<Value> add_rows(Tag tag, std::uint32_t object, std::size_t count, std::size_t values) {
    std::byte* const data = add_section(tag, object, count, count * values * sizeof(Value));
    return {reinterpret_cast<Value*>(data), count * values};
  }
  /// The complete message, valid until the next `begin`.
  std::span<const std::byte> finish();

 private:
  static_assert(std::endian::native == std::endian::little, "messages are little-endian, read in place");
  static constexpr std::size_t alignment = 16;
  struct alignas(alignment) Block {
    std::byte bytes[alignment];
  };

  std::byte* add_section(Tag tag, std::uint32_t object, std::size_t count, std::size_t length);
  std::byte* append(std::size_t length);

  std::vector<Block> blocks_;  // sized for the longest message so far
  std::size_t used_ = 0;       // blocks in use
  MessageKind kind_{};
  std::uint32_t section_count_ = 0;
};

}  // namespace supple::viewer
