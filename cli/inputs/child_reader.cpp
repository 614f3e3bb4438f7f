#include "inputs/child_reader.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/text.hpp"
#include "supple/error.hpp"
#include "supple/formats.hpp"

namespace supple::cli {
namespace {

/// What the child writes first.
enum class Answer : char { mesh = 'm', error = 'e', out_of_memory = 'o' };

class Pipe {
 public:
  Pipe() {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0)
      throw Error(fmt::format("cannot create a pipe: {}; close some files", std::strerror(errno)));
  }
  ~Pipe() {
    for (const int end : ends_) close(end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void close_write_end() { close(std::exchange(ends_[1], -1)); }
  bool write_all(const void* data, std::size_t size) const {
    const char* rest = static_cast<const char*>(data);
    while (size > 0) {
      const ssize_t written = write(ends_[1], rest, size);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return false;
      rest += written;
      size -= static_cast<std::size_t>(written);
    }
    return true;
  }
  std::vector<char> read_all() const {
    std::vector<char> bytes;
    for (std::array<char, 65536> part;;) {
      const ssize_t count = read(ends_[0], part.data(), part.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return bytes;
      bytes.insert(bytes.end(), part.begin(), part.begin() + count);
    }
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

/// The lists of a file, each as its length and its bytes. `visit(list)` writes or reads one. `clips` has a
/// zero byte after each name.
template <class File, class Text, class Visit>
bool for_each_list(File& file, Text& clips, Visit visit) {
  auto& mesh = file.mesh;
  const std::span polygons(&mesh.polygons, 1);
  const std::span frame(&file.frame, 1);
  return visit(mesh.name) && visit(mesh.positions) && visit(mesh.triangles) && visit(mesh.edges) &&
         visit(mesh.points) && visit(polygons) && visit(clips) && visit(frame);
}

bool write_file(const Pipe& pipe, const MeshFile& file) {
  const Answer answer = Answer::mesh;
  std::string clips;
  for (const std::string& name : file.clips) clips.append(name.c_str(), std::strlen(name.c_str()) + 1);
  return pipe.write_all(&answer, 1) && for_each_list(file, clips, [&](const auto& list) {
           const std::uint64_t count = list.size();
           return pipe.write_all(&count, sizeof count) && pipe.write_all(list.data(), count * sizeof list[0]);
         });
}

bool read_file(std::span<const char> bytes, MeshFile& file) {
  std::string clips;
  const bool is_complete = for_each_list(file, clips, [&](auto& list) {
    std::uint64_t count = 0;
    if (bytes.size() < sizeof count) return false;
    std::memcpy(&count, bytes.data(), sizeof count);
    bytes = bytes.subspan(sizeof count);
    if (count > bytes.size() / sizeof list[0]) return false;
    if constexpr (requires { list.resize(count); }) list.resize(count);
    if (count != list.size()) return false;
    if (count > 0) std::memcpy(list.data(), bytes.data(), count * sizeof list[0]);
    bytes = bytes.subspan(count * sizeof list[0]);
    return true;
  });
  for (std::size_t begin = 0; begin < clips.size(); begin = clips.find('\0', begin) + 1)
    file.clips.emplace_back(clips.c_str() + begin);
  return is_complete;
}

[[noreturn]] void run_child(const Pipe& pipe, const std::filesystem::path& path) {
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a time limit or a signal ends the program that waits
#endif
  // Assimp prints when it fails.
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, stream);
  bool is_written = false;
  const auto write_text = [&](Answer answer, std::string_view text) {
    is_written = pipe.write_all(&answer, 1) && pipe.write_all(text.data(), text.size());
  };
  try {
    is_written = write_file(pipe, read_mesh_file(path));
  } catch (const Error& error) {
    write_text(Answer::error, error.what());
  } catch (const std::bad_alloc&) {
    write_text(Answer::out_of_memory, "");
  }
  // Not exit, which would flush the buffers of the parent once more.
  _exit(is_written ? 0 : 1);
}

}  // namespace

MeshFile read_in_child(const std::filesystem::path& path) {
  Pipe pipe;
  const pid_t child = fork();
  if (child < 0)
    throw Error(
        fmt::format("{}: cannot start a process that reads it: {}", path.string(), std::strerror(errno)));
  if (child == 0) run_child(pipe, path);
  pipe.close_write_end();
  const std::vector<char> bytes = pipe.read_all();
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  MeshFile file;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && !bytes.empty()) {
    const std::span<const char> content = std::span(bytes).subspan(1);
    const Answer answer{bytes.front()};
    if (answer == Answer::mesh && read_file(content, file)) return file;
    if (answer == Answer::error) throw Error(std::string(content.begin(), content.end()));
    if (answer == Answer::out_of_memory) throw std::bad_alloc();
  }
  throw Error(
      one_line(fmt::format("{}: Assimp, the library that reads this format, crashed. The file may be fine; "
                           "export it as glTF, OBJ or PLY instead",
                           path.string())));
}

}  // namespace supple::cli
