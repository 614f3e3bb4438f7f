#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <new>
#include <optional>
#include <system_error>
#include <tuple>
#include <utility>

#include "commit_driver.hpp"
#include "hdf5_write.hpp"
#include "layout.hpp"
#include "supple/error.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/recording.hpp"
#include "supple/version.hpp"
#include "xdmf_file.hpp"

namespace supple {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto flush_interval = std::chrono::seconds(1);
/// The maximum number of bytes that wait for a flush.
constexpr std::size_t most_pending_bytes = std::size_t{32} << 20;
/// The bytes of a column that wait for more rows. The memory of a recording then depends neither on the
/// number of contacts nor on how many frames a second has.
constexpr std::size_t most_pending_bytes_of_column = std::size_t{128} << 10;
constexpr std::size_t frames_in_chunk = 1024;
constexpr std::size_t rows_in_chunk = 4096;

/// Maps object ids of results to indices in the file.
class Places {
 public:
  explicit Places(const std::vector<RecordedObject>& objects) {
    for (std::size_t place = 0; place < objects.size(); ++place) {
      const ObjectId id = objects[place].id;
      if (id.index >= by_index_.size()) by_index_.resize(id.index + std::size_t{1});
      if (by_index_[id.index])
        throw Error("objects " + std::to_string(by_index_[id.index]->place) + " and " +
                    std::to_string(place) + " of a recording have the same id; give each its own");
      by_index_[id.index] = Entry{id.generation, static_cast<std::uint32_t>(place)};
    }
  }

  ObjectId operator()(ObjectId id) const {
    if (id.index >= by_index_.size() || !by_index_[id.index] ||
        by_index_[id.index]->generation != id.generation)
      throw Error("a result names object " + std::to_string(id.index) + " of generation " +
                  std::to_string(id.generation) +
                  ", which the recording's header does not have; list every object");
    return {by_index_[id.index]->place, 0};
  }

 private:
  struct Entry {
    std::uint32_t generation = 0, place = 0;
  };
  std::vector<std::optional<Entry>> by_index_;
};

template <class Row>
std::vector<Row> with_places(std::span<const Row> rows, const Places& place_of) {
  std::vector<Row> result(rows.begin(), rows.end());
  for (Row& row : result) {
    auto [a, b] = objects_of(row);
    a = place_of(a);
    b = place_of(b);
  }
  return result;
}

template <class Row>
std::vector<ColumnWriter> create_columns(hid_t file, const char* group, std::size_t chunk_rows) {
  create_group(file, group);
  std::vector<ColumnWriter> columns;
  for (const ColumnOf<Row>& column : columns_of<Row>())
    columns.emplace_back(file, std::string(group) + "/" + column.name, column.type, column.width, chunk_rows);
  return columns;
}

template <class Row>
void append_rows(std::vector<ColumnWriter>& columns, std::span<const Row> rows) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const ColumnOf<Row>& column = columns_of<Row>()[c];
    std::byte* to = columns[c].append(rows.size());
    for (const Row& row : rows) {
      column.store(row, to);
      to += column.bytes();
    }
  }
}

/// A group with any number of rows per frame, and the end of each frame.
template <class Row>
class RaggedWriter {
 public:
  RaggedWriter(hid_t file, const char* group)
      : columns_(create_columns<Row>(file, group, rows_in_chunk)),
        end_(file, std::string(group) + "/end", ScalarType::uint64, 1, frames_in_chunk) {}

  void append(std::span<const Row> rows) {
    append_rows(columns_, rows);
    rows_ += rows.size();
    end_.append_value(&rows_);
  }
  template <class Function>
  void for_each_column(Function function) {
    for (ColumnWriter& column : columns_) function(column);
    function(end_);
  }

 private:
  std::vector<ColumnWriter> columns_;
  ColumnWriter end_;
  std::uint64_t rows_ = 0;
};

