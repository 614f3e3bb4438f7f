#pragma once

#include <chrono>
#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <vector>

#include "page.hpp"

namespace supple::viewer {

/// Pages that watch what the controlling page gets. They have no commands. Nothing waits for them, and no
/// message is queued: each is sent one message at a time, misses the frames that come meanwhile, and then
/// gets the newest one with all positions. All calls on the network thread.
class Spectators {
 public:
  static constexpr std::size_t most = 32;

  explicit Spectators(std::chrono::milliseconds patience) : patience_(patience) {}

  /// Closes the connection when there are too many spectators.
  void accept(beast::tcp_stream stream, const http::request<http::empty_body>& request);
  /// Call with each message of the session for the controlling page.
  void relay(const Message& message);
  void close(CloseCode code, const char* reason);

 private:
  using Bytes = std::shared_ptr<const std::vector<std::byte>>;
  struct Watcher {
    std::shared_ptr<Page> page{};
    bool is_sending = false;
    bool owes_scene = true, owes_series = true;
    bool owes_frame = true;
    bool has_positions = false;  ///< of all frames so far
  };

  void take_frame(const Bytes& message);
  void send_next(Watcher& watcher);
  Message whole_frame() const;

  std::chrono::milliseconds patience_;
  std::list<Watcher> watchers_;
  Bytes scene_, series_, frame_;  ///< the last ones
  /// Copied, so that no earlier message is kept for an object that came to rest.
  struct Positions {
    std::vector<std::byte> data{};
    std::uint32_t count = 0;
  };
  std::map<std::uint32_t, Positions> positions_;  ///< the newest ones, by object
};

}  // namespace supple::viewer
