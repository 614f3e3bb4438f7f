#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace supple::viewer {

/// What a server answered.
struct Answer {
  unsigned status = 0;
  std::map<std::string, std::string> fields{};
  std::string body{};
};

/// A request of HTTP, or anything else, as it stands, and the answer to it.
inline Answer ask(std::uint16_t port, const std::string& request, bool is_head = false) {
  namespace http = boost::beast::http;
  boost::asio::io_context context;
  boost::asio::ip::tcp::socket socket(context);
  socket.connect({boost::asio::ip::make_address("127.0.0.1"), port});
  boost::asio::write(socket, boost::asio::buffer(request));
  boost::beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  parser.body_limit(boost::none);
  parser.skip(is_head);
  http::read(socket, buffer, parser);
  Answer answer{parser.get().result_int(), {}, parser.get().body()};
  for (const auto& field : parser.get())
    answer.fields.emplace(field.name_string().to_string(), field.value().to_string());
  return answer;
}

/// A request for a target; an empty host is left out.
inline Answer get(std::uint16_t port, const std::string& target, std::string host = "default",
                  const std::string& fields = "") {
  if (host == "default") host = "127.0.0.1:" + std::to_string(port);
  std::string request = "GET ";
  request += target;
  request += " HTTP/1.1\r\n";
  if (!host.empty()) request.append("Host: ").append(host).append("\r\n");
  return ask(port, request.append(fields).append("\r\n"));
}

/// A message of the viewer's protocol, as far as the server's tests look into it.
struct Received {
  std::vector<std::byte> bytes{};

  std::uint32_t at(std::size_t offset) const {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
  }
  unsigned kind() const { return at(4) >> 16; }
  /// The data of the first section of this tag; nothing when there is none.
  std::optional<std::string> section(std::uint32_t tag) const {
    std::size_t offset = 16;
    for (std::uint32_t i = 0; i < at(12); ++i) {
      const std::uint32_t length = at(offset + 12);
      if (at(offset) == tag) return std::string(reinterpret_cast<const char*>(bytes.data()) + offset + 16, length);
      offset += 16 + (length + 15) / 16 * 16;
    }
    return std::nullopt;
  }
  std::string text() const { return section(1).value_or(""); }
};

enum Kind : unsigned { scene = 1, frame = 2, answer = 3, failure = 4, series = 5 };

/// A page's end of a WebSocket.
class PageClient {
 public:
  /// Throws `boost::system::system_error` when it is not let in.
  PageClient(std::uint16_t port, const std::string& token, std::string host = "default", const std::string& origin = "",
             const std::string& path = "/session") {
    namespace websocket = boost::beast::websocket;
    if (host == "default") host = "127.0.0.1:" + std::to_string(port);
    socket_.next_layer().connect({boost::asio::ip::make_address("127.0.0.1"), port});
    socket_.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
      if (!origin.empty()) request.set(boost::beast::http::field::origin, origin);
    }));
    socket_.read_message_max(0);
    socket_.handshake(host, path + "?token=" + token);
    socket_.text(true);
  }

  void send(const std::string& text) { socket_.write(boost::asio::buffer(text)); }
  auto& socket() { return socket_; }

  Received receive() {
    boost::beast::flat_buffer buffer;
    socket_.read(buffer);
    const auto* const first = static_cast<const std::byte*>(buffer.data().data());
    return {{first, first + buffer.size()}};
  }
  /// The next message of a kind; others are passed over.
  Received receive(Kind kind) {
    Received received = receive();
    while (received.kind() != kind) received = receive();
    return received;
  }
  /// Reads until the other end closes: the code it gives, 0 when the connection is just gone.
  std::uint16_t receive_close() {
    try {
      for (;;) receive();
    } catch (const boost::system::system_error&) {
      return socket_.reason().code;
    }
  }

 private:
  boost::asio::io_context context_;
  boost::beast::websocket::stream<boost::asio::ip::tcp::socket> socket_{context_};
};

}  // namespace supple::viewer
