// Recordings that were edited through HDF5: links, types, shapes, layouts, filters, values. The input is a
// list of edits, so that each file is one that HDF5 itself accepts.

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/recording.hpp"
#include "supple/scene.hpp"
#include "support/byte_reader.hpp"
#include "support/check.hpp"
#include "support/temporary_file.hpp"

namespace {

using namespace supple;
using fuzz::check;

constexpr std::size_t recording_count = 3;
constexpr int most_edits = 12;
/// All values of the files that a recording must not be able to read.
constexpr double secret = 7340033.125;
constexpr std::uint32_t whole_secret = 7340033;

/// Scenes that fill all groups of a recording.
void record(std::size_t choice, const std::filesystem::path& path) {
  constexpr std::array<ContactKinds, recording_count> kinds{
      ContactKinds::intersection | ContactKinds::proximity, ContactKinds::continuous,
      ContactKinds::penetration};
  RecordingHeader header;
  header.scene.contacts = kinds[choice];
  header.scene.curves = true;
  header.scene.threads = 1;
  header.scene.comparison.colliding_vertices = choice == 0;
  header.scene_file = "[scene]";
  Scene scene(header.scene);
  std::vector<std::vector<Vec3d>> positions;
  for (int i = 0; i < 3; ++i) {
    RecordedObject object;
    const TriangleMesh mesh = i == 2 ? make_icosphere(1) : make_box({1, 1, 1}, 1);
    object.options.name = "object";
    object.options.solid = choice == 2;
    object.options.margin = 0.1;
    object.options.is_static = i == 1;
    if (choice == 1) object.options.edges = {{0, 5}};
    object.rest_positions = mesh.positions;
    object.triangles = mesh.triangles;
    object.id = scene.add(mesh, object.options);
    positions.push_back(mesh.positions);
    header.objects.push_back(object);
  }
  Recorder recorder(path, header);
  for (int frame = 0; frame < 3; ++frame) {
    for (std::size_t i = 0; i < positions.size(); i += 2) {
      const std::vector<Vec3d> from = positions[i];
      for (Vec3d& p : positions[i]) p = p + Vec3d{0.3, 0.2, i == 0 ? 0.1 : -0.4};
      scene.set_motion(header.objects[i].id, from, positions[i]);
    }
    const std::vector<std::span<const Vec3d>> views(positions.begin(), positions.end());
    recorder.add(0.1 * frame, views, scene.detect());
  }
  recorder.close();
}

/// Recordings, and files that they must not read.
struct Originals {
  std::array<std::string, recording_count> recordings;
  std::array<std::vector<std::string>, recording_count> paths;  // of all groups and datasets
  fuzz::TemporaryFile other{"_other.h5"}, raw{"_raw"};

