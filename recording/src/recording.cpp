#include "supple/recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "hdf5_read.hpp"
#include "hdf5_write.hpp"
#include "layout.hpp"
#include "supple/error.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/version.hpp"
#include "text.hpp"

namespace supple {
namespace {

constexpr const char* damaged = "; the file is damaged, record again";

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
        if (field.is_of_machine || (version < format_version && !file.has_attribute(group, name.c_str())))
          return;
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

/// Returns the version.
std::uint32_t check_format(const InputFile& file) {
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

RecordingHeader read_header(const InputFile& file, std::uint32_t version) {
  RecordingHeader header;
  header.time_step = file.number("/", "time_step");
  read_options(file, "/", version, header.scene);
  header.scene_file = file.text_dataset("scene_file");
  const std::size_t count = file.count_links("objects");
  for (std::size_t place = 0; place < count; ++place)
    header.objects.push_back(read_object(file, version, place));
  return header;
}

/// The rows of one frame in a group with any number of rows per frame.
template <class Row>
class RaggedReader {
 public:
  /// An optional group that the file lacks has no rows: an earlier program wrote the file.
  RaggedReader(const InputFile& file, std::uint32_t version, const char* group, std::uint64_t frames,
               bool is_optional = false)
      : file_(&file) {
    if (is_optional && !file.has_item(group)) return;
    end_.emplace(file, std::string(group) + "/end", ScalarType::uint64, std::vector<hsize_t>{});
    for (const ColumnOf<Row>& column : columns_of<Row>()) {
      std::vector<hsize_t> row_shape;
      if (column.width > 1) row_shape.push_back(column.width);
      const std::string path = std::string(group) + "/" + column_in_version(column.name, version);
      if (version < format_version && !file.has_item(path)) continue;
      columns_.push_back({column, ColumnReader(file, path, column.type, std::move(row_shape))});
    }
    check_ends(frames);
  }

  std::vector<Row> rows(std::uint64_t frame) {
    if (!end_) return {};
    const std::uint64_t first = frame == 0 ? 0 : end_of(frame - 1);
    std::vector<Row> rows(end_of(frame) - first);
    for (auto& [column, reader] : columns_) {
      bytes_.resize(rows.size() * column.bytes());
      reader.read(first, rows.size(), bytes_.data());
      for (std::size_t i = 0; i < rows.size(); ++i) column.load(rows[i], bytes_.data() + i * column.bytes());
    }
    return rows;
  }

  /// Reports a bad value in a row of the frame.
  [[noreturn]] void fail(std::uint64_t frame, std::size_t row, const char* column, std::uint64_t value,
                         std::uint64_t allowed) {
    for (const auto& [of, reader] : columns_) {
      if (!reader.path().ends_with(std::string("/") + column)) continue;
      file_->fail(reader.path(), "row " + std::to_string(row) + " of frame " + std::to_string(frame) +
                                     " is " + std::to_string(value) + ", not below " +
                                     std::to_string(allowed) + damaged);
    }
    file_->fail(end_->path(), "is damaged; record again");
  }

 private:
  std::uint64_t end_of(std::uint64_t frame) {
    std::uint64_t end = 0;
    end_->read(frame, 1, reinterpret_cast<std::byte*>(&end));
    return end;
  }

  void check_ends(std::uint64_t frames) {
    std::uint64_t last = 0;
    for (std::uint64_t frame = 0; frame < frames; ++frame) {
      const std::uint64_t end = end_of(frame);
      if (end < last)
        file_->fail(end_->path(), "frame " + std::to_string(frame) + " ends at row " + std::to_string(end) +
                                      ", before the frame before it, which ends at " + std::to_string(last) +
                                      damaged);
      last = end;
    }
    for (const auto& [of, reader] : columns_) {
      if (reader.rows() < last)
        file_->fail(reader.path(), "has " + std::to_string(reader.rows()) + " rows, the frames name " +
                                       std::to_string(last) + damaged);
    }
  }

  const InputFile* file_;
  std::optional<ColumnReader> end_;  ///< empty: the file lacks the group
  struct Column {
    ColumnOf<Row> of;
    ColumnReader reader;
  };
  std::vector<Column> columns_;  ///< the columns that the file has
  std::vector<std::byte> bytes_;
};

/// Turns errors of HDF5 and of the system into an `Error` that names the file.
template <class Function>
auto with_errors_of(const std::string& path, Function function) {
  const QuietErrors quiet;
  try {
    return function();
  } catch (const Hdf5Failure&) {
    throw Error(path + ": cannot be read; it is damaged, copy it again or record again");
  } catch (const std::bad_alloc&) {
    throw Error(path + ": does not fit into memory, or is damaged; copy it again or record again");
  } catch (const std::length_error&) {
    throw Error(path + ": is damaged; copy it again or record again");
  }
}

}  // namespace

class Recording::Implementation {
 public:
  explicit Implementation(const std::string& path);

