#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "message.hpp"
#include "scene_view.hpp"

namespace supple::viewer {

/// What a page sees and steers (docs/protocol.md): commands in, messages out. It has no clock, no threads of
/// its own and knows nothing of how messages travel, so that it is the same in the program and in a page.
class Session {
 public:
  /// Throws `Error` when an object or an option is not what it should be.
  explicit Session(SceneView show);
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  /// A page has come, or come again: it gets the scene afresh and has no credit yet.
  void greet();
  /// A command as JSON text. What is wrong with it becomes a failure message; it does not throw.
  void command(std::string_view json);
  /// Lets that much time pass: takes at most one step or frame. Gives how long nothing will be to do unless
  /// a command comes, in seconds: 0 when there is more to do at once.
  double advance(double seconds);
  /// Writes the next message to send, when there is one, and gives it or nothing. It lasts until something
  /// else is written to `message`, so that it need not be copied to be sent while the session goes on.
  std::span<const std::byte> next_message(MessageWriter& message);
  /// After a fatal failure message.
  bool ended() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple::viewer
