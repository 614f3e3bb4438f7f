#include "access.hpp"

#include <unistd.h>
#if __has_include(<sys/random.h>)
#include <sys/random.h>
#endif

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "supple/error.hpp"

namespace supple::viewer {
namespace {

std::string bracketed(const std::string& address) {
  if (address.find(':') == std::string::npos) return address;
  std::string text;
  text += '[';
  text += address;
  text += ']';
  return text;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Four numbers, or anything in brackets. A DNS name cannot have either form.
bool is_address(std::string_view name) {
  if (name.size() > 2 && name.front() == '[') return name.back() == ']';
  return !name.empty() && is_digit(name.back()) &&
         std::all_of(name.begin(), name.end(), [](char c) { return is_digit(c) || c == '.'; });
}

}  // namespace

std::string make_token() {
  std::array<unsigned char, 16> bytes{};
  if (getentropy(bytes.data(), bytes.size()) != 0) {
    std::string message = "cannot get random numbers for a token from the system: ";
    message += std::strerror(errno);
    throw Error(message);
  }
  std::string token;
  for (const unsigned char byte : bytes) {
    token += "0123456789abcdef"[byte >> 4];
    token += "0123456789abcdef"[byte & 15];
  }
  return token;
}

Target parse_target(std::string_view target) {
  const std::size_t end_of_path = std::min(target.find('?'), target.size());
  Target parsed{target.substr(0, end_of_path), {}};
  for (std::string_view rest = target.substr(end_of_path); !rest.empty();) {
    rest.remove_prefix(1);  // ? or &
    const std::string_view item = rest.substr(0, rest.find('&'));
    constexpr std::string_view key = "token=";
    if (item.substr(0, key.size()) == key) parsed.token = item.substr(key.size());
    rest.remove_prefix(item.size());
  }
  return parsed;
}

Access::Access(const std::string& address, std::uint16_t port, std::string token)
    : any_address_(address == "0.0.0.0" || address == "::"), token_(std::move(token)) {
  if (port != 80) {  // browsers omit the default port
    port_ += ':';
    port_ += std::to_string(port);
  }
  if (any_address_) {
    hosts_.push_back(address == "::" ? "[::1]" : "127.0.0.1");
    std::array<char, 256> name{};
    if (gethostname(name.data(), name.size() - 1) == 0) hosts_.emplace_back(name.data());
  } else {
    hosts_.push_back(bracketed(address));
  }
  hosts_.emplace_back("localhost");
  for (std::string& host : hosts_) host += port_;
}

bool Access::knows_host(std::string_view host) const {
  if (std::find(hosts_.begin(), hosts_.end(), host) != hosts_.end()) return true;
  if (!any_address_ || host.size() < port_.size()) return false;
  const std::string_view name = host.substr(0, host.size() - port_.size());
  return host.substr(name.size()) == port_ && is_address(name);
}

bool Access::is_own_origin(std::string_view origin, std::string_view host) {
  constexpr std::string_view scheme = "http://";
  return origin.empty() ||
         (origin.substr(0, scheme.size()) == scheme && origin.substr(scheme.size()) == host);
}

bool Access::knows_token(std::string_view token) const {
  if (token.size() != token_.size()) return false;
  int difference = 0;
  for (std::size_t i = 0; i < token.size(); ++i) difference |= token[i] ^ token_[i];
  return difference == 0;
}

std::string content_policy(std::string_view host) {
  std::string policy =
      "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:; style-src "
      "'unsafe-inline'; img-src data: blob:; media-src blob:; font-src data:; base-uri 'none'; form-action "
      "'none'; "
      "frame-ancestors 'none'; connect-src 'self' ws://";
  policy += host;
  return policy;
}

}  // namespace supple::viewer