  RecordedFrame frame(std::uint64_t number);
  RecordedFrame summary(std::uint64_t number);
  std::vector<Vec3d> positions(std::uint64_t frame, std::size_t object);
  const RecordingHeader& header() const { return header_; }
  std::uint64_t frame_count() const { return time_.rows(); }
  const std::string& path() const { return file_.path(); }

 private:
  void check_frame(std::uint64_t number) const;
  std::vector<ObjectPair> pairs(RaggedReader<ObjectPair>& reader, std::uint64_t frame) const {
    return rows_of_objects(reader, frame, [](std::size_t, const ObjectPair&) {});
  }
  void check_elements(std::uint64_t frame, std::size_t row, const ContinuousContact& contact);
  std::vector<Contact> contacts(std::uint64_t frame, std::size_t points);
  std::vector<ContactPoint> contact_points(std::uint64_t frame);
  std::vector<ContinuousContact> continuous_contacts(std::uint64_t frame);
  std::vector<ProximityPair> proximity_pairs(std::uint64_t frame);
  std::vector<PenetrationGroup> penetration_groups(std::uint64_t frame, const RecordedFrame& lists);
  std::vector<Penetration> penetrations(std::uint64_t frame);
  std::vector<ContainedPart> contained_parts(std::uint64_t frame);
  std::vector<IntersectionCurve> curves(std::uint64_t frame, const RecordedFrame& lists);
  std::vector<std::uint32_t> curve_contacts(std::uint64_t frame, std::size_t contacts);
  std::vector<CollidingVertices> colliding_vertex_groups(std::uint64_t frame,
                                                         std::span<const std::uint32_t> vertices);
  StepStats stats(std::uint64_t frame);

  template <class Row>
  void check_below(RaggedReader<Row>& rows, std::uint64_t frame, std::size_t row, const char* column,
                   std::uint64_t value, std::uint64_t allowed) const {
    if (value >= allowed) rows.fail(frame, row, column, value, allowed);
  }

  /// A value and its column.
  struct Named {
    const char* column;
    std::uint64_t value;
  };
  /// Checks a range of a list of `size` rows.
  template <class Row>
  void check_range(RaggedReader<Row>& rows, std::uint64_t frame, std::size_t row, Named count, Named first,
                   std::size_t size) const {
    check_below(rows, frame, row, count.column, count.value, size + 1);
    check_below(rows, frame, row, first.column, first.value, size - count.value + 1);
  }
  /// Checks two ranges of such a list, one after the other.
  template <class Row>
  void check_two_ranges(RaggedReader<Row>& rows, std::uint64_t frame, std::size_t row, Named count_a,
                        Named count_b, Named first, std::size_t size) const {
    check_below(rows, frame, row, count_a.column, count_a.value, size + 1);
    check_range(rows, frame, row, count_b, first, size - count_a.value);
  }
  /// Checks a range of a list of vertices of one object, which is given by its index.
  void check_vertices(RaggedReader<std::uint32_t>& rows, std::uint64_t frame,
                      std::span<const std::uint32_t> vertices, std::size_t first, std::size_t count,
                      ObjectId object) const {
    for (std::size_t i = first; i < first + count; ++i)
      check_below(rows, frame, i, "vertex", vertices[i], header_.objects[object.index].rest_positions.size());
  }