  Originals() {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const fuzz::TemporaryFile file("_original.h5");
    for (std::size_t i = 0; i < recording_count; ++i) {
      record(i, file.path());
      std::ifstream stream(file.path(), std::ios::binary);
      recordings[i].assign(std::istreambuf_iterator<char>(stream), {});
      const hid_t id = H5Fopen(file.path().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
      H5Lvisit(
          id, H5_INDEX_NAME, H5_ITER_INC,
          [](hid_t, const char* name, const H5L_info_t*, void* list) {
            static_cast<std::vector<std::string>*>(list)->push_back(name);
            return herr_t{0};
          },
          &paths[i]);
      H5Fclose(id);
    }
    std::filesystem::remove(std::filesystem::path(file.path()).replace_extension(".xdmf"));
    write_secrets();
  }

  void write_secrets() {
    const std::vector<double> secrets(4096, secret);
    raw.write({reinterpret_cast<const char*>(secrets.data()), secrets.size() * sizeof(double)});
    const hid_t file = H5Fcreate(other.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t size[2] = {secrets.size() / 3, 3};
    const hid_t space = H5Screate_simple(2, size, nullptr);
    const hid_t set =
        H5Dcreate2(file, "secret", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, secrets.data());
    H5Dclose(set);
    H5Sclose(space);
    H5Fclose(file);
  }
};

class Editor {
 public:
  Editor(fuzz::ByteReader& bytes, hid_t file, const Originals& originals,
         const std::vector<std::string>& paths)
      : bytes_(bytes), file_(file), originals_(originals), paths_(paths) {}

  void edit() {
    const std::string path = any_path();
    switch (bytes_.below(8)) {
      case 0:
        link(path);
        break;
      case 1:
        attribute(path);
        break;
      case 2:
      case 3:
        value(path);
        break;
      case 4:
        resize(path);
        break;
      default:
        replace(path);
    }
  }

 private:
  std::string any_path() { return paths_[bytes_.byte() % paths_.size()]; }

  void link(const std::string& path) {
    H5Ldelete(file_, path.c_str(), H5P_DEFAULT);
    const std::string other = any_path();
    switch (bytes_.below(6)) {
      case 0:
        break;  // only deleted
      case 1:
        H5Lcreate_hard(file_, other.c_str(), file_, path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
        break;
      case 2:
        H5Lcreate_soft(("/" + other).c_str(), file_, path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
        break;
      case 3:
        H5Lcreate_external(originals_.other.path().c_str(), "/secret", file_, path.c_str(), H5P_DEFAULT,
                           H5P_DEFAULT);
        break;
      case 4:
        H5Lcreate_hard(file_, "/", file_, path.c_str(), H5P_DEFAULT, H5P_DEFAULT);  // a cycle
        break;
      default: {
        const hid_t group = H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        H5Gclose(group);
      }
    }
  }

  hid_t type() {
    const std::array simple{H5T_NATIVE_UINT8,   H5T_NATIVE_UINT32, H5T_NATIVE_UINT64, H5T_NATIVE_DOUBLE,
                            H5T_NATIVE_INT64,   H5T_NATIVE_FLOAT,  H5T_IEEE_F64BE,    H5T_STD_U32BE,
                            H5T_NATIVE_LDOUBLE, H5T_STD_REF_OBJ,   H5T_NATIVE_OPAQUE, H5T_C_S1};
    const std::uint32_t choice = bytes_.below(16);
    if (choice < simple.size()) return H5Tcopy(simple[choice]);
    if (choice == 12) {
      const hid_t text = H5Tcopy(H5T_C_S1);
      H5Tset_size(text, H5T_VARIABLE);
      return text;
    }
    if (choice == 13) return H5Tvlen_create(H5T_NATIVE_DOUBLE);
    if (choice == 14) {
      const hid_t text = H5Tcopy(H5T_C_S1);
      H5Tset_size(text, 1 + bytes_.bits(2));
      return text;
    }
    const hsize_t size[1] = {3};
    return H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, size);
  }

  /// HDF5 keeps attributes, and data without chunks while it writes them, in memory.
  static bool is_small(hid_t of_type, hid_t of_space) {
    constexpr double most_bytes = 1 << 20;
    return static_cast<double>(H5Sget_simple_extent_npoints(of_space)) *
               static_cast<double>(H5Tget_size(of_type)) <=
           most_bytes;
  }

  hid_t space() {
    const int rank = static_cast<int>(bytes_.below(5));
    if (rank == 4) return H5Screate(bytes_.flag() ? H5S_NULL : H5S_SCALAR);
    std::array<hsize_t, 4> size{}, most{};
    for (hsize_t& extent : size)
      extent = bytes_.below(16) == 0 ? hsize_t{1} << bytes_.below(62) : bytes_.below(64);
    for (std::size_t i = 0; i < most.size(); ++i) most[i] = bytes_.flag() ? H5S_UNLIMITED : size[i];
    return H5Screate_simple(rank, size.data(), most.data());
  }

  hid_t storage(hid_t of_space) {
    const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
    std::array<hsize_t, 4> chunk{4, 3, 3, 3};
    const int rank = std::max(1, H5Sget_simple_extent_ndims(of_space));
    switch (bytes_.below(6)) {
      case 0:
        H5Pset_layout(list, H5D_COMPACT);
        break;
      case 1:
        H5Pset_external(list, originals_.raw.path().c_str(), 0, H5F_UNLIMITED);
        break;
      case 2: {
        const hid_t source = H5Screate_simple(2, std::array<hsize_t, 2>{1365, 3}.data(), nullptr);
        H5Pset_virtual(list, of_space, originals_.other.path().c_str(), "/secret", source);
        H5Sclose(source);
        break;
      }
      case 3:
        break;  // contiguous
      default:
        H5Pset_chunk(list, rank, chunk.data());
        filter(list);
    }
    return list;
  }

  void filter(hid_t list) {
    switch (bytes_.below(8)) {
      case 0:
        H5Pset_deflate(list, 1 + bytes_.below(9));
        break;
      case 1:
        H5Pset_shuffle(list);
        H5Pset_deflate(list, 1);
        break;
      case 2:
        H5Pset_fletcher32(list);
        break;
      case 3:
        H5Pset_nbit(list);
        break;
      case 4:
        H5Pset_scaleoffset(list, H5Z_SO_INT, 0);
        break;
      case 5: {
        const unsigned none = 0;
        H5Pset_filter(list, static_cast<H5Z_filter_t>(256 + bytes_.byte()), H5Z_FLAG_OPTIONAL, 0, &none);
        break;
      }
      default:
        break;
    }
  }

  void replace(const std::string& path) {
    const hid_t of_type = type(), of_space = space(), list = storage(of_space);
    H5Ldelete(file_, path.c_str(), H5P_DEFAULT);
    if (H5Pget_layout(list) == H5D_CHUNKED || is_small(of_type, of_space)) {
      const hid_t set = H5Dcreate2(file_, path.c_str(), of_type, of_space, H5P_DEFAULT, list, H5P_DEFAULT);
      if (set >= 0) H5Dclose(set);
    }
    H5Pclose(list);
    H5Sclose(of_space);
    H5Tclose(of_type);
  }

  void value(const std::string& path) {
    const hid_t set = H5Dopen2(file_, path.c_str(), H5P_DEFAULT);
    if (set < 0) return;
    const hid_t of_type = H5Dget_type(set), of_space = H5Dget_space(set);
    const hssize_t count = H5Sget_simple_extent_npoints(of_space);
    const std::size_t size = H5Tget_size(of_type);
    const H5T_class_t kind = H5Tget_class(of_type);
    if (count > 0 && count < 4096 && (kind == H5T_INTEGER || kind == H5T_FLOAT)) {
      std::vector<std::uint8_t> values(static_cast<std::size_t>(count) * size);
      if (H5Dread(set, of_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0) {
        const std::size_t place = bytes_.bits(2) % static_cast<std::size_t>(count) * size;
        const std::uint64_t number = bytes_.flag() ? bytes_.bits(8) : bytes_.bits(1);
        std::memcpy(values.data() + place, &number, std::min(size, sizeof number));
        H5Dwrite(set, of_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
      }
    }
    H5Sclose(of_space);
    H5Tclose(of_type);
    H5Dclose(set);
  }

  void resize(const std::string& path) {
    const hid_t set = H5Dopen2(file_, path.c_str(), H5P_DEFAULT);
    if (set < 0) return;
    const hid_t of_space = H5Dget_space(set);
    std::array<hsize_t, H5S_MAX_RANK> size{};
    const int rank = H5Sget_simple_extent_dims(of_space, size.data(), nullptr);
    if (rank > 0) {
      size[bytes_.byte() % static_cast<std::size_t>(rank)] =
          bytes_.below(8) == 0 ? hsize_t{1} << bytes_.below(40) : bytes_.byte();
      H5Dset_extent(set, size.data());
    }
    H5Sclose(of_space);
    H5Dclose(set);
  }

  void attribute(const std::string& path) {
    const hid_t object =
        bytes_.flag() ? H5Oopen(file_, "/", H5P_DEFAULT) : H5Oopen(file_, path.c_str(), H5P_DEFAULT);
    if (object < 0) return;
    std::array<char, 64> name{};
    const std::uint32_t count = bytes_.byte() % 40;
    if (H5Aget_name_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, count, name.data(), name.size(),
                           H5P_DEFAULT) > 0) {
      H5Adelete(object, name.data());
      if (bytes_.below(4) > 0) {
        const hid_t of_type = type(), of_space = bytes_.flag() ? H5Screate(H5S_SCALAR) : space();
        const hid_t made = is_small(of_type, of_space)
                               ? H5Acreate2(object, name.data(), of_type, of_space, H5P_DEFAULT, H5P_DEFAULT)
                               : H5I_INVALID_HID;
        const H5T_class_t kind = H5Tget_class(of_type);
        if (made >= 0 && H5Sget_simple_extent_npoints(of_space) == 1 && H5Tget_size(of_type) <= 64 &&
            kind != H5T_VLEN && H5Tis_variable_str(of_type) <= 0 && kind != H5T_REFERENCE) {
          std::array<std::uint8_t, 64> values{};
          for (std::uint8_t& value : values) value = bytes_.byte();
          H5Awrite(made, of_type, values.data());
        }
        if (made >= 0) H5Aclose(made);
        H5Sclose(of_space);
        H5Tclose(of_type);
      }
    }
    H5Oclose(object);
  }

  fuzz::ByteReader& bytes_;
  hid_t file_;
  const Originals& originals_;
  const std::vector<std::string>& paths_;
};

void check_no_secret(const std::vector<Vec3d>& positions) {
  for (const Vec3d& p : positions)
    check(p.x != secret && p.y != secret && p.z != secret, "a recording reads another file");
}

void read_all(const std::filesystem::path& path) {
  const Recording recording(path);
  const RecordingHeader& header = recording.header();
  for (const RecordedObject& object : header.objects) {
    check_no_secret(object.rest_positions);
    for (const Triangle& t : object.triangles) {
      check(std::find(t.begin(), t.end(), whole_secret) == t.end(), "a recording reads another file");
    }
  }
  for (std::uint64_t frame = 0; frame < std::min<std::uint64_t>(recording.frame_count(), 5); ++frame) {
    recording.frame(frame);
    recording.summary(frame);
    for (std::size_t i = 0; i < header.objects.size(); ++i) {
      const std::vector<Vec3d> positions = recording.positions(frame, i);
      check(positions.size() == header.objects[i].rest_positions.size(),
            "a frame has another number of vertices");
      check_no_secret(positions);
    }
  }
  const auto difference = find_first_difference(recording, recording);
  check(!difference, difference ? difference->what : "");
}

}  // namespace

/// HDF5 handles that there is not enough memory for a size that the file states.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "allocator_may_return_null=1";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Originals originals;
  static const fuzz::TemporaryFile file(".h5");
  fuzz::ByteReader bytes(data, size);
  const std::size_t choice = bytes.byte() % recording_count;
  file.write(originals.recordings[choice]);
  const hid_t id = H5Fopen(file.path().c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  Editor editor(bytes, id, originals, originals.paths[choice]);
  for (int i = 0; i < most_edits && !bytes.at_end(); ++i) editor.edit();
  H5Fclose(id);
  try {
    read_all(file.path());
  } catch (const Error& error) {
    fuzz::check_message(error.what(), file.path().string());
  }
  return 0;
}
