#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "bytes.hpp"
#include "supple/error.hpp"

namespace supple {

/// An error that all ranks throw.
class SharedError : public Error {
 public:
  using Error::Error;
};

/// Messages to other ranks, or to this one.
class Outbox {
 public:
  Writer to(int rank) { return Writer(messages_[rank]); }
  void clear() {
    for (auto& [rank, bytes] : messages_) bytes.clear();
  }
  /// Gives its memory back.
  void release() { messages_.clear(); }

 private:
  friend class Communicator;
  std::map<int, std::vector<std::byte>> messages_;
};

/// The messages of one exchange, ascending by sender.
class Inbox {
 public:
  /// Calls `read(reader, rank)` for each message.
  template <class Read>
  void for_each(const Read& read) const {
    for (const auto& [from, bytes] : messages_) {
      Reader reader(bytes);
      read(reader, from);
    }
  }
  /// Forgets the messages and gives their memory back.
  void release() { *this = {}; }

 private:
  friend class Communicator;
  struct Message {
    int from = 0;
    std::span<const std::byte> bytes;
  };
  std::vector<std::byte> received_, own_;  // by other ranks, and by this one
  std::vector<Message> messages_;
};

/// The ranks of a scene, on a communicator of their own.
class Communicator {
 public:
  explicit Communicator(MPI_Comm communicator);
  ~Communicator();
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;

  MPI_Comm handle() const { return handle_; }
  int rank() const { return rank_; }
  int size() const { return size_; }
  /// How many ranks run on this machine.
  int ranks_of_machine() const;

  /// Collective: runs `work` on each rank. When it throws on any of them, all throw the error of the lowest.
  /// `work` may call it again, and so end on all ranks where it fails on one.
  template <class Work>
  void together(const Work& work) const {
    begin([&] {
      work();
      return std::string();
    });
  }
  /// Collective, the first in each call: as `together` for `arguments`, which checks the arguments of this
  /// rank and returns them as lines `name is value`. Throws on all ranks when these differ between ranks.
  template <class Arguments>
  void begin(const Arguments& arguments) const {
    std::string error, call;
    bool failed = false;
    try {
      call = arguments();
    } catch (const SharedError&) {
      throw;
    } catch (const std::exception& e) {
      failed = true;
      error = e.what();
    }
    agree(failed, error, call);
  }
  /// Collective: each rank sends its messages and gets those to it. Only ranks with a message for each other
  /// communicate. The messages in `outbox` are undefined afterwards, and those in `inbox` are valid until its
  /// next exchange.
  void exchange(Outbox& outbox, Inbox& inbox);
  /// Collective: all ranks get the messages of all, up to 16 GiB together. The messages are valid until
  /// `inbox` changes.
  void share(const std::vector<std::byte>& own, Inbox& inbox) const;
  /// Gives the memory of messages back.
  void release();
  // Collective: each number becomes the sum or the largest of those of all ranks.
  void sum(std::vector<double>& numbers) const;
  void sum(std::vector<std::uint64_t>& numbers) const;
  void largest(std::vector<double>& numbers) const;
  bool any(bool value) const;

  std::uint64_t bytes_sent = 0, messages_sent = 0;  ///< to other ranks

 private:
  void agree(bool failed, const std::string& error, const std::string& call) const;
  [[noreturn]] void fail_other_calls(const std::string& call) const;

  MPI_Comm handle_ = MPI_COMM_NULL;
  int rank_ = 0, size_ = 1;
  // Scratch memory.
  std::vector<int> ranks_, sizes_;
  std::vector<char> sent_;
};

}  // namespace supple
