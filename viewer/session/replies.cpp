#include "replies.hpp"

namespace supple::viewer {

void Replies::begin() {
  json.clear();
  json.begin_object();
  if (id) json.member("id", *id);
}

void Replies::end_answer() {
  json.end_object();
  if (id) waiting_.push_back({MessageKind::answer, std::string(json.text())});
}

void Replies::add_failure(const std::string& message, bool fatal, std::span<const std::string> layers) {
  begin();
  json.member("message", message);
  json.member("fatal", fatal);
  if (!layers.empty()) json.member("layers", layers);
  json.end_object();
  waiting_.push_back({MessageKind::failure, std::string(json.text())});
}

void Replies::take_first(MessageWriter& message) {
  message.begin(waiting_.front().kind);
  message.add_text(waiting_.front().text);
  waiting_.pop_front();
}

}  // namespace supple::viewer
