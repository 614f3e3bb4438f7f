#include "communicator.hpp"

#include <zoltan_comm.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>

#include "core/error.hpp"

namespace supple {
namespace {

constexpr int tag_of_plan = 4211, tag_of_sizes = 4212, tag_of_data = 4213;
/// Sizes of messages are counted in words, so that they fit into an int up to 16 GiB.
constexpr std::size_t word = 8;

}  // namespace

Communicator::Communicator(MPI_Comm communicator) {
  int is_initialized = 0;
  MPI_Initialized(&is_initialized);
  if (is_initialized == 0) fail("DistributedScene: MPI is not initialized; call MPI_Init first");
  MPI_Comm_dup(communicator, &handle_);
  MPI_Comm_rank(handle_, &rank_);
  MPI_Comm_size(handle_, &size_);
}

Communicator::~Communicator() {
  int is_finalized = 0;
  MPI_Finalized(&is_finalized);
  if (is_finalized == 0) MPI_Comm_free(&handle_);
}

int Communicator::ranks_of_machine() const {
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(handle_, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &machine);
  int count = 1;
  MPI_Comm_size(machine, &count);
  MPI_Comm_free(&machine);
  return count;
}

void Communicator::sum(std::vector<double>& numbers) const {
  MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_DOUBLE, MPI_SUM, handle_);
}

void Communicator::sum(std::vector<std::uint64_t>& numbers) const {
  MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_UINT64_T, MPI_SUM,
                handle_);
}

void Communicator::largest(std::vector<double>& numbers) const {
  MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_DOUBLE, MPI_MAX, handle_);
}

bool Communicator::any(bool value) const {
  int found = value ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT, MPI_MAX, handle_);
  return found != 0;
}

void Communicator::agree(bool failed, const std::string& error, const std::string& call) const {
  const std::uint64_t hash = checksum_of({std::as_bytes(std::span(call))});
  std::uint64_t largest[] = {failed ? static_cast<std::uint64_t>(size_ - rank_) : 0, hash, ~hash};
  MPI_Allreduce(MPI_IN_PLACE, largest, 3, MPI_UINT64_T, MPI_MAX, handle_);
  if (largest[0] == 0 && largest[1] == ~largest[2]) return;
  if (largest[0] == 0) fail_other_calls(call);
  const int first = size_ - static_cast<int>(largest[0]);
  std::string message = first == rank_ ? error : std::string();
  auto length = static_cast<int>(message.size());
  MPI_Bcast(&length, 1, MPI_INT, first, handle_);
  message.resize(static_cast<std::size_t>(length));
  MPI_Bcast(message.data(), length, MPI_CHAR, first, handle_);
  throw SharedError("rank " + std::to_string(first) + ": " + message);
}

/// Collective: names the first line in which a rank differs from rank 0.
void Communicator::fail_other_calls(const std::string& call) const {
  Inbox inbox;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(call));
  share({bytes.begin(), bytes.end()}, inbox);
  std::vector<std::string> calls;
  for (const Inbox::Message& message : inbox.messages_)
    calls.emplace_back(reinterpret_cast<const char*>(message.bytes.data()), message.bytes.size());
  const auto other = std::find_if(calls.begin(), calls.end(), [&](const auto& c) { return c != calls[0]; });
  const auto [p, q] = std::mismatch(calls[0].cbegin(), calls[0].cend(), other->cbegin(), other->cend());
  const auto line_at = [](const std::string& text, auto place) {
    const auto begin = std::find(std::make_reverse_iterator(place), text.rend(), '\n').base();
    return std::string(begin, std::find(place, text.end(), '\n'));
  };
  throw SharedError("the ranks make different calls: on rank 0, " + line_at(calls[0], p) + "; on rank " +
                    std::to_string(other - calls.begin()) + ", " + line_at(*other, q) +
                    "; give all ranks the same");
}

