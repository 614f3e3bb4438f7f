// Checkpoints: one file with a head, a table of objects and parts, their data, and the pairs of the last
// step. Checksums cover every byte, so that each rank finds damage in what it takes. Each rank writes and
// reads its own ranges of it.

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "distributed_implementation.hpp"

namespace supple {
namespace {

struct Head {
  std::array<char, 8> magic{'s', 'u', 'p', 'p', 'l', 'e', 'd', 's'};
  std::uint64_t version = 2;
  std::uint64_t step = 0;
  std::uint64_t objects = 0, events = 0;  ///< rows of the table, and bytes at the end of the file
  std::uint64_t of_events = 0;            ///< the sum of their checksums
  std::uint64_t checksum = 0;             ///< of what is before it
};

struct Row {
  ObjectId id;
  std::uint64_t size = 0;      ///< in bytes
  std::uint64_t checksum = 0;  ///< of what is before it, and of the data
};

struct Event {
  ObjectPair pair;
  std::uint64_t list = 0;
};

std::span<const std::byte> bytes_of(const auto& rows) {
  return std::as_bytes(std::span(rows));
}

/// The checksum of a head or a row, and of data that belong to it.
template <class Checked>
std::uint64_t checksum_with(const Checked& head, std::span<const std::byte> data) {
  return checksum_of({bytes_of(std::span(&head, 1)).first(offsetof(Checked, checksum)), data});
}

std::uint64_t sum_of_checksums(std::span<const Event> events) {
  std::uint64_t sum = 0;
  for (const Event& event : events) sum += checksum_of({bytes_of(std::span(&event, 1))});
  return sum;
}

/// A file of all ranks. Calls are collective, but for `read` and `write`.
class SharedFile {
 public:
  SharedFile(Communicator& ranks, const std::string& path, int mode) : ranks_(ranks), path_(path) {
    const int code = MPI_File_open(ranks.handle(), path.c_str(), mode, MPI_INFO_NULL, &file_);
    ranks_.together([&] { check(code, "cannot be opened"); });
  }
  ~SharedFile() {
    if (file_ != MPI_FILE_NULL) MPI_File_close(&file_);
  }
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  void write(std::uint64_t at, std::span<const std::byte> bytes) {
    for_pieces(at, bytes.size(), [&](MPI_Offset place, std::size_t first, int count, MPI_Status& status) {
      return MPI_File_write_at(file_, place, bytes.data() + first, count, MPI_BYTE, &status);
    });
  }
  void read(std::uint64_t at, std::span<std::byte> bytes) const {
    for_pieces(at, bytes.size(), [&](MPI_Offset place, std::size_t first, int count, MPI_Status& status) {
      return MPI_File_read_at(file_, place, bytes.data() + first, count, MPI_BYTE, &status);
    });
  }
  std::uint64_t size() const {
    MPI_Offset size = 0;
    MPI_File_get_size(file_, &size);
    return static_cast<std::uint64_t>(size);
  }

 private:
  template <class Transfer>
  void for_pieces(std::uint64_t at, std::size_t size, const Transfer& transfer) const {
    constexpr std::size_t most = std::size_t{1} << 30;
    for (std::size_t first = 0; first < size; first += most) {
      const int count = static_cast<int>(std::min(most, size - first));
      MPI_Status status;
      check(transfer(static_cast<MPI_Offset>(at + first), first, count, status), "cannot be read or written");
      int done = 0;
      MPI_Get_count(&status, MPI_BYTE, &done);
      if (done != count)
        fail(path_ + ": only " + std::to_string(done) + " of " + std::to_string(count) +
             " bytes were read or written; is the disk full?");
    }
  }
  void check(int code, const char* what) const {
    if (code == MPI_SUCCESS) return;
    std::array<char, MPI_MAX_ERROR_STRING> text{};
    int length = 0;
    MPI_Error_string(code, text.data(), &length);
    fail(path_ + ": " + what + ": " + std::string(text.data(), static_cast<std::size_t>(length)));
  }

