#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "support/viewer_messages.hpp"

namespace supple::viewer {

/// The answer of a server.
struct Answer {
  unsigned status = 0;
  std::map<std::string, std::string> fields{};
  std::string body{};
};

/// Sends the text of a request, which may be invalid HTTP, and returns the answer.
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

/// Requests a target; an empty host omits the Host field.
inline Answer get(std::uint16_t port, const std::string& target, std::string host = "default",
                  const std::string& fields = "") {
  if (host == "default") host = "127.0.0.1:" + std::to_string(port);
  std::string request = "GET ";
  request += target;
  request += " HTTP/1.1\r\n";
  if (!host.empty()) request.append("Host: ").append(host).append("\r\n");
  return ask(port, request.append(fields).append("\r\n"));
}

/// The client end of a WebSocket.
class PageClient {
 public:
  /// Throws `boost::system::system_error` if the server refuses the connection.
  PageClient(std::uint16_t port, const std::string& token, std::string host = "default",
             const std::string& origin = "", const std::string& path = "/session") {
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

  ViewerMessage receive() {
    boost::beast::flat_buffer buffer;
    socket_.read(buffer);
    const auto* const first = static_cast<const std::byte*>(buffer.data().data());
    return ViewerMessage(std::vector<std::byte>(first, first + buffer.size()));
  }
  /// Returns the next message of a kind and skips the others.
  ViewerMessage receive(ViewerMessage::Kind kind) {
    ViewerMessage message = receive();
    while (message.kind != kind) message = receive();
    return message;
  }
  /// Reads until the server closes. Returns the code, or 0 if the connection ended without one.
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
