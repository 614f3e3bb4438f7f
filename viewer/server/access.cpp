#include "access.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#if __has_include(<sys/random.h>)
#include <sys/random.h>
#endif

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
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

/// The address of this machine that others can use, or the loopback address. Connecting a UDP socket sends
/// nothing: it chooses the interface towards an address, here one for documentation that nobody has.
std::string outward_address(bool is_v6) {
  namespace ip = boost::asio::ip;
  boost::asio::io_context context;
  boost::system::error_code error;
  ip::udp::socket socket(context);
  socket.connect({ip::make_address(is_v6 ? "2001:db8::1" : "192.0.2.1"), 9}, error);  // opens it, too
  const ip::udp::endpoint here = error ? ip::udp::endpoint() : socket.local_endpoint(error);
  if (error || here.address().is_unspecified()) return is_v6 ? "::1" : "127.0.0.1";
  return here.address().to_string();
}

constexpr std::size_t token_length = 32;

bool is_token(std::string_view text) {
  return text.size() == token_length && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

[[noreturn]] void fail_of_file(const std::string& path, const std::string& what) {
  throw Error("--token-file: " + path + ": " + what);
}

/// Four numbers, or anything in brackets. A DNS name cannot have either form.
bool is_address(std::string_view name) {
  if (name.size() > 2 && name.front() == '[') return name.back() == ']';
  return !name.empty() && is_digit(name.back()) &&
         std::all_of(name.begin(), name.end(), [](char c) { return is_digit(c) || c == '.'; });
}

/// Takes constant time for texts of the same length.
bool equals(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  int difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= a[i] ^ b[i];
  return difference == 0;
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

std::string token_of_file(const std::string& path) {
  // Only the user may read it. Another program that makes the file at the same time wins.
  const int made = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (made >= 0) {
    const std::string line = make_token() + "\n";
    const bool is_written = write(made, line.data(), line.size()) == static_cast<ssize_t>(line.size());
    if (close(made) != 0 || !is_written) fail_of_file(path, "cannot be written");
    return line.substr(0, token_length);
  }
  if (errno != EEXIST) fail_of_file(path, std::string("cannot be written: ") + std::strerror(errno));
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail_of_file(path, std::string("cannot be read: ") + std::strerror(errno));
  struct stat status {};
  std::array<char, token_length + 2> content{};
  const bool is_private = fstat(file, &status) == 0 && (status.st_mode & (S_IRWXG | S_IRWXO)) == 0;
  const ssize_t length = read(file, content.data(), content.size());
  close(file);
  if (!is_private) fail_of_file(path, "other users can read it; chmod 600 it, or remove it for a new token");
  std::string_view text(content.data(), static_cast<std::size_t>(std::max<ssize_t>(length, 0)));
  if (text.ends_with('\n')) text.remove_suffix(1);
  if (!is_token(text))
    fail_of_file(path, "it has no token of 32 hexadecimal digits; remove it for a new one");
  return std::string(text);
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

Access::Access(const std::string& address, std::uint16_t port, std::string token, std::string watching_token)
    : any_address_(address == "0.0.0.0" || address == "::"),
      token_(std::move(token)),
      watching_token_(std::move(watching_token)) {
  if (port != 80) {  // browsers omit the default port
    port_ += ':';
    port_ += std::to_string(port);
  }
  if (any_address_) {
    hosts_.push_back(bracketed(outward_address(address == "::")));
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
  return equals(token, token_);
}

bool Access::may_watch(std::string_view token) const {
  return !watching_token_.empty() && equals(token, watching_token_);
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