/// One attribute per option, except the options of the machine.
template <class Options>
void write_options(hid_t file, const std::string& group, const Options& options) {
  for_each_leaf(
      [&](const auto& field, const auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if (field.is_of_machine) return;
        if constexpr (Worded<Value>) {
          write_attribute(file, group, field.key, std::string(word_of(value)));
        } else if constexpr (std::is_same_v<Value, std::optional<RootCube>>) {
          if (!value) return;
          const auto& [corner, edge] = *value;
          write_attribute(file, group, field.key, std::array{corner.x, corner.y, corner.z, edge});
        } else {
          if constexpr (std::is_same_v<Value, bool>) {
            if (field.has_truth_words())
              return write_attribute(file, group, field.key, std::string(field.truth_words[value ? 1 : 0]));
          }
          write_attribute(file, group, field.key, value);
        }
      },
      options);
}

void write_header(hid_t file, const RecordingHeader& header) {
  const auto attribute = [file](const char* name, auto value) { write_attribute(file, "/", name, value); };
  attribute("format", std::string(format_name));
  attribute("version", format_version);
  attribute("program_version", std::string(SUPPLE_VERSION));
  attribute("time_step", header.time_step);
  write_options(file, "/", header.scene);
  write_text(file, "scene_file", header.scene_file);
}

PositionsWriter write_object(hid_t file, std::size_t place, const RecordedObject& object) {
  const std::string path = object_path(place);
  create_group(file, path);
  const auto attribute = [&](const char* name, auto value) { write_attribute(file, path, name, value); };
  attribute("id_index", object.id.index);
  attribute("id_generation", object.id.generation);
  write_options(file, path, object.options);
  write_rows(file, path + "/rest_positions", ScalarType::float64, object.rest_positions.size(), 3,
             object.rest_positions.data());
  write_rows(file, path + "/triangles", ScalarType::uint32, object.triangles.size(), 3,
             object.triangles.data());
  const auto& [edges, points] = std::tie(object.options.edges, object.options.points);
  if (!edges.empty()) write_rows(file, path + "/edges", ScalarType::uint32, edges.size(), 2, edges.data());
  if (!points.empty())
    write_rows(file, path + "/points", ScalarType::uint32, points.size(), 0, points.data());
  return {file, path + "/positions", object.rest_positions.size()};
}

void check_header(const RecordingHeader& header) {
  for (std::size_t place = 0; place < header.objects.size(); ++place) {
    const RecordedObject& object = header.objects[place];
    const auto check = [&](const char* what, std::size_t i, std::span<const std::uint32_t> vertices) {
      for (const std::uint32_t vertex : vertices) {
        if (vertex >= object.rest_positions.size())
          throw Error(std::string(what) + " " + std::to_string(i) + " of object " + std::to_string(place) +
                      " of a recording uses vertex " + std::to_string(vertex) + " of " +
                      std::to_string(object.rest_positions.size()) + "; give the mesh that the scene has");
      }
    };
    const auto& [edges, points] = std::tie(object.options.edges, object.options.points);
    for (std::size_t t = 0; t < object.triangles.size(); ++t) check("triangle", t, object.triangles[t]);
    for (std::size_t i = 0; i < edges.size(); ++i) check("edge", i, edges[i]);
    for (std::size_t i = 0; i < points.size(); ++i) check("point", i, {&points[i], 1});
  }
}

