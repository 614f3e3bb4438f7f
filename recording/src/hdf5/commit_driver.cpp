#include "hdf5/commit_driver.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <map>
#include <new>
#include <vector>

#if H5_VERSION_GE(1, 14, 0)
#include <H5FDdevelop.h>
#endif

namespace supple {
namespace {

constexpr haddr_t page_size = 4096;

/// A block of metadata that is held back until the flush.
struct HeldBlock {
  H5FD_mem_t type = H5FD_MEM_DEFAULT;
  std::vector<unsigned char> bytes;
};

/// HDF5 accesses it through its first member.
struct CommittedFile {
  H5FD_t base{};
  int descriptor = -1;
  haddr_t end_of_allocation = 0;
  haddr_t end_of_file = 0;
  haddr_t committed_end = 0;  ///< end of the file as HDF5 knew it at the last flush
  std::map<haddr_t, HeldBlock> held;
  int error = 0;
  bool discarding = false;
};

CommittedFile* committed(H5FD_t* file) {
  return reinterpret_cast<CommittedFile*>(file);
}
const CommittedFile* committed(const H5FD_t* file) {
  return reinterpret_cast<const CommittedFile*>(file);
}

/// Stops writing after a failed write, so the file stays as the last flush left it. HDF5 is not notified,
/// because it does not handle write errors everywhere. Until it closes the file, it reads its metadata from
/// the held blocks.
void fail_with(CommittedFile& file, int error) {
  if (file.error == 0) file.error = error;
  file.discarding = true;
}

/// Returns false on failure.
bool write_now(CommittedFile& file, haddr_t address, const unsigned char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t written = pwrite(file.descriptor, bytes, size, static_cast<off_t>(address));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      fail_with(file, written < 0 ? errno : ENOSPC);
      return false;
    }
    bytes += written;
    address += static_cast<haddr_t>(written);
    size -= static_cast<std::size_t>(written);
    file.end_of_file = std::max(file.end_of_file, address);
  }
  return true;
}

/// The sort key of a block in the order of a flush.
struct Turn {
  int stage = 0;
  int minus_level = 0;  ///< of B-tree nodes, negated
  haddr_t address = 0;
  auto operator<=>(const Turn&) const = default;
};

Turn turn_of(haddr_t address, const HeldBlock& block) {
  constexpr std::size_t level_at = 5;  // after "TREE" and the node type
  if (block.type == H5FD_MEM_SUPER) return {0, 0, address};
  if (block.bytes.size() > level_at && std::memcmp(block.bytes.data(), "TREE", 4) == 0)
    return {1, -block.bytes[level_at], address};
  return {2, 0, address};
}

void commit(CommittedFile& file) {
  std::vector<std::pair<Turn, const HeldBlock*>> order;
  for (const auto& [address, block] : file.held) order.push_back({turn_of(address, block), &block});
  std::sort(order.begin(), order.end());
  for (const auto& [turn, block] : order) {
    assert(turn.address / page_size == (turn.address + block->bytes.size() - 1) / page_size);
    if (!write_now(file, turn.address, block->bytes.data(), block->bytes.size())) return;
    // The superblock stores the end of the file. If a later write fails, the file must not be cut before it.
    if (block->type == H5FD_MEM_SUPER) file.committed_end = file.end_of_allocation;
  }
  file.held.clear();
  file.committed_end = file.end_of_allocation;
}

// Callbacks of HDF5. They must not throw.

H5FD_t* open_file(const char* name, unsigned, hid_t, haddr_t) {
  const int descriptor = open(name, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) return nullptr;
  auto* file = new (std::nothrow) CommittedFile;
  if (!file) {
    close(descriptor);
    return nullptr;
  }
  file->descriptor = descriptor;
  return &file->base;
}

