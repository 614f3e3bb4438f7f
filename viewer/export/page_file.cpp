#include "page_file.hpp"

#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "supple/error.hpp"

namespace supple::viewer {
namespace {

constexpr std::string_view cargo_comment = "<!--supple-cargo-->";
/// zlib counts in 32 bits, so large inputs are compressed in parts.
constexpr std::size_t largest_part = std::size_t{1} << 30;

std::vector<unsigned char> gzip(std::span<const std::byte> bytes) {
  z_stream stream{};
  constexpr int as_gzip = 15 + 16;
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, as_gzip, 9, Z_DEFAULT_STRATEGY) != Z_OK)
    throw Error("zlib cannot start; there may be too little memory");
  std::vector<unsigned char> packed;
  std::vector<unsigned char> part(std::size_t{1} << 20);
  std::size_t taken = 0;
  int status = Z_OK;
  do {
    if (stream.avail_in == 0) {
      const std::size_t count = std::min(bytes.size() - taken, largest_part);
      stream.next_in = reinterpret_cast<unsigned char*>(const_cast<std::byte*>(bytes.data() + taken));
      stream.avail_in = static_cast<uInt>(count);
      taken += count;
    }
    stream.next_out = part.data();
    stream.avail_out = static_cast<uInt>(part.size());
    status = deflate(&stream, taken == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
    packed.insert(packed.end(), part.data(), stream.next_out);
  } while (status == Z_OK || status == Z_BUF_ERROR);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw Error("zlib cannot compress the scene");
  return packed;
}

void append_base64(std::string& text, std::span<const unsigned char> bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  text.reserve(text.size() + (bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto at = [&](std::size_t j) { return std::uint32_t{j < bytes.size() ? bytes[j] : 0u}; };
    const std::uint32_t three = at(i) << 16 | at(i + 1) << 8 | at(i + 2);
    text += digits[three >> 18];
    text += digits[three >> 12 & 63];
    text += i + 1 < bytes.size() ? digits[three >> 6 & 63] : '=';
    text += i + 2 < bytes.size() ? digits[three & 63] : '=';
  }
}

void append_element(std::string& page, std::string_view id, std::span<const std::byte> bytes) {
  page += "<script type=\"application/octet-stream;base64\" id=\"";
  page += id;
  page += "\">";
  append_base64(page, gzip(bytes));
  page += "</script>\n";
}

[[noreturn]] void fail_to_write(const std::filesystem::path& path, int error) {
  std::string message = path.string();
  message += ": cannot write: ";
  message += std::strerror(error);
  message += "; choose a writable folder on a disk with free space";
  throw Error(message);
}

/// A temporary file next to the target; removed unless it replaces the target.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& target)
      : target_(target), name_(target.string() + ".XXXXXX") {
    file_ = mkstemp(name_.data());
    if (file_ < 0) fail_to_write(target_, errno);
  }
  ~TemporaryFile() {
    if (file_ >= 0) close(file_);
    if (!is_in_place_) unlink(name_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(std::string_view content) {
    while (!content.empty()) {
      const ssize_t count = ::write(file_, content.data(), content.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail_to_write(target_, errno);
      content.remove_prefix(static_cast<std::size_t>(count));
    }
  }

  void put_in_place() {
    // Set the permissions of an ordinary new file, according to the umask.
    const mode_t mask = umask(0);
    umask(mask);
    if (fchmod(file_, 0666 & ~mask) != 0 || fsync(file_) != 0) fail_to_write(target_, errno);
    if (rename(name_.c_str(), target_.c_str()) != 0) fail_to_write(target_, errno);
    is_in_place_ = true;
  }

 private:
  std::filesystem::path target_;
  std::string name_;
  int file_ = -1;
  bool is_in_place_ = false;
};

}  // namespace

std::size_t place_of_cargo(std::string_view page) {
  const std::size_t at = page.rfind(cargo_comment);
  if (at == std::string_view::npos) throw Error("the page of this build has no place for a scene");
  return at;
}

std::string page_with_cargo(std::string_view page, std::span<const std::byte> scene,
                            std::span<const std::byte> module) {
  const std::size_t at = place_of_cargo(page);
  std::string whole(page.substr(0, at));
  append_element(whole, "supple-wasm", module);
  append_element(whole, "supple-scene", scene);
  whole += page.substr(at + cargo_comment.size());
  return whole;
}

void replace_file(const std::filesystem::path& path, std::string_view content) {
  // Write into a device or a pipe; replacing it would remove it.
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    fail_to_write(path, std::filesystem::is_directory(path, ignored) ? EISDIR : EINVAL);
  TemporaryFile file(path);
  file.write(content);
  file.put_in_place();
}

}  // namespace supple::viewer