/// The growing datasets of a file, and their unwritten rows.
struct Datasets {
  Datasets(hid_t file, const RecordingHeader& header) {
    write_header(file, header);
    create_group(file, "objects");
    for (std::size_t place = 0; place < header.objects.size(); ++place)
      positions.push_back(write_object(file, place, header.objects[place]));
    object_pairs.emplace(file, group_names::object_pairs);
    contacts.emplace(file, group_names::contacts);
    contact_points.emplace(file, group_names::contact_points);
    continuous_contacts.emplace(file, group_names::continuous_contacts);
    proximity_pairs.emplace(file, group_names::proximity_pairs);
    penetration_groups.emplace(file, group_names::penetration_groups);
    penetrations.emplace(file, group_names::penetrations);
    vertices_on_surface.emplace(file, group_names::vertices_on_surface);
    contained_parts.emplace(file, group_names::contained_parts);
    curves.emplace(file, group_names::curves);
    curve_contacts.emplace(file, group_names::curve_contacts);
    curve_points.emplace(file, group_names::curve_points);
    enclosed_vertices.emplace(file, group_names::enclosed_vertices);
    colliding_vertex_groups.emplace(file, group_names::colliding_vertex_groups);
    colliding_vertices.emplace(file, group_names::colliding_vertices);
    create_group(file, "events");
    for (const char* name :
         {group_names::volume_begin, group_names::volume_end, group_names::narrow_phase_begin,
          group_names::narrow_phase_end, group_names::contact_begin, group_names::contact_end,
          group_names::proximity_begin, group_names::proximity_end, group_names::penetration_begin,
          group_names::penetration_end})
      events.emplace_back(file, name);
    statistics = create_columns<StepStats>(file, group_names::statistics, frames_in_chunk);
    // `time` is created last, so it grows last: a frame exists when its time exists.
    time.emplace(file, "time", ScalarType::float64, 1, frames_in_chunk);
  }

  template <class Function>
  void for_each_column(Function function) {
    object_pairs->for_each_column(function);
    contacts->for_each_column(function);
    contact_points->for_each_column(function);
    continuous_contacts->for_each_column(function);
    proximity_pairs->for_each_column(function);
    penetration_groups->for_each_column(function);
    penetrations->for_each_column(function);
    vertices_on_surface->for_each_column(function);
    contained_parts->for_each_column(function);
    curves->for_each_column(function);
    curve_contacts->for_each_column(function);
    curve_points->for_each_column(function);
    enclosed_vertices->for_each_column(function);
    colliding_vertex_groups->for_each_column(function);
    colliding_vertices->for_each_column(function);
    for (RaggedWriter<ObjectPair>& pairs : events) pairs.for_each_column(function);
    for (ColumnWriter& column : statistics) function(column);
    function(*time);
  }

  std::vector<PositionsWriter> positions;
  std::optional<RaggedWriter<ObjectPair>> object_pairs;
  std::optional<RaggedWriter<Contact>> contacts;
  std::optional<RaggedWriter<ContactPoint>> contact_points;
  std::optional<RaggedWriter<ContinuousContact>> continuous_contacts;
  std::optional<RaggedWriter<ProximityPair>> proximity_pairs;
  std::optional<RaggedWriter<PenetrationGroup>> penetration_groups;
  std::optional<RaggedWriter<Penetration>> penetrations;
  std::optional<RaggedWriter<std::uint32_t>> vertices_on_surface;
  std::optional<RaggedWriter<ContainedPart>> contained_parts;
  std::optional<RaggedWriter<IntersectionCurve>> curves;
  std::optional<RaggedWriter<CurveContact>> curve_contacts;
  std::optional<RaggedWriter<Vec3d>> curve_points;
  std::optional<RaggedWriter<std::uint32_t>> enclosed_vertices;
  std::optional<RaggedWriter<CollidingVertices>> colliding_vertex_groups;
  std::optional<RaggedWriter<std::uint32_t>> colliding_vertices;
  /// Begin and end of volume overlaps, then of the narrow phase, of contacts, of proximity and of
  /// penetration.
  std::vector<RaggedWriter<ObjectPair>> events;
  std::vector<ColumnWriter> statistics;
  std::optional<ColumnWriter> time;
};

void check_writes(hid_t file) {
  if (write_error(file) != 0) throw Hdf5Failure();
}

void flush_file(hid_t file) {
  check(H5Fflush(file, H5F_SCOPE_LOCAL));
  check_writes(file);
}

[[noreturn]] void fail_to_create(const fs::path& path, int error) {
  throw Error(path.string() + ": cannot write: " + std::strerror(error) +
              "; choose a file in a folder that exists and is yours");
}

/// Follows symbolic links, so that a link stays a link.
fs::path final_path(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return path;
  if (!fs::is_regular_file(path, error)) throw Error(path.string() + ": is no regular file; record to one");
  return fs::is_symlink(path, error) ? fs::canonical(path) : path;
}

