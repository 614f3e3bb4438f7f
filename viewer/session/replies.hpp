#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <string>

#include "messages/json_text.hpp"
#include "messages/message.hpp"

namespace supple::viewer {

/// Answers and failures that wait for the page. At most `most` of them: a page may not read them.
class Replies {
 public:
  static constexpr std::size_t most = 256;

  std::optional<double> id{};  ///< of the current command
  JsonText json;               ///< of the current answer

  void clear() { waiting_.clear(); }
  bool empty() const { return waiting_.empty(); }
  bool full() const { return waiting_.size() >= most; }
  void drop_last() { waiting_.pop_back(); }
  /// Begins the answer to the current command; `end_answer` adds it when the command has an id.
  void begin();
  void end_answer();
  /// `layers` are the layers that frames no longer contain.
  void add_failure(const std::string& message, bool fatal, std::span<const std::string> layers);
  /// Moves the first reply to the message.
  void take_first(MessageWriter& message);

 private:
  struct Reply {
    MessageKind kind;
    std::string text;
  };
  std::deque<Reply> waiting_;
};

}  // namespace supple::viewer
