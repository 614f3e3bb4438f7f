#include "recording_header.hpp"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "layout.hpp"
#include "ragged_reader.hpp"
#include "supple/error.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/version.hpp"
#include "text.hpp"

namespace supple {
namespace {

[[noreturn]] void fail_about(const InputFile& file, const std::string& group, const std::string& name,
                             const std::string& value, const std::string& what) {
  file.fail(group == "/" ? "" : group, "attribute " + name + " is " + value + what);
}

template <Worded Enum>
void read_option(const InputFile& file, const std::string& group, const std::string& name, Enum& value) {
  const std::string word = file.text(group, name.c_str());
  const std::optional<Enum> found = value_of_word<Enum>(word);
  if (!found)
    fail_about(file, group, name, "'" + word + "'",
               ", which this program does not know; use the supple that recorded it");
  value = *found;
}

/// Version 1 stores truth values as numbers.
void read_option(const InputFile& file, const std::string& group, const std::string& name, bool& value,
                 const std::array<const char*, 2>& words, std::uint32_t version) {
  if (words[0] == nullptr || version < 2) {
    value = file.count(group, name.c_str(), 1) == 1;
    return;
  }
  const std::string word = file.text(group, name.c_str());
  if (word != words[0] && word != words[1])
    fail_about(file, group, name, "'" + word + "'",
               ", which this program does not know; use the supple that recorded it");
  value = word == words[1];
}

/// The attribute is absent when the option has no value.
void read_option(const InputFile& file, const std::string& group, const std::string& name,
                 std::optional<RootCube>& value) {
  if (!file.has_attribute(group, name.c_str())) return;
  std::array<double, 4> numbers{};
  file.numbers(group, name.c_str(), numbers);
  value = RootCube{{numbers[0], numbers[1], numbers[2]}, numbers[3]};
  if (!is_valid(*value))
    fail_about(file, group, name, text_of(*value),
               ", not " + std::string(range_of_root_cube) + "; record again");
}

template <class Options>
void read_options(const InputFile& file, const std::string& group, std::uint32_t version, Options& options) {
  for_each_leaf(
      [&](const auto& field, auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        const std::string name = attribute_in_version(field.key, version);
        const bool may_miss = version < format_version || name == "curves";  // a later option
        if (field.is_of_machine || (may_miss && !file.has_attribute(group, name.c_str()))) return;
        if constexpr (std::is_same_v<Value, bool>) {
          read_option(file, group, name, value, field.truth_words, version);
        } else if constexpr (Worded<Value> || std::is_same_v<Value, std::optional<RootCube>>) {
          read_option(file, group, name, value);
        } else if constexpr (std::is_same_v<Value, std::string>) {
          value = file.text(group, name.c_str());
        } else {
          constexpr bool is_whole = std::is_integral_v<Value>;
          if constexpr (is_whole)
            value = file.count(group, name.c_str());
          else
            value = file.number(group, name.c_str());
          if (!field.range.allows(value))
            fail_about(file, group, name, to_text(static_cast<double>(value)),
                       ", not " + text_of(field.range, is_whole) + "; record again");
        }
      },
      options);
}

template <class Element>
std::vector<Element> read_all(const InputFile& file, const std::string& path, ScalarType type,
                              std::vector<hsize_t> row_shape) {
  ColumnReader column(file, path, type, std::move(row_shape));
  std::vector<Element> elements(column.rows());
  column.read(0, elements.size(), reinterpret_cast<std::byte*>(elements.data()));
  return elements;
}

RecordedObject read_object(const InputFile& file, std::uint32_t version, std::size_t place) {
  const std::string path = object_path(place);
  RecordedObject object{};
  object.id = {file.count(path, "id_index"), file.count(path, "id_generation")};
  read_options(file, path, version, object.options);
  object.rest_positions = read_all<Vec3d>(file, path + "/rest_positions", ScalarType::float64, {3});
  const auto read_elements = [&]<class Element>(const char* name, std::vector<Element>& elements,
                                                std::vector<hsize_t> row_shape) {
    const std::string dataset = path + name;
    elements = read_all<Element>(file, dataset, ScalarType::uint32, std::move(row_shape));
    constexpr std::size_t width = sizeof(Element) / sizeof(std::uint32_t);
    const std::span ids(reinterpret_cast<const std::uint32_t*>(elements.data()), width * elements.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] >= object.rest_positions.size())
        file.fail(dataset, "row " + std::to_string(i / width) + " names vertex " + std::to_string(ids[i]) +
                               ", the object has " + std::to_string(object.rest_positions.size()) + damaged);
    }
  };
  read_elements("/triangles", object.triangles, {3});
  // Only objects with edges and points of no triangle have these.
  if (file.has_item(path + "/edges")) read_elements("/edges", object.options.edges, {2});
  if (file.has_item(path + "/points")) read_elements("/points", object.options.points, {});
  return object;
}

}  // namespace

std::uint32_t check_format(const InputFile& file) {
  if (file.has_text("/", "format") && file.text("/", "format") == format_name_of_rank)
    throw Error(file.path() +
                ": has only the objects of one rank; give the recording beside it, which has no "
                "rank in its name");
  if (!file.has_text("/", "format") || file.text("/", "format") != format_name)
    throw Error(file.path() + ": is an HDF5 file, but no recording; make one with supple simulate --record");
  const std::uint32_t version = file.count("/", "version");
  if (version < oldest_version || version > format_version)
    throw Error(file.path() + ": is a recording of version " + std::to_string(version) +
                ", supple " SUPPLE_VERSION " reads versions " + std::to_string(oldest_version) + " to " +
                std::to_string(format_version) + "; read it with the supple that wrote it" +
                (version > format_version ? ", or a newer one" : ""));
  return version;
}

RecordingHeader read_header(const InputFile& file, std::uint32_t version,
                            const std::function<const InputFile&(std::size_t)>& file_of) {
  RecordingHeader header;
  header.time_step = file.number("/", "time_step");
  header.scene.curves = true;  // without the attribute, penetration had them
  read_options(file, "/", version, header.scene);
  header.scene_file = file.text_dataset("scene_file");
  if (file.has_attribute("/", "ranks")) header.ranks = file.count("/", "ranks");
  const std::size_t count = file.count_links("objects");
  for (std::size_t place = 0; place < count; ++place)
    header.objects.push_back(read_object(file_of(place), version, place));
  return header;
}

}  // namespace supple