fs::path xdmf_path(const fs::path& path) {
  fs::path result = path;
  result.replace_extension(".xdmf");
  if (result == path)
    throw Error(path.string() +
                ": the XDMF file of the recording would have the same name; use a name that ends in .h5");
  return result;
}

}  // namespace

class Recorder::Implementation {
 public:
  Implementation(const fs::path& path, const RecordingHeader& header);
  ~Implementation() {
    try {
      close();
    } catch (const std::exception&) {
    }
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  void add(double time, std::span<const std::span<const Vec3d>> positions, const DetectResult& result);
  void flush();
  void close();

 private:
  struct Object {
    std::size_t vertices = 0;
    bool is_static = false;
    std::vector<Vec3d> first_positions;  ///< of a static object
  };
  struct Rows;

  void create(const RecordingHeader& header);
  void check_open() const;
  void check_positions(std::span<const std::span<const Vec3d>> positions) const;
  void append(double time, std::span<const std::span<const Vec3d>> positions, const Rows& rows);
  bool flush_is_due();
  std::size_t pending_bytes();
  void write_long_columns();
  void write_out();
  void abandon();
  [[noreturn]] void stop();

  fs::path path_;
  Places place_of_;
  std::vector<Object> objects_;
  FileHandle file_;
  std::optional<Datasets> datasets_;
  std::optional<XdmfFile> xdmf_;
  std::uint64_t frames_ = 0, flushed_frames_ = 0;
  Clock::time_point last_flush_ = Clock::now();
  std::string failure_;  ///< why recording stopped; empty while it works
  bool closed_ = false;
};

/// The rows of a frame, with indices instead of ids.
struct Recorder::Implementation::Rows {
  Rows(const DetectResult& result, const Places& place_of)
      : object_pairs(with_places(result.object_pairs, place_of)),
        contacts(with_places(result.contacts, place_of)),
        contact_points(result.contact_points),
        continuous_contacts(with_places(result.continuous_contacts, place_of)),
        proximity_pairs(with_places(result.proximity_pairs, place_of)),
        penetration_groups(with_places(result.penetration_groups, place_of)),
        penetrations(with_places(result.penetrations, place_of)),
        vertices_on_surface(result.vertices_on_surface),
        contained_parts(with_places(result.contained_parts, place_of)),
        curves(with_places(result.curves, place_of)),
        curve_contacts(result.curve_contacts.begin(), result.curve_contacts.end()),
        curve_points(result.curve_points),
        enclosed_vertices(result.enclosed_vertices),
        colliding_vertex_groups(with_places(result.colliding_vertex_groups, place_of)),
        colliding_vertices(result.colliding_vertices),
        events{with_places(result.volume_events.begin, place_of),
               with_places(result.volume_events.end, place_of),
               with_places(result.narrow_phase_events.begin, place_of),
               with_places(result.narrow_phase_events.end, place_of),
               with_places(result.contact_events.begin, place_of),
               with_places(result.contact_events.end, place_of),
               with_places(result.proximity_events.begin, place_of),
               with_places(result.proximity_events.end, place_of),
               with_places(result.penetration_events.begin, place_of),
               with_places(result.penetration_events.end, place_of)},
        stats(result.stats) {}