void Communicator::exchange(Outbox& outbox, Inbox& inbox) {
  ranks_.clear();
  sizes_.clear();
  sent_.clear();
  inbox.messages_.clear();
  inbox.own_.clear();
  // Each message starts with its sender and its size in bytes, and is filled up to whole words.
  for (auto& [rank, bytes] : outbox.messages_) {
    if (bytes.empty()) continue;
    if (rank == rank_) {
      inbox.own_.swap(bytes);
      inbox.messages_.push_back({rank_, inbox.own_});
      continue;
    }
    const std::uint64_t head[] = {static_cast<std::uint64_t>(rank_), bytes.size()};
    const std::size_t first = sent_.size();
    const std::size_t words = sizeof head / word + (bytes.size() + word - 1) / word;
    sent_.resize(first + words * word);
    std::memcpy(sent_.data() + first, head, sizeof head);
    std::memcpy(sent_.data() + first + sizeof head, bytes.data(), bytes.size());
    ranks_.push_back(rank);
    sizes_.push_back(static_cast<int>(words));
    ++messages_sent;
    bytes_sent += words * word;
  }
  ZOLTAN_COMM_OBJ* plan = nullptr;
  int incoming = 0, incoming_words = 0;
  bool is_ok = Zoltan_Comm_Create(&plan, static_cast<int>(ranks_.size()), ranks_.data(), handle_, tag_of_plan,
                                  &incoming) == 0;
  is_ok = is_ok && Zoltan_Comm_Resize(plan, sizes_.data(), tag_of_sizes, &incoming_words) == 0;
  inbox.received_.resize(static_cast<std::size_t>(incoming_words) * word);
  is_ok = is_ok && Zoltan_Comm_Do(plan, tag_of_data, sent_.data(), static_cast<int>(word),
                                  reinterpret_cast<char*>(inbox.received_.data())) == 0;
  Zoltan_Comm_Destroy(&plan);
  if (!is_ok) fail("the exchange of messages between ranks failed; Zoltan or MPI ran out of memory");
  const std::span<const std::byte> received(inbox.received_);
  for (std::size_t first = 0; first < received.size();) {
    std::uint64_t head[2];
    std::memcpy(head, received.data() + first, sizeof head);
    const auto size = static_cast<std::size_t>(head[1]);
    inbox.messages_.push_back({static_cast<int>(head[0]), received.subspan(first + sizeof head, size)});
    first += sizeof head + (size + word - 1) / word * word;
  }
  std::sort(inbox.messages_.begin(), inbox.messages_.end(),
            [](const auto& p, const auto& q) { return p.from < q.from; });
}

void Communicator::share(const std::vector<std::byte>& own, Inbox& inbox) const {
  std::vector<std::uint64_t> sizes(static_cast<std::size_t>(size_));
  const std::uint64_t size = own.size();
  MPI_Allgather(&size, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, handle_);
  std::vector<int> counts, firsts;  // in words
  std::size_t words = 0;
  for (const std::uint64_t of_rank : sizes) {
    counts.push_back(static_cast<int>((of_rank + word - 1) / word));
    firsts.push_back(static_cast<int>(words));
    words += static_cast<std::size_t>(counts.back());
  }
  inbox = {};
  if (words == 0) return;
  std::vector<std::byte> sent;
  together([&] {
    if (words > std::numeric_limits<int>::max()) fail("the ranks share more than 16 GiB");
    sent = own;
    sent.resize(word * static_cast<std::size_t>(counts[static_cast<std::size_t>(rank_)]));
    inbox.received_.resize(word * words);
  });
  MPI_Allgatherv(sent.data(), static_cast<int>(sent.size() / word), MPI_UINT64_T, inbox.received_.data(),
                 counts.data(), firsts.data(), MPI_UINT64_T, handle_);
  for (std::size_t rank = 0; rank < sizes.size(); ++rank) {
    if (sizes[rank] == 0) continue;
    inbox.messages_.push_back(
        {static_cast<int>(rank),
         std::span(inbox.received_).subspan(word * static_cast<std::size_t>(firsts[rank]), sizes[rank])});
  }
}

void Communicator::release() {
  sent_ = {};
}

}  // namespace supple
