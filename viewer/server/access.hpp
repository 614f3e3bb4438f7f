#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace supple::viewer {

/// 128 bits from the random device of the system, as 32 hexadecimal digits.
std::string make_token();

/// The token in a file. Makes the file with a new token when it does not exist, so that the address of a
/// server stays the same when it is started again. Throws `Error` when the file cannot be used, or when
/// others can read it.
std::string token_of_file(const std::string& path);

/// The parts of the target of an HTTP request.
struct Target {
  std::string_view path, token;  ///< token: empty when there is none
};
Target parse_target(std::string_view target);

/// Decides who may load the page and use its session.
class Access {
 public:
  /// `address` is an IP address without brackets: of one interface, or of all (0.0.0.0, ::).
  /// Without a `watching_token`, nobody may only watch.
  Access(const std::string& address, std::uint16_t port, std::string token, std::string watching_token = {});

  const std::string& token() const { return token_; }
  const std::string& watching_token() const { return watching_token_; }
  /// `127.0.0.1:8080` or `[::1]:8080`. When the server listens on all interfaces: the address of this machine
  /// in its network, or the loopback address without a network.
  const std::string& host() const { return hosts_.front(); }

  /// Whether the `Host` header names this server, by IP address or as localhost. Other names are refused,
  /// because a foreign site can point its own name to this machine (DNS rebinding).
  bool knows_host(std::string_view host) const;
  /// Whether the `Origin` header is the page of that host. A missing header is accepted: browsers always
  /// send it.
  static bool is_own_origin(std::string_view origin, std::string_view host);
  /// Takes constant time for texts of the same length.
  bool knows_token(std::string_view token) const;
  /// The same for the token of those who may only watch.
  bool may_watch(std::string_view token) const;

 private:
  std::vector<std::string> hosts_;
  std::string port_;
  bool any_address_ = false;
  std::string token_, watching_token_;
};

/// The resources that a page of this server may load: itself and its session. A header of its answer.
std::string content_policy(std::string_view host);

}  // namespace supple::viewer