  std::vector<ObjectPair> object_pairs;
  std::vector<Contact> contacts;
  std::span<const ContactPoint> contact_points;
  std::vector<ContinuousContact> continuous_contacts;
  std::vector<ProximityPair> proximity_pairs;
  std::vector<PenetrationGroup> penetration_groups;
  std::vector<Penetration> penetrations;
  std::span<const std::uint32_t> vertices_on_surface;
  std::vector<ContainedPart> contained_parts;
  std::vector<IntersectionCurve> curves;
  std::vector<CurveContact> curve_contacts;
  std::span<const Vec3d> curve_points;
  std::span<const std::uint32_t> enclosed_vertices;
  std::vector<CollidingVertices> colliding_vertex_groups;
  std::span<const std::uint32_t> colliding_vertices;
  std::array<std::vector<ObjectPair>, 10> events;
  StepStats stats;
};

Recorder::Implementation::Implementation(const fs::path& path, const RecordingHeader& header)
    : path_(final_path(path)), place_of_(header.objects) {
  check_header(header);
  const fs::path xdmf = xdmf_path(path_);
  for (const RecordedObject& object : header.objects)
    objects_.push_back({object.rest_positions.size(), object.options.is_static, {}});
  const QuietErrors quiet;
  create(header);
  xdmf_.emplace(xdmf, path_, header);
}

void Recorder::Implementation::create(const RecordingHeader& header) {
  // The file has another name until its header is complete. Then it replaces the old file atomically.
  const fs::path draft = path_.string() + ".part";
  const int descriptor = open(draft.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) fail_to_create(path_, errno);
  ::close(descriptor);
  std::error_code error;
  try {
    file_ = create_committed_file(draft);
    if (!file_) throw Hdf5Failure();
    datasets_.emplace(file_.id(), header);
    flush_file(file_.id());
    fs::rename(draft, path_, error);
  } catch (const Hdf5Failure&) {
    error = std::error_code(file_ ? write_error(file_.id()) : ENOMEM, std::generic_category());
    if (!error) error = std::error_code(EIO, std::generic_category());
  } catch (const std::bad_alloc&) {
    abandon();
    unlink(draft.c_str());
    throw;
  }
  if (!error) return;
  abandon();
  unlink(draft.c_str());
  fail_to_create(path_, error.value());
}

void Recorder::Implementation::check_open() const {
  if (!failure_.empty()) throw Error(failure_);
  if (!datasets_ && !closed_) {
    throw Error(path_.string() + ": the memory was used up; the recording ends after its first " +
                std::to_string(flushed_frames_) + " frames, record again with more memory");
  }
  if (closed_) throw Error(path_.string() + ": the recording is closed; add frames before close()");
}

void Recorder::Implementation::check_positions(std::span<const std::span<const Vec3d>> positions) const {
  if (positions.size() != objects_.size())
    throw Error(path_.string() + ": frame " + std::to_string(frames_) + " has positions of " +
                std::to_string(positions.size()) + " objects, the recording has " +
                std::to_string(objects_.size()) + "; give those of each object of the header, in its order");
  for (std::size_t place = 0; place < objects_.size(); ++place) {
    const Object& object = objects_[place];
    if (positions[place].size() != object.vertices)
      throw Error(path_.string() + ": frame " + std::to_string(frames_) + " has " +
                  std::to_string(positions[place].size()) + " positions of object " + std::to_string(place) +
                  ", which has " + std::to_string(object.vertices) +
                  " vertices; give one position per vertex");
    if (object.is_static && frames_ > 0 && object.vertices > 0 &&
        std::memcmp(positions[place].data(), object.first_positions.data(), positions[place].size_bytes()) !=
            0)
      throw Error(path_.string() + ": object " + std::to_string(place) + " moves in frame " +
                  std::to_string(frames_) + ", and is static in the header; record it with is_static off");
  }
}

void Recorder::Implementation::add(double time, std::span<const std::span<const Vec3d>> positions,
                                   const DetectResult& result) {
  check_open();
  check_positions(positions);
  const Rows rows(result, place_of_);
  const QuietErrors quiet;
  try {
    append(time, positions, rows);
    ++frames_;
    write_long_columns();
    if (flush_is_due()) write_out();
  } catch (const Hdf5Failure&) {
    stop();
  } catch (const std::bad_alloc&) {
    abandon();  // a part of the frame may be in memory
    throw;
  }
}

void Recorder::Implementation::append(double time, std::span<const std::span<const Vec3d>> positions,
                                      const Rows& rows) {
  for (std::size_t place = 0; place < objects_.size(); ++place) {
    Object& object = objects_[place];
    if (object.is_static && frames_ > 0) continue;
    if (object.is_static) object.first_positions.assign(positions[place].begin(), positions[place].end());
    datasets_->positions[place].append(positions[place]);
  }
  datasets_->object_pairs->append(rows.object_pairs);
  datasets_->contacts->append(rows.contacts);
  datasets_->contact_points->append(rows.contact_points);
  datasets_->continuous_contacts->append(rows.continuous_contacts);
  datasets_->proximity_pairs->append(rows.proximity_pairs);
  datasets_->penetration_groups->append(rows.penetration_groups);
  datasets_->penetrations->append(rows.penetrations);
  datasets_->vertices_on_surface->append(rows.vertices_on_surface);
  datasets_->contained_parts->append(rows.contained_parts);
  datasets_->curves->append(rows.curves);
  datasets_->curve_contacts->append(rows.curve_contacts);
  datasets_->curve_points->append(rows.curve_points);
  datasets_->enclosed_vertices->append(rows.enclosed_vertices);
  datasets_->colliding_vertex_groups->append(rows.colliding_vertex_groups);
  datasets_->colliding_vertices->append(rows.colliding_vertices);
  for (std::size_t i = 0; i < rows.events.size(); ++i) datasets_->events[i].append(rows.events[i]);
  append_rows(datasets_->statistics, std::span(&rows.stats, 1));
  datasets_->time->append_value(&time);
  xdmf_->add_frame(time);
  check_writes(file_.id());
}

bool Recorder::Implementation::flush_is_due() {
  // The first frames are flushed early, so that a recording that fills a small disk keeps most of them.
  return frames_ - flushed_frames_ > flushed_frames_ / 8 || pending_bytes() >= most_pending_bytes ||
         Clock::now() - last_flush_ >= flush_interval;
}

std::size_t Recorder::Implementation::pending_bytes() {
  std::size_t bytes = 0;
  datasets_->for_each_column([&](const ColumnWriter& column) { bytes += column.pending_bytes(); });
  return bytes;
}

/// Until the flush, the file has no header that counts these rows.
void Recorder::Implementation::write_long_columns() {
  datasets_->for_each_column([](ColumnWriter& column) {
    if (column.pending_bytes() >= most_pending_bytes_of_column) column.write_pending();
  });
  check_writes(file_.id());
}

void Recorder::Implementation::write_out() {
  datasets_->for_each_column([](ColumnWriter& column) { column.write_pending(); });
  flush_file(file_.id());
  flushed_frames_ = frames_;
  last_flush_ = Clock::now();
  // The XDMF file refers to the data, so it is written last.
  xdmf_->write();
}

void Recorder::Implementation::stop() {
  const int error = write_error(file_.id());
  failure_ = path_.string() + ": writing failed: " + (error != 0 ? std::strerror(error) : "HDF5 refused") +
             "; the recording ends after its first " + std::to_string(flushed_frames_) +
             " frames, make room and record again";
  abandon();
  throw Error(failure_);
}

/// Leaves the file as the last flush left it.
void Recorder::Implementation::abandon() {
  if (file_) discard_writes(file_.id());
  datasets_.reset();
  file_.reset();
}

void Recorder::Implementation::flush() {
  check_open();
  const QuietErrors quiet;
  try {
    write_out();
  } catch (const Hdf5Failure&) {
    stop();
  } catch (const std::bad_alloc&) {
    abandon();
    throw;
  }
}

void Recorder::Implementation::close() {
  if (closed_) return;
  flush();
  closed_ = true;
  const QuietErrors quiet;
  datasets_.reset();
  // Everything is flushed already; this only reports errors of closing.
  if (!file_.reset()) throw Error(path_.string() + ": closing failed; check the disk and record again");
  xdmf_.reset();
}

Recorder::Recorder(const std::filesystem::path& path, const RecordingHeader& header)
    : implementation_(std::make_unique<Implementation>(path, header)) {}
Recorder::~Recorder() = default;
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;

void Recorder::add(double time, std::span<const std::span<const Vec3d>> positions,
                   const DetectResult& result) {
  implementation_->add(time, positions, result);
}
void Recorder::flush() {
  implementation_->flush();
}
void Recorder::close() {
  implementation_->close();
}

}  // namespace supple
