#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace supple::viewer {

/// 128 bits from the system's random device, as 32 hexadecimal digits.
std::string make_token();

/// What a request of HTTP asks for.
struct Target {
  std::string_view path, token;  ///< the token is empty when there is none
};
Target parse_target(std::string_view target);

/// Who may ask for the page and its session.
class Access {
 public:
  /// `address` is an IP address without brackets, of an interface or of all (0.0.0.0, ::).
  Access(const std::string& address, std::uint16_t port, std::string token);

  const std::string& token() const { return token_; }
  /// `127.0.0.1:8080` or `[::1]:8080`; of all interfaces that of this machine.
  const std::string& host() const { return hosts_.front(); }

  /// Whether a `Host` names this server: by an address, or as localhost. Pages of other sites can make names
  /// of their own lead here; these are refused.
  bool knows_host(std::string_view host) const;
  /// Whether an `Origin` is the page of that host. None at all is fine: browsers always send one.
  static bool is_own_origin(std::string_view origin, std::string_view host);
  /// Takes as long for any text of the same length.
  bool knows_token(std::string_view token) const;

 private:
  std::vector<std::string> hosts_;
  std::string port_;
  bool any_address_ = false;
  std::string token_;
};

}  // namespace supple::viewer
