// The functions that a page calls (viewer/PROTOCOL.md). Each module has one session.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "messages/message.hpp"
#include "packed/packed_scene.hpp"
#include "page.hpp"
#include "session.hpp"
#include "supple/error.hpp"

#define SUPPLE_EXPORT(name) extern "C" __attribute__((export_name(#name)))

extern "C" __attribute__((import_module("page"), import_name("fail"))) void page_fail(const char* text,
                                                                                      std::size_t length);

namespace supple::viewer {

void fail_in_page(std::string_view message) {
  page_fail(message.data(), message.size());
  __builtin_trap();
}

}  // namespace supple::viewer

namespace {

[[maybe_unused]] const bool has_handler = [] {
  supple::set_failure_handler([](const std::string& message) { supple::viewer::fail_in_page(message); });
  return true;
}();

std::vector<std::byte> given;  // the last input from the page
std::optional<supple::viewer::Session> session;
supple::viewer::MessageWriter message_writer;

}  // namespace

SUPPLE_EXPORT(session_memory) std::byte* session_memory(std::size_t length);
std::byte* session_memory(std::size_t length) {
  given.resize(length);
  return given.data();
}

SUPPLE_EXPORT(session_open) void session_open(const std::byte* show, std::size_t length);
void session_open(const std::byte* show, std::size_t length) {
  // While `set` builds the new objects, the old ones still exist. All must fit into the 4 GB of a module.
  session.emplace(supple::viewer::unpack({show, length}), supple::viewer::MemoryBudget{1e9, 1e8});
  given = {};
  session->greet();
}

SUPPLE_EXPORT(session_command) void session_command(const char* json, std::size_t length);
void session_command(const char* json, std::size_t length) {
  session->command(std::string_view(json, length));
}

SUPPLE_EXPORT(session_advance) double session_advance(double milliseconds);
double session_advance(double milliseconds) {
  return 1000 * session->advance(milliseconds / 1000);
}

SUPPLE_EXPORT(session_message) const std::byte* session_message();
const std::byte* session_message() {
  const std::span<const std::byte> message = session->next_message(message_writer);
  return message.empty() ? nullptr : message.data();
}
