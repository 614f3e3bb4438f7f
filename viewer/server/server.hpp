#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "session/session.hpp"

namespace supple::viewer {

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< an IP address; see `is_loopback`
  std::uint16_t port = 0;             ///< 0: any that is free
  std::string_view page{};            ///< HTML, which outlives the server
  /// A page that has not been heard of for so long is given up; it is asked for a sign of life by then.
  std::chrono::milliseconds patience{30'000};
};

/// Whether only programs on this machine reach the address. Throws `Error` when it is no IP address.
bool is_loopback(const std::string& address);

/// Serves a session to one page at a time, as docs/protocol.md says. What it serves and takes commands from
/// must name it by its own address (so that no other site's page gets in by a name of its own) and know a
/// random token.
class Server {
 public:
  /// Listens from here on. Throws `Error` when the address cannot be had.
  Server(Session session, const ServerOptions& options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const;
  const std::string& token() const;
  /// What a person opens.
  std::string url() const;

  /// Serves until `should_end`, which is asked ten times a second, says so; the page is told. Throws `Error`
  /// when the session fails for good.
  void run(const std::function<bool()>& should_end);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple::viewer
