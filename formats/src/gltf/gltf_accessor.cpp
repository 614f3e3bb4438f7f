#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

#include "core/quotes.hpp"
#include "files/byte_order.hpp"
#include "gltf/gltf_file.hpp"

namespace supple {
namespace {

/// How the numbers of an accessor are stored.
enum class Component : std::uint64_t {
  int8 = 5120,
  uint8 = 5121,
  int16 = 5122,
  uint16 = 5123,
  uint32 = 5125,
  float32 = 5126
};

std::size_t size_of(Component component) {
  return component <= Component::uint8 ? 1 : component <= Component::uint16 ? 2 : 4;
}

Component component_of(const GltfValue& value) {
  const std::uint64_t number = value.whole();
  if ((number < 5120 || number > 5126) || number == 5124)
    value.fail_here(std::to_string(number) + " is not a kind of numbers that glTF has");
  return static_cast<Component>(number);
}

template <class Scalar>
double as_double(const char* place, bool is_normalized) {
  const auto value = static_cast<double>(load_scalar<Scalar>(place, std::endian::little));
  if constexpr (std::is_integral_v<Scalar>) {
    if (is_normalized) return std::max(value / static_cast<double>(std::numeric_limits<Scalar>::max()), -1.0);
  }
  return value;
}

double number_at(const char* place, Component component, bool is_normalized) {
  switch (component) {
    case Component::int8:
      return as_double<std::int8_t>(place, is_normalized);
    case Component::uint8:
      return as_double<std::uint8_t>(place, is_normalized);
    case Component::int16:
      return as_double<std::int16_t>(place, is_normalized);
    case Component::uint16:
      return as_double<std::uint16_t>(place, is_normalized);
    case Component::uint32:
      return as_double<std::uint32_t>(place, is_normalized);
    default:
      return as_double<float>(place, false);
  }
}

std::size_t width_of(const GltfValue& value, std::string_view type) {
  constexpr std::array types = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"};
  constexpr std::array<std::size_t, 5> widths = {1, 2, 3, 4, 16};
  const std::string given = value.text();
  if (given != type) value.fail_here("expected " + std::string(type) + ", found " + in_quotes(given));
  return widths[static_cast<std::size_t>(std::find(types.begin(), types.end(), type) - types.begin())];
}

/// Reads `count` elements of `width` numbers from a buffer view.
std::vector<double> read_numbers(GltfFile& file, const GltfValue& place, std::uint64_t count,
                                 std::size_t width, Component component, bool is_normalized) {
  const GltfValue views = file.root()["bufferViews"];
  const std::uint32_t view = place["bufferView"].index(views.size(), "buffer view");
  const std::string_view bytes = file.view(view);
  const std::uint64_t size = size_of(component) * width;
  const std::uint64_t stride = views.at(view)["byteStride"].whole_or(size);
  const std::uint64_t offset = place["byteOffset"].whole_or(0);
  if (count == 0) return {};
  if (stride < size)
    views.at(view)["byteStride"].fail_here("is less than the " + std::to_string(size) +
                                           " bytes of an element");
  if (offset > bytes.size() || size > bytes.size() - offset ||
      (count - 1) > (bytes.size() - offset - size) / stride)
    place.fail_here(std::to_string(count) + " elements go past the end of the buffer view of " +
                    std::to_string(bytes.size()) + " bytes");
  std::vector<double> numbers;
  numbers.reserve(count * width);
  for (std::uint64_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < width; ++k) {
      const char* place_of_number = bytes.data() + offset + i * stride + k * size_of(component);
      numbers.push_back(number_at(place_of_number, component, is_normalized));
    }
  }
  return numbers;
}

/// Replaces some elements.
void apply_sparse(GltfFile& file, const GltfValue& sparse, Component component, bool is_normalized,
                  GltfNumbers& numbers) {
  const std::uint64_t count = sparse["count"].whole();
  const GltfValue places = sparse["indices"];
  const std::vector<double> indices =
      read_numbers(file, places, count, 1, component_of(places["componentType"]), false);
  const std::vector<double> values =
      read_numbers(file, sparse["values"], count, numbers.width, component, is_normalized);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!(indices[i] >= 0 && indices[i] < static_cast<double>(numbers.count)))
      places.fail_here("an index is not below the count of the accessor");
    std::copy_n(values.data() + i * numbers.width, numbers.width,
                numbers.values.data() + static_cast<std::size_t>(indices[i]) * numbers.width);
  }
}

}  // namespace

GltfNumbers read_accessor(GltfFile& file, const GltfValue& index, std::string_view type) {
  const GltfValue accessors = file.root()["accessors"];
  const GltfValue accessor = accessors.at(index.index(accessors.size(), "accessor"));
  GltfNumbers numbers;
  numbers.count = accessor["count"].whole();
  numbers.width = width_of(accessor["type"], type);
  const Component component = component_of(accessor["componentType"]);
  const bool is_normalized = accessor["normalized"].boolean_or(false);
  if (accessor["bufferView"]) {
    numbers.values = read_numbers(file, accessor, numbers.count, numbers.width, component, is_normalized);
  } else {
    // Zeros, which cost the file no bytes.
    if (numbers.count > file.bytes())
      accessor["count"].fail_here(std::to_string(numbers.count) + " is more than the file can hold");
    numbers.values.resize(numbers.count * numbers.width);
  }
  if (const GltfValue sparse = accessor["sparse"])
    apply_sparse(file, sparse, component, is_normalized, numbers);
  return numbers;
}

}  // namespace supple
