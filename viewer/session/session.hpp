#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "messages/message.hpp"
#include "scene_view.hpp"

namespace supple::viewer {

/// Memory in bytes.
struct MemoryBudget {
  double bytes = 2e9;          ///< that commands may add to the scene as it was opened (`estimated_memory`)
  double history_bytes = 5e8;  ///< for the positions of the last steps; 0 keeps no steps
};

/// One viewer session (viewer/PROTOCOL.md): takes commands, produces messages. It has no clock, no threads of
/// its own and no network, so the program and the page run the same code. When memory runs out, functions
/// produce a failure message or throw `std::bad_alloc`; after the exception, only destroy the session.
class Session {
 public:
  /// Throws `Error` when an object or an option is invalid.
  explicit Session(SceneView show, MemoryBudget budget = {});
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  /// Call when a page connects or reconnects. It gets the whole scene again and has no credit yet.
  void greet();
  /// Call when no page is connected any more.
  void leave();
  /// Executes a command in JSON. An invalid command produces a failure message, not an exception.
  void command(std::string_view json);
  /// Lets `seconds` pass; takes at most one step or frame. Returns the number of seconds until the next
  /// change if no command arrives; 0 when there is more to do.
  double advance(double seconds);
  /// Writes the next message, if any, into `message` and returns it, else returns an empty span. The bytes
  /// stay valid until `message` is written again, so they can be sent without a copy while the session goes
  /// on.
  std::span<const std::byte> next_message(MessageWriter& message);
  /// True after a fatal failure message.
  bool ended() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple::viewer
