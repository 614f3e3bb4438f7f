// Mesh files that Assimp reads. The first byte chooses the extension. Files on which Assimp itself crashes
// are left out: a child process finds out. The program reads such formats in a child, too.

#include <assimp/postprocess.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <csignal>
#include <string_view>
#include <vector>

#include "supple/error.hpp"
#include "supple/formats.hpp"
#include "support/byte_reader.hpp"
#include "support/check.hpp"
#include "support/temporary_file.hpp"

namespace {

bool assimp_survives(const std::filesystem::path& path) {
  const pid_t child = fork();
  if (child == 0) {
    // A crash of the child is no failure, whose input would be kept.
    for (const int signal : {SIGABRT, SIGSEGV}) std::signal(signal, SIG_DFL);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) dup2(open("/dev/null", O_WRONLY), stream);
    Assimp::Importer().ReadFile(path.string(), aiProcess_Triangulate);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

/// Assimp loses memory where it refuses a file.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "detect_leaks=0";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace supple;
  static const std::vector<std::string_view> extensions = [] {
    // Without .3mf and .mesh, so that a choice keeps its meaning for the inputs of the corpus.
    constexpr std::array<std::string_view, 12> own = {".obj",   ".off", ".ply",  ".stl", ".ele", ".face",
                                                      ".meshb", ".msh", ".node", ".vtk", ".vtp", ".vtu"};
    std::vector<std::string_view> others(supported_extensions().begin(), supported_extensions().end());
    std::erase_if(others,
                  [&](std::string_view e) { return std::find(own.begin(), own.end(), e) != own.end(); });
    return others;
  }();
  fuzz::ByteReader bytes(data, size);
  const std::size_t choice = bytes.byte() % extensions.size();
  // Assimp's reader of its own dumps overwrites memory, which ends this process later and not the child.
  if (extensions[choice] == ".assbin") return 0;
  const fuzz::TemporaryFile file{std::string(extensions[choice])};
  file.write(bytes.text());
  if (!assimp_survives(file.path())) return 0;
  try {
    check_mesh(load_any_mesh(file.path()));
  } catch (const Error& error) {
    fuzz::check_message(error.what(), "");
  }
  return 0;
}
