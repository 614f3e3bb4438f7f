#pragma once

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "session_thread.hpp"

namespace supple::viewer {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using namespace std::chrono_literals;

inline constexpr std::size_t largest_command = std::size_t{1} << 20;
inline constexpr std::size_t largest_result = std::size_t{1} << 30;

enum CloseCode : std::uint16_t {
  taken_over = 4001,
  program_ends = 4002,
  no_command = 4003,
  session_failed = 4004,
  too_many_spectators = 4005
};

/// A connected page, that is, a WebSocket.
class Page : public std::enable_shared_from_this<Page> {
 public:
  /// Callbacks on the network thread.
  struct Listener {
    std::function<void()> came, left, sent;
    /// Returns whether to continue reading now.
    std::function<bool(std::string)> command;
    /// Takes a binary message. Empty: the page may send none.
    std::function<void(std::span<const std::byte>)> result{};
  };

  Page(beast::tcp_stream stream, std::chrono::milliseconds patience) : socket_(std::move(stream)) {
    beast::get_lowest_layer(socket_).expires_never();  // the WebSocket has its own timeout
    websocket::stream_base::timeout times{};
    times.handshake_timeout = std::min<std::chrono::milliseconds>(patience, 5s);
    times.idle_timeout = patience;
    times.keep_alive_pings = true;
    socket_.set_option(times);
    socket_.auto_fragment(false);  // send a message in one piece instead of 4 KiB fragments
    socket_.binary(true);
  }

  void accept(const http::request<http::empty_body>& request, Listener listener) {
    listener_ = std::move(listener);
    if (listener_.result) socket_.read_message_max(largest_result);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->listener_.came();
      self->read();
    });
  }

  void send(Message message) {
    if (is_closing_) return;
    const asio::const_buffer bytes(message.bytes.data(), message.bytes.size());
    socket_.async_write(
        bytes, [self = shared_from_this(), message](error_code, std::size_t) { self->listener_.sent(); });
  }

  /// Call after `Listener::command` returned false.
  void read_on() {
    if (std::exchange(is_paused_, false)) read();
  }

  void close(
      CloseCode code, const char* reason, std::function<void()> then = [] {}) {
    if (std::exchange(is_closing_, true)) return then();
    const websocket::close_reason why(static_cast<websocket::close_code>(code), reason);
    socket_.async_close(why, [self = shared_from_this(), then](error_code) { then(); });
  }

 private:
  void read() {
    socket_.async_read_some(
        text_, (listener_.result ? largest_result : largest_command) + 1 - text_.size(),
        [self = shared_from_this()](error_code error, std::size_t) { self->take(error); });
  }

  void take(error_code error) {
    if (error) {
      is_closing_ = true;
      return listener_.left();
    }
    // After a close command, messages are ignored, but must be read to receive the page's own close.
    if (is_closing_) {
      text_.consume(text_.size());
      return read();
    }
    const bool is_result = !socket_.got_text() && listener_.result;
    if (is_result) {
      if (socket_.is_message_done()) {
        listener_.result({static_cast<const std::byte*>(text_.data().data()), text_.size()});
        text_.consume(text_.size());
      }
      return read();
    }
    if (!socket_.got_text() || text_.size() > largest_command) {
      close(no_command, socket_.got_text() ? "a command is at most 1 MiB" : "commands are texts");
      return take({});
    }
    bool more = true;
    if (socket_.is_message_done()) {
      more = listener_.command(beast::buffers_to_string(text_.data()));
      text_.consume(text_.size());
    }
    is_paused_ = !more;
    if (more) read();
  }

  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer text_;
  Listener listener_;
  bool is_paused_ = false, is_closing_ = false;
};

}  // namespace supple::viewer