herr_t close_file(H5FD_t* base) {
  CommittedFile* file = committed(base);
  // A failed flush may leave bytes beyond the end. Removing them is optional, so a failure here is ignored.
  if (file->discarding && file->committed_end > 0 &&
      ftruncate(file->descriptor, static_cast<off_t>(file->committed_end)) != 0)
    errno = 0;
  const int status = close(file->descriptor);
  delete file;
  return status == 0 ? 0 : -1;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t allocate(H5FD_t* base, H5FD_mem_t type, hid_t, hsize_t size) {
  CommittedFile* file = committed(base);
  haddr_t address = file->end_of_allocation;
  const haddr_t left_in_page = page_size - address % page_size;
  if (type != H5FD_MEM_DRAW && size > left_in_page && size <= page_size) address += left_in_page;
  file->end_of_allocation = address + size;
  return address;
}

haddr_t end_of_allocation(const H5FD_t* base, H5FD_mem_t) {
  return committed(base)->end_of_allocation;
}

herr_t set_end_of_allocation(H5FD_t* base, H5FD_mem_t, haddr_t address) {
  committed(base)->end_of_allocation = address;
  return 0;
}

haddr_t end_of_file(const H5FD_t* base, H5FD_mem_t) {
  return committed(base)->end_of_file;
}

herr_t handle_of(H5FD_t* base, hid_t, void** handle) {
  *handle = committed(base);
  return 0;
}

/// Overwrites `bytes`, which were read from the file, where held blocks have newer content.
void lay_held_blocks_over(const CommittedFile& file, haddr_t address, std::size_t size,
                          unsigned char* bytes) {
  auto block = file.held.upper_bound(address);
  if (block != file.held.begin()) --block;
  for (; block != file.held.end() && block->first < address + size; ++block) {
    const haddr_t block_end = block->first + block->second.bytes.size();
    const haddr_t from = std::max(address, block->first), to = std::min(address + size, block_end);
    if (from < to)
      std::memcpy(bytes + (from - address), &block->second.bytes[from - block->first], to - from);
  }
}

herr_t read_file(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, void* buffer) {
  const CommittedFile* file = committed(base);
  auto* bytes = static_cast<unsigned char*>(buffer);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got =
        pread(file->descriptor, bytes + done, size - done, static_cast<off_t>(address + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return -1;
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  std::memset(bytes + done, 0, size - done);  // allocated but not yet written
  lay_held_blocks_over(*file, address, size, bytes);
  return 0;
}

herr_t write_file(H5FD_t* base, H5FD_mem_t type, hid_t, haddr_t address, std::size_t size,
                  const void* buffer) {
  CommittedFile* file = committed(base);
  const auto* bytes = static_cast<const unsigned char*>(buffer);
  // Raw data is never held: no header counts the new rows yet, and other rows of the chunk do not change.
  const bool is_held = type != H5FD_MEM_DRAW && address < file->committed_end;
  if (!file->discarding && !is_held && write_now(*file, address, bytes, size)) return 0;
  if (type == H5FD_MEM_DRAW) return 0;
  try {
    HeldBlock& block = file->held[address];
    block.type = type;
    block.bytes.resize(std::max(block.bytes.size(), size));
    std::copy_n(bytes, size, block.bytes.begin());
  } catch (const std::bad_alloc&) {
    fail_with(*file, ENOMEM);
    return -1;
  }
  return 0;
}

herr_t truncate_file(H5FD_t* base, hid_t, hbool_t) {
  CommittedFile* file = committed(base);
  if (file->discarding || file->end_of_file >= file->end_of_allocation) return 0;
  if (ftruncate(file->descriptor, static_cast<off_t>(file->end_of_allocation)) != 0) {
    fail_with(*file, errno);
    return 0;
  }
  file->end_of_file = file->end_of_allocation;
  return 0;
}

herr_t flush_file(H5FD_t* base, hid_t, hbool_t) {
  CommittedFile* file = committed(base);
  if (file->discarding) return 0;
  try {
    commit(*file);
  } catch (const std::bad_alloc&) {
    fail_with(*file, ENOMEM);
  }
  return 0;
}

H5FD_class_t driver_class() {
  H5FD_class_t driver{};
#if H5_VERSION_GE(1, 14, 0)
  driver.version = H5FD_CLASS_VERSION;
  driver.value = static_cast<H5FD_class_value_t>(600);  // in the range reserved for private use
#endif
  driver.name = "supple_commit";
  driver.maxaddr = (haddr_t{1} << 62) - 1;
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.open = open_file;
  driver.close = close_file;
  driver.query = query;
  driver.alloc = allocate;
  driver.get_eoa = end_of_allocation;
  driver.set_eoa = set_end_of_allocation;
  driver.get_eof = end_of_file;
  driver.get_handle = handle_of;
  driver.read = read_file;
  driver.write = write_file;
  driver.flush = flush_file;
  driver.truncate = truncate_file;
  for (H5FD_mem_t& type : driver.fl_map) type = H5FD_MEM_DEFAULT;
  return driver;
}

CommittedFile* file_of(hid_t file) {
  void* handle = nullptr;
  return H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0 ? nullptr : static_cast<CommittedFile*>(handle);
}

}  // namespace

FileHandle create_committed_file(const std::filesystem::path& path) {
  static const H5FD_class_t driver = driver_class();
  static const hid_t driver_id = H5FDregister(&driver);
  const PropertyListHandle access(H5Pcreate(H5P_FILE_ACCESS));
  errno = 0;
  if (driver_id < 0 || H5Pset_driver(access.id(), driver_id, nullptr) < 0) return {};
  // The format of HDF5 1.8: all readers support it. It also has no mark for files open for writing, which
  // would remain after a kill and make readers refuse the file.
  if (H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V18) < 0) return {};
  // Object times would make equal recordings differ.
  const PropertyListHandle creation(H5Pcreate(H5P_FILE_CREATE));
  if (H5Pset_obj_track_times(creation.id(), false) < 0) return {};
  return FileHandle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()));
}

int write_error(hid_t file) {
  const CommittedFile* committed_file = file_of(file);
  return committed_file ? committed_file->error : 0;
}

void discard_writes(hid_t file) {
  if (CommittedFile* committed_file = file_of(file)) committed_file->discarding = true;
}

}  // namespace supple
