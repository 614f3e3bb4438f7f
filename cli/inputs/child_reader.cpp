#include "inputs/frame_files.hpp"

#include <fcntl.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>

#include "base/text.hpp"
#include "supple/error.hpp"

namespace supple::cli {
namespace {

/// What the child writes first.
enum class Answer : char { mesh = 'm', error = 'e', out_of_memory = 'o' };

class Pipe {
 public:
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
      fail("cannot create a pipe: {}; close some files", std::strerror(errno));
    read_end.reset(fdopen(ends[0], "rb"));
    write_end.reset(fdopen(ends[1], "wb"));
    if (!read_end || !write_end) throw std::bad_alloc();
  }

  std::unique_ptr<std::FILE, decltype(&std::fclose)> read_end{nullptr, &std::fclose};
  std::unique_ptr<std::FILE, decltype(&std::fclose)> write_end{nullptr, &std::fclose};
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

bool write_list(std::FILE* stream, const auto& list) {
  const std::uint64_t count = list.size();
  return std::fwrite(&count, sizeof count, 1, stream) == 1 &&
         std::fwrite(list.data(), sizeof list[0], count, stream) == count;
}

bool read_list(std::FILE* stream, auto& list) {
  std::uint64_t count = 0;
  if (std::fread(&count, sizeof count, 1, stream) != 1) return false;
  if constexpr (requires { list.resize(count); }) list.resize(count);
  return count == list.size() && std::fread(list.data(), sizeof list[0], count, stream) == count;
}

bool write_file(std::FILE* stream, const MeshFile& file) {
  std::string clips;
  for (const std::string& name : file.clips) clips.append(name.c_str(), std::strlen(name.c_str()) + 1);
  return for_each_list(file, clips, [&](const auto& list) { return write_list(stream, list); });
}

bool read_file(std::FILE* stream, MeshFile& file) {
  std::string clips;
  const bool is_complete = for_each_list(file, clips, [&](auto& list) { return read_list(stream, list); });
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
  std::FILE* const stream = pipe.write_end.get();
  const auto send = [&](Answer answer, auto write_content) {
    return std::fputc(static_cast<char>(answer), stream) != EOF && write_content() &&
           std::fflush(stream) == 0;
  };
  bool is_written = false;
  try {
    const MeshFile file = read_mesh_file(path);
    is_written = send(Answer::mesh, [&] { return write_file(stream, file); });
  } catch (const Error& error) {
    is_written = send(Answer::error, [&] { return write_list(stream, std::string(error.what())); });
  } catch (const std::bad_alloc&) {
    is_written = send(Answer::out_of_memory, [] { return true; });
  }
  // Not exit, which would flush the buffers of the parent once more.
  _exit(is_written ? 0 : 1);
}

}  // namespace

MeshFile read_in_child(const std::filesystem::path& path) {
  Pipe pipe;
  const pid_t child = fork();
  if (child < 0) fail("{}: cannot start a process that reads it: {}", path.string(), std::strerror(errno));
  if (child == 0) run_child(pipe, path);
  pipe.write_end.reset();
  MeshFile file;
  std::string error;
  const Answer answer{static_cast<char>(std::fgetc(pipe.read_end.get()))};
  const bool is_read = answer == Answer::mesh    ? read_file(pipe.read_end.get(), file)
                       : answer == Answer::error ? read_list(pipe.read_end.get(), error)
                                                 : answer == Answer::out_of_memory;
  pipe.read_end.reset();
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && is_read) {
    if (answer == Answer::error) throw Error(error);
    if (answer == Answer::out_of_memory) throw std::bad_alloc();
    return file;
  }
  fail(
      "{}: Assimp, the library that reads this format, crashed. The file may be fine; "
      "export it as glTF, OBJ or PLY instead",
      path.string());
}

}  // namespace supple::cli
