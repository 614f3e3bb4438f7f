#include "spectators.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

namespace supple::viewer {
namespace {

struct Section {
  std::uint32_t tag = 0, object = 0, count = 0;
  std::span<const std::byte> data{};
};

/// Calls `visit(section)` for each section of a message that this program has made (viewer/PROTOCOL.md).
template <class Visit>
void visit_sections(std::span<const std::byte> message, const Visit& visit) {
  constexpr std::size_t header = 16;
  const auto word = [&](std::size_t place) {
    std::uint32_t value = 0;
    std::memcpy(&value, message.data() + place, sizeof value);
    return value;
  };
  std::size_t place = header;
  for (std::uint32_t left = word(12); left > 0; --left) {
    const std::size_t length = word(place + 12);
    visit(Section{word(place), word(place + 4), word(place + 8), message.subspan(place + header, length)});
    place += header + (length + header - 1) / header * header;
  }
}

MessageKind kind_of(std::span<const std::byte> message) {
  std::uint16_t kind = 0;
  std::memcpy(&kind, message.data() + 6, sizeof kind);
  return static_cast<MessageKind>(kind);
}

}  // namespace

void Spectators::accept(beast::tcp_stream stream, const http::request<http::empty_body>& request) {
  const auto page = std::make_shared<Page>(std::move(stream), patience_);
  const auto find = [this, raw = page.get()] {
    return std::ranges::find_if(watchers_, [raw](const Watcher& w) { return w.page.get() == raw; });
  };
  Page::Listener listener;
  listener.came = [this, weak = std::weak_ptr(page)] {
    const auto came = weak.lock();
    if (watchers_.size() >= most) return came->close(too_many_spectators, "too many pages watch");
    watchers_.push_back({came});
    send_next(watchers_.back());
  };
  listener.left = [this, find] {
    if (const auto watcher = find(); watcher != watchers_.end()) watchers_.erase(watcher);
  };
  listener.sent = [this, find] {
    const auto watcher = find();
    if (watcher == watchers_.end()) return;
    watcher->is_sending = false;
    send_next(*watcher);
  };
  listener.command = [](const std::string&) { return true; };  // it may only watch
  page->accept(request, std::move(listener));
}

void Spectators::relay(const Message& message) {
  const MessageKind kind = kind_of(message.bytes);
  if (kind != MessageKind::scene && kind != MessageKind::series && kind != MessageKind::frame) return;
  // The memory of the message is written again when the controlling page has it.
  const auto copy =
      std::make_shared<const std::vector<std::byte>>(message.bytes.begin(), message.bytes.end());
  if (kind == MessageKind::scene) {
    scene_ = copy;
    series_ = frame_ = nullptr;
    positions_.clear();
  } else if (kind == MessageKind::series) {
    series_ = copy;
  } else {
    take_frame(copy);
  }
  for (Watcher& watcher : watchers_) {
    if (kind == MessageKind::scene) watcher.owes_scene = watcher.owes_frame = true;
    if (kind != MessageKind::frame) watcher.owes_series = true;
    if (kind == MessageKind::frame) {
      if (watcher.owes_frame) watcher.has_positions = false;  // it missed the frame before
      watcher.owes_frame = true;
    }
    send_next(watcher);
  }
}

void Spectators::take_frame(const Bytes& message) {
  frame_ = message;
  visit_sections(*message, [&](const Section& section) {
    if (section.tag != static_cast<std::uint32_t>(Tag::positions)) return;
    Positions& positions = positions_[section.object];
    positions.data.assign(section.data.begin(), section.data.end());
    positions.count = section.count;
  });
}

void Spectators::send_next(Watcher& watcher) {
  if (watcher.is_sending || scene_ == nullptr) return;
  const auto send = [&](const Message& message) {
    watcher.is_sending = true;
    watcher.page->send(message);
  };
  if (std::exchange(watcher.owes_scene, false)) {
    watcher.has_positions = false;
    send({*scene_, scene_});
  } else if (series_ != nullptr && std::exchange(watcher.owes_series, false)) {
    send({*series_, series_});
  } else if (frame_ != nullptr && std::exchange(watcher.owes_frame, false)) {
    send(std::exchange(watcher.has_positions, true) ? Message{*frame_, frame_} : whole_frame());
  }
}

/// The last frame with the positions of all objects.
Message Spectators::whole_frame() const {
  const auto writer = std::make_shared<MessageWriter>();
  writer->begin(MessageKind::frame);
  const auto add = [&](const Section& section) {
    const auto to =
        writer->add_bytes(static_cast<Tag>(section.tag), section.object, section.count, section.data.size());
    std::copy(section.data.begin(), section.data.end(), to.begin());
  };
  for (const auto& [object, positions] : positions_)
    add({static_cast<std::uint32_t>(Tag::positions), object, positions.count, positions.data});
  visit_sections(*frame_, [&](const Section& section) {
    if (section.tag != static_cast<std::uint32_t>(Tag::positions)) add(section);
  });
  const std::span<const std::byte> bytes = writer->finish();
  return {bytes, writer};
}

void Spectators::close(CloseCode code, const char* reason) {
  for (Watcher& watcher : watchers_) watcher.page->close(code, reason);
}

}  // namespace supple::viewer
