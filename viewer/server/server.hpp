#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "session/session.hpp"

namespace supple::viewer {

/// The callbacks of a program whose page draws pictures for it. The thread of `Server::run` calls them; what
/// they throw leaves `run`. Without them, a page that sends a binary message is disconnected.
struct Drawing {
  /// A binary message of the page, of at most 1 GiB.
  std::function<void(std::span<const std::byte>)> result{};
  /// The page is not connected any more.
  std::function<void()> left{};
};

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< an IP address; see `is_loopback`
  std::uint16_t port = 0;             ///< 0: any free port
  std::string_view page{};            ///< HTML; must outlive the server
  /// HTML for those who may only watch, with a token of their own; empty: nobody may only watch. Must outlive
  /// the server.
  std::string_view watching_page{};
  /// A page that is silent for this long is disconnected. It gets a ping before that.
  std::chrono::milliseconds patience{30'000};
  std::string token{};  ///< empty: a new random token; see `token_of_file`
  Drawing drawing{};
};

/// Whether only programs on this machine can reach the address. Throws `Error` for an invalid IP address.
bool is_loopback(const std::string& address);

/// Serves a session to one page at a time, and to others that only watch (viewer/PROTOCOL.md). A client must
/// address the server by its own address, which excludes pages of other sites, and must know a random token.
class Server {
 public:
  /// Starts listening. Throws `Error` when the address is not available.
  Server(Session session, const ServerOptions& options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const;
  const std::string& token() const;
  /// The address to open in a browser. When the server listens on all interfaces, one that others can use.
  std::string url() const;
  /// The address for those who may only watch; empty without a page for them.
  std::string watching_url() const;

  /// The session has something to do: a program has come to a step. Any thread can call it.
  void wake();
  /// Serves until `should_end`, which is called ten times a second, returns true; then notifies the page.
  /// Throws `Error` when the session fails permanently.
  void run(const std::function<bool()>& should_end);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple::viewer