  Communicator& ranks_;
  const std::string path_;
  MPI_File file_ = MPI_FILE_NULL;
};

}  // namespace

void DistributedScene::Implementation::save(const std::string& path) {
  std::vector<std::byte> data;
  std::vector<Row> table;
  std::vector<Event> events;
  ranks.begin([&] {
    Writer to(data);
    for (const auto& [id, object] : homes_) {
      const std::size_t first = data.size();
      object.write(to);
      Row& row = table.emplace_back(Row{id, data.size() - first});
      row.checksum = checksum_with(row, std::span(data).subspan(first));
    }
    for (std::size_t list = 0; list < pair_lists; ++list) {
      const PairEvents last = events_[list].events();
      for (const auto pairs : {last.begin, last.stay}) {
        for (const ObjectPair& pair : pairs) events.push_back({pair, list});
      }
    }
    return CallText("save").add("path", path);
  });
  const std::array<std::span<const std::byte>, 3> parts{bytes_of(table), bytes_of(data), bytes_of(events)};
  std::array<std::uint64_t, 3> before{};
  std::array<std::uint64_t, 4> total{0, 0, 0, sum_of_checksums(events)};
  for (std::size_t i = 0; i < parts.size(); ++i) before[i] = total[i] = parts[i].size();
  MPI_Exscan(MPI_IN_PLACE, before.data(), 3, MPI_UINT64_T, MPI_SUM, ranks.handle());
  if (ranks.rank() == 0) before = {};
  MPI_Allreduce(MPI_IN_PLACE, total.data(), 4, MPI_UINT64_T, MPI_SUM, ranks.handle());
  const std::string unfinished = path + ".part";
  if (ranks.rank() == 0) std::remove(unfinished.c_str());
  ranks.together([] {});  // all wait until it is gone
  try {
    SharedFile file(ranks, unfinished, MPI_MODE_CREATE | MPI_MODE_WRONLY);
    ranks.together([&] {
      Head head{.step = step_, .objects = total[0] / sizeof(Row), .events = total[2], .of_events = total[3]};
      head.checksum = checksum_with(head, {});
      if (ranks.rank() == 0) file.write(0, bytes_of(std::span(&head, 1)));
      std::uint64_t at = sizeof head;
      for (std::size_t i = 0; i < parts.size(); at += total[i++]) file.write(at + before[i], parts[i]);
    });
  } catch (const SharedError&) {
    if (ranks.rank() == 0) std::remove(unfinished.c_str());
    throw;
  }
  ranks.together([&] {
    if (ranks.rank() == 0) std::filesystem::rename(unfinished, path);
  });
}

void DistributedScene::Implementation::load(const std::string& path) {
  ranks.begin([&] {
    if (!homes_.empty()) fail("load: the scene has objects; load into a new one");
    return CallText("load").add("path", path);
  });
  SharedFile file(ranks, path, MPI_MODE_RDONLY);
  std::map<ObjectId, HomeObject> loaded;
  std::vector<Event> events;
  Head head;
  ranks.together([&] {
    const std::uint64_t size = file.size();
    const auto is_unusable = [&](const std::string& why) { fail(path + ": " + why); };
    if (size < sizeof head) is_unusable("is no checkpoint of a distributed scene");
    file.read(0, std::as_writable_bytes(std::span(&head, 1)));
    if (head.magic != Head().magic) is_unusable("is no checkpoint of a distributed scene");
    if (head.version != Head().version)
      is_unusable("is a checkpoint of version " + std::to_string(head.version) + "; this program reads " +
                  std::to_string(Head().version));
    const auto cut_off = [&] { is_unusable("is cut off or damaged; take an older checkpoint"); };
    if (head.checksum != checksum_with(head, {}) || head.objects > size / sizeof(Row) || head.events > size ||
        head.events % sizeof(Event) != 0)
      cut_off();
    std::vector<Row> table(head.objects);
    file.read(sizeof head, std::as_writable_bytes(std::span(table)));
    std::uint64_t total = 0;
    for (const Row& row : table) total += std::min(row.size, size);
    const std::uint64_t first_byte = sizeof head + table.size() * sizeof(Row);
    if (size != first_byte + total + head.events) cut_off();
    // Each rank takes the objects that start in its share of the data.
    std::map<ObjectId, std::vector<std::vector<std::byte>>> parts;
    std::uint64_t at = 0;
    for (const Row& row : table) {
      const double share = static_cast<double>(at) / static_cast<double>(std::max<std::uint64_t>(total, 1));
      if (std::min(static_cast<int>(share * ranks.size()), ranks.size() - 1) == ranks.rank()) {
        std::vector<std::byte>& bytes = parts[row.id].emplace_back(row.size);
        file.read(first_byte + at, bytes);
        if (row.checksum != checksum_with(row, bytes)) cut_off();
      }
      at += row.size;
    }
    for (const auto& [id, of_object] : parts) {
      const std::vector<std::span<const std::byte>> views(of_object.begin(), of_object.end());
      try {
        loaded.emplace(id, HomeObject::of(id, read_object(views), options.cluster_triangles, additions_++));
      } catch (const Error& error) {
        is_unusable(std::string("is damaged: ") + error.what());
      }
    }
    if (ranks.rank() == 0) {
      events.resize(head.events / sizeof(Event));
      file.read(first_byte + total, std::as_writable_bytes(std::span(events)));
      if (head.of_events != sum_of_checksums(events)) cut_off();
    }
  });
  outbox_.clear();
  for (const Event& event : events) outbox_.to(rank_of_pair(event.pair.a, event.pair.b)).put(event);
  ranks.exchange(outbox_, inbox_);
  ranks.together([&] {
    std::array<std::vector<ObjectPair>, pair_lists> pairs;
    inbox_.for_each([&](Reader& from, int) {
      while (!from.is_done()) {
        const auto event = from.get<Event>();
        if (event.list < pair_lists) pairs[event.list].push_back(event.pair);
      }
    });
    for (std::size_t list = 0; list < pair_lists; ++list) {
      std::sort(pairs[list].begin(), pairs[list].end());
      events_[list].update(pairs[list]);
    }
  });
  homes_ = std::move(loaded);
  has_detected_ = false;
  step_ = head.step;
  has_changed_ = true;
}

}  // namespace supple