  /// Reads rows that refer to objects by index. Calls `check(number, row)`, then replaces indices by ids.
  template <class Row, class Check>
  std::vector<Row> rows_of_objects(RaggedReader<Row>& reader, std::uint64_t frame, Check check) const {
    const std::vector<RecordedObject>& objects = header_.objects;
    std::vector<Row> rows = reader.rows(frame);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      auto [a, b] = objects_of(rows[i]);
      check_below(reader, frame, i, "object_a", a.index, objects.size());
      check_below(reader, frame, i, "object_b", b.index, objects.size());
      check(i, rows[i]);
      a = objects[a.index].id;
      b = objects[b.index].id;
    }
    return rows;
  }

  InputFile file_;
  std::uint32_t version_;
  RecordingHeader header_;
  ColumnReader time_;
  RaggedReader<ObjectPair> object_pairs_;
  RaggedReader<Contact> contacts_;
  RaggedReader<ContactPoint> contact_points_;
  RaggedReader<ContinuousContact> continuous_contacts_;
  RaggedReader<ProximityPair> proximity_pairs_;
  RaggedReader<PenetrationGroup> penetration_groups_;
  RaggedReader<Penetration> penetrations_;
  RaggedReader<std::uint32_t> vertices_on_surface_;
  RaggedReader<ContainedPart> contained_parts_;
  RaggedReader<IntersectionCurve> curves_;
  RaggedReader<CurveContact> curve_contacts_;
  RaggedReader<Vec3d> curve_points_;
  RaggedReader<std::uint32_t> enclosed_vertices_;
  RaggedReader<CollidingVertices> colliding_vertex_groups_;
  RaggedReader<std::uint32_t> colliding_vertices_;
  RaggedReader<ObjectPair> volume_begin_, volume_end_, narrow_phase_begin_, narrow_phase_end_, contact_begin_,
      contact_end_, proximity_begin_, proximity_end_, penetration_begin_, penetration_end_;
  std::vector<std::optional<ColumnReader>>
      statistics_;  ///< in the order of `StepStats`; empty if the file lacks it
  std::vector<ColumnReader> positions_;
};

Recording::Implementation::Implementation(const std::string& path)
    : file_(path),
      version_(check_format(file_)),
      header_(read_header(file_, version_)),
      time_(file_, "time", ScalarType::float64, {}),
      object_pairs_(file_, version_, group_names::object_pairs, frame_count()),
      contacts_(file_, version_, group_names::contacts, frame_count()),
      contact_points_(file_, version_, group_names::contact_points, frame_count()),
      continuous_contacts_(file_, version_, group_names::continuous_contacts, frame_count()),
      proximity_pairs_(file_, version_, group_names::proximity_pairs, frame_count(), true),
      penetration_groups_(file_, version_, group_names::penetration_groups, frame_count(), true),
      penetrations_(file_, version_, group_names::penetrations, frame_count(), true),
      vertices_on_surface_(file_, version_, group_names::vertices_on_surface, frame_count(), true),
      contained_parts_(file_, version_, group_names::contained_parts, frame_count(), true),
      curves_(file_, version_, group_names::curves, frame_count(), true),
      curve_contacts_(file_, version_, group_names::curve_contacts, frame_count(), true),
      curve_points_(file_, version_, group_names::curve_points, frame_count(), true),
      enclosed_vertices_(file_, version_, group_names::enclosed_vertices, frame_count(), true),
      colliding_vertex_groups_(file_, version_, group_names::colliding_vertex_groups, frame_count(), true),
      colliding_vertices_(file_, version_, group_names::colliding_vertices, frame_count(), true),
      volume_begin_(file_, version_, group_names::volume_begin, frame_count()),
      volume_end_(file_, version_, group_names::volume_end, frame_count()),
      narrow_phase_begin_(file_, version_, group_names::narrow_phase_begin, frame_count(), true),
      narrow_phase_end_(file_, version_, group_names::narrow_phase_end, frame_count(), true),
      contact_begin_(file_, version_, group_names::contact_begin, frame_count()),
      contact_end_(file_, version_, group_names::contact_end, frame_count()),
      proximity_begin_(file_, version_, group_names::proximity_begin, frame_count(), true),
      proximity_end_(file_, version_, group_names::proximity_end, frame_count(), true),
      penetration_begin_(file_, version_, group_names::penetration_begin, frame_count(), true),
      penetration_end_(file_, version_, group_names::penetration_end, frame_count(), true) {
  const auto check_frames = [this](const ColumnReader& column, std::uint64_t needed) {
    if (column.rows() < needed)
      file_.fail(column.path(), "has " + std::to_string(column.rows()) + " frames, the recording has " +
                                    std::to_string(frame_count()) + damaged);
  };
  for (const ColumnOf<StepStats>& column : columns_of<StepStats>()) {
    const std::string dataset =
        std::string(group_names::statistics) + "/" + column_in_version(column.name, version_);
    statistics_.emplace_back();
    if (!file_.has_item(dataset)) continue;  // files of earlier programs lack it
    statistics_.back().emplace(file_, dataset, column.type, std::vector<hsize_t>{});
    check_frames(*statistics_.back(), frame_count());
  }
  for (std::size_t place = 0; place < header_.objects.size(); ++place) {
    const RecordedObject& object = header_.objects[place];
    positions_.emplace_back(file_, object_path(place) + "/positions", ScalarType::float64,
                            std::vector<hsize_t>{object.rest_positions.size(), 3});
    check_frames(positions_.back(),
                 object.options.is_static ? std::min<std::uint64_t>(frame_count(), 1) : frame_count());
  }
}

void Recording::Implementation::check_frame(std::uint64_t number) const {
  if (number >= frame_count())
    throw Error(path() + ": there is no frame " + std::to_string(number) + "; the recording has " +
                std::to_string(frame_count()) + ", counted from 0");
}

std::vector<Contact> Recording::Implementation::contacts(std::uint64_t frame, std::size_t points) {
  const auto check = [&](std::size_t row, const Contact& c) {
    const auto check_value = [&](const char* column, std::uint64_t value, std::uint64_t allowed) {
      check_below(contacts_, frame, row, column, value, allowed);
    };
    check_value("triangle_a", c.triangle_a, header_.objects[c.object_a.index].triangles.size());
    check_value("triangle_b", c.triangle_b, header_.objects[c.object_b.index].triangles.size());
    check_value("kind", static_cast<std::uint64_t>(c.kind), 3);
    if (points > 0) {
      check_value("point_count", c.point_count, points + 1);
      check_value("first_point", c.first_point, points - c.point_count + 1);
    }
  };
  return rows_of_objects(contacts_, frame, check);
}

std::vector<ContactPoint> Recording::Implementation::contact_points(std::uint64_t frame) {
  std::vector<ContactPoint> points = contact_points_.rows(frame);
  for (std::size_t i = 0; i < points.size(); ++i) {
    check_below(contact_points_, frame, i, "feature_a", static_cast<std::uint64_t>(points[i].on_a.kind), 3);
    check_below(contact_points_, frame, i, "feature_b", static_cast<std::uint64_t>(points[i].on_b.kind), 3);
    check_below(contact_points_, frame, i, "feature_index_a", points[i].on_a.index, 3);
    check_below(contact_points_, frame, i, "feature_index_b", points[i].on_b.index, 3);
  }
  return points;
}

void Recording::Implementation::check_elements(std::uint64_t frame, std::size_t row,
                                               const ContinuousContact& contact) {
  const auto check_element = [&](const char* column, ObjectId object,
                                 const std::array<std::uint32_t, 2>& element, bool is_face) {
    const RecordedObject& of = header_.objects[object.index];
    const std::size_t allowed = is_face ? of.triangles.size() : of.rest_positions.size();
    for (const std::uint32_t number : element)
      check_below(continuous_contacts_, frame, row, column, number, allowed);
  };
  const auto [kind_a, kind_b] = feature_kinds(contact.kind);
  check_element("element_a", contact.object_a, contact.element_a, kind_a == FeatureKind::face);
  check_element("element_b", contact.object_b, contact.element_b, kind_b == FeatureKind::face);
}

std::vector<ContinuousContact> Recording::Implementation::continuous_contacts(std::uint64_t frame) {
  const auto check = [&](std::size_t row, const ContinuousContact& c) {
    check_below(continuous_contacts_, frame, row, "kind", static_cast<std::uint64_t>(c.kind),
                words<ElementPairKind>.size());
    check_below(continuous_contacts_, frame, row, "certainty", static_cast<std::uint64_t>(c.certainty), 2);
    check_elements(frame, row, c);
  };
  return rows_of_objects(continuous_contacts_, frame, check);
}

std::vector<ProximityPair> Recording::Implementation::proximity_pairs(std::uint64_t frame) {
  const auto check = [&](std::size_t row, const ProximityPair& p) {
    const auto check_value = [&](const char* column, std::uint64_t value, std::uint64_t allowed) {
      check_below(proximity_pairs_, frame, row, column, value, allowed);
    };
    const auto check_element = [&](const char* column, ObjectId object, FeatureKind kind,
                                   const std::array<std::uint32_t, 2>& element) {
      const RecordedObject& of = header_.objects[object.index];
      for (const std::uint32_t number : element)
        check_value(column, number,
                    kind == FeatureKind::face ? of.triangles.size() : of.rest_positions.size());
    };
    check_value("kind_a", static_cast<std::uint64_t>(p.kind_a), 3);
    check_value("kind_b", static_cast<std::uint64_t>(p.kind_b), 3);
    check_element("element_a", p.object_a, p.kind_a, p.element_a);
    check_element("element_b", p.object_b, p.kind_b, p.element_b);
    check_value("feature_a", static_cast<std::uint64_t>(p.on_a.kind), 3);
    check_value("feature_b", static_cast<std::uint64_t>(p.on_b.kind), 3);
    check_value("feature_index_a", p.on_a.index, 3);
    check_value("feature_index_b", p.on_b.index, 3);
  };
  return rows_of_objects(proximity_pairs_, frame, check);
}

std::vector<Penetration> Recording::Implementation::penetrations(std::uint64_t frame) {
  const auto check = [&](std::size_t row, const Penetration& p) {
    const auto check_value = [&](const char* column, std::uint64_t value, std::uint64_t allowed) {
      check_below(penetrations_, frame, row, column, value, allowed);
    };
    check_value("vertex", p.vertex, header_.objects[p.object_a.index].rest_positions.size());
    check_value("triangle", p.triangle, header_.objects[p.object_b.index].triangles.size());
    check_value("feature", static_cast<std::uint64_t>(p.feature.kind), 3);
    check_value("feature_index", p.feature.index, 3);
  };
  return rows_of_objects(penetrations_, frame, check);
}

std::vector<PenetrationGroup> Recording::Implementation::penetration_groups(std::uint64_t frame,
                                                                            const RecordedFrame& lists) {
  const auto check = [&](std::size_t row, const PenetrationGroup& group) {
    check_range(penetration_groups_, frame, row, {"penetration_count", group.penetration_count},
                {"first_penetration", group.first_penetration}, lists.penetrations.size());
    check_range(penetration_groups_, frame, row, {"on_surface_count", group.on_surface_count},
                {"first_on_surface", group.first_on_surface}, lists.vertices_on_surface.size());
    check_vertices(vertices_on_surface_, frame, lists.vertices_on_surface, group.first_on_surface,
                   group.on_surface_count, group.a);
  };
  return rows_of_objects(penetration_groups_, frame, check);
}

std::vector<ContainedPart> Recording::Implementation::contained_parts(std::uint64_t frame) {
  const auto check = [&](std::size_t row, const ContainedPart& part) {
    const std::size_t vertices = header_.objects[part.inner.index].rest_positions.size();
    check_below(contained_parts_, frame, row, "vertex", part.vertex, vertices);
    check_below(contained_parts_, frame, row, "vertex_count", part.vertex_count, vertices + 1);
  };
  return rows_of_objects(contained_parts_, frame, check);
}

std::vector<std::uint32_t> Recording::Implementation::curve_contacts(std::uint64_t frame,
                                                                     std::size_t contacts) {
  std::vector<std::uint32_t> numbers;
  for (const CurveContact& row : curve_contacts_.rows(frame)) {
    check_below(curve_contacts_, frame, numbers.size(), "contact", row.contact, contacts);
    numbers.push_back(row.contact);
  }
  return numbers;
}

std::vector<IntersectionCurve> Recording::Implementation::curves(std::uint64_t frame,
                                                                 const RecordedFrame& lists) {
  const auto check = [&](std::size_t row, const IntersectionCurve& curve) {
    check_below(curves_, frame, row, "kind", static_cast<std::uint64_t>(curve.kind), words<CurveKind>.size());
    check_range(curves_, frame, row, {"contact_count", curve.contact_count},
                {"first_contact", curve.first_contact}, lists.curve_contacts.size());
    check_range(curves_, frame, row, {"point_count", curve.point_count}, {"first_point", curve.first_point},
                lists.curve_points.size());
    check_two_ranges(curves_, frame, row, {"enclosed_count_a", curve.enclosed_count_a},
                     {"enclosed_count_b", curve.enclosed_count_b}, {"first_enclosed", curve.first_enclosed},
                     lists.enclosed_vertices.size());
    check_vertices(enclosed_vertices_, frame, lists.enclosed_vertices, curve.first_enclosed,
                   curve.enclosed_count_a, curve.a);
    check_vertices(enclosed_vertices_, frame, lists.enclosed_vertices,
                   std::size_t{curve.first_enclosed} + curve.enclosed_count_a, curve.enclosed_count_b,
                   curve.b);
  };
  return rows_of_objects(curves_, frame, check);
}

std::vector<CollidingVertices> Recording::Implementation::colliding_vertex_groups(
    std::uint64_t frame, std::span<const std::uint32_t> vertices) {
  const auto check = [&](std::size_t row, const CollidingVertices& group) {
    check_two_ranges(colliding_vertex_groups_, frame, row, {"count_a", group.count_a},
                     {"count_b", group.count_b}, {"first_vertex", group.first_vertex}, vertices.size());
    check_vertices(colliding_vertices_, frame, vertices, group.first_vertex, group.count_a, group.a);
    check_vertices(colliding_vertices_, frame, vertices, std::size_t{group.first_vertex} + group.count_a,
                   group.count_b, group.b);
  };
  return rows_of_objects(colliding_vertex_groups_, frame, check);
}

StepStats Recording::Implementation::stats(std::uint64_t frame) {
  StepStats stats;
  for (std::size_t c = 0; c < statistics_.size(); ++c) {
    if (!statistics_[c]) continue;
    std::array<std::byte, 8> bytes{};
    statistics_[c]->read(frame, 1, bytes.data());
    columns_of<StepStats>()[c].load(stats, bytes.data());
  }
  for_each_leaf(
      [&](const auto& field, const auto& value) {
        if constexpr (Worded<std::remove_cvref_t<decltype(value)>>) {
          if (word_of(value) == nullptr)
            file_.fail(std::string(group_names::statistics) + "/" + field.key,
                       "row " + std::to_string(frame) + " is " +
                           std::to_string(static_cast<unsigned>(value)) + ", not below " +
                           std::to_string(words<std::remove_cvref_t<decltype(value)>>.size()) + damaged);
        }
      },
      stats);
  return stats;
}

RecordedFrame Recording::Implementation::summary(std::uint64_t number) {
  check_frame(number);
  RecordedFrame frame;
  time_.read(number, 1, reinterpret_cast<std::byte*>(&frame.time));
  frame.volume_begin = pairs(volume_begin_, number);
  frame.volume_end = pairs(volume_end_, number);
  frame.narrow_phase_begin = pairs(narrow_phase_begin_, number);
  frame.narrow_phase_end = pairs(narrow_phase_end_, number);
  frame.contact_begin = pairs(contact_begin_, number);
  frame.contact_end = pairs(contact_end_, number);
  frame.proximity_begin = pairs(proximity_begin_, number);
  frame.proximity_end = pairs(proximity_end_, number);
  frame.penetration_begin = pairs(penetration_begin_, number);
  frame.penetration_end = pairs(penetration_end_, number);
  frame.stats = stats(number);
  return frame;
}

RecordedFrame Recording::Implementation::frame(std::uint64_t number) {
  RecordedFrame frame = summary(number);
  frame.object_pairs = pairs(object_pairs_, number);
  frame.contact_points = contact_points(number);
  frame.contacts = contacts(number, frame.contact_points.size());
  frame.continuous_contacts = continuous_contacts(number);
  frame.proximity_pairs = proximity_pairs(number);
  frame.penetrations = penetrations(number);
  frame.vertices_on_surface = vertices_on_surface_.rows(number);
  frame.penetration_groups = penetration_groups(number, frame);
  frame.contained_parts = contained_parts(number);
  frame.curve_contacts = curve_contacts(number, frame.contacts.size());
  frame.curve_points = curve_points_.rows(number);
  frame.enclosed_vertices = enclosed_vertices_.rows(number);
  frame.curves = curves(number, frame);
  frame.colliding_vertices = colliding_vertices_.rows(number);
  frame.colliding_vertex_groups = colliding_vertex_groups(number, frame.colliding_vertices);
  return frame;
}

std::vector<Vec3d> Recording::Implementation::positions(std::uint64_t frame, std::size_t object) {
  check_frame(frame);
  if (object >= positions_.size())
    throw Error(path() + ": there is no object " + std::to_string(object) + "; the recording has " +
                std::to_string(positions_.size()) + ", counted from 0");
  std::vector<Vec3d> positions(header_.objects[object].rest_positions.size());
  const std::uint64_t row = header_.objects[object].options.is_static ? 0 : frame;
  positions_[object].read(row, 1, reinterpret_cast<std::byte*>(positions.data()));
  return positions;
}

Recording::Recording(const std::filesystem::path& path)
    : implementation_(
          with_errors_of(path.string(), [&] { return std::make_unique<Implementation>(path.string()); })) {}
Recording::~Recording() = default;
Recording::Recording(Recording&&) noexcept = default;
Recording& Recording::operator=(Recording&&) noexcept = default;

const RecordingHeader& Recording::header() const {
  return implementation_->header();
}
std::uint64_t Recording::frame_count() const {
  return implementation_->frame_count();
}
RecordedFrame Recording::frame(std::uint64_t number) const {
  return with_errors_of(implementation_->path(), [&] { return implementation_->frame(number); });
}
RecordedFrame Recording::summary(std::uint64_t number) const {
  return with_errors_of(implementation_->path(), [&] { return implementation_->summary(number); });
}
std::vector<Vec3d> Recording::positions(std::uint64_t frame, std::size_t object) const {
  return with_errors_of(implementation_->path(), [&] { return implementation_->positions(frame, object); });
}

}  // namespace supple
